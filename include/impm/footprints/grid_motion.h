#ifndef impm_footprints_grid_motion_h
#define impm_footprints_grid_motion_h

#include <impm/footprints/footprints.h>
#include <impm/grid/step_constraints.h>

namespace impm
{
  /**
   * From points to grid at the start of a step: lumped mass (kg), velocity
   * (m/s) with the momentum of the points, and acceleration if they carry
   * one (m/s^2), both zero where a node is held at rest. Collective.
   */
  template <int dim>
  void
  gather_motion(const MaterialPoints<dim>  &points,
                const Footprints<dim>      &footprints,
                const StepConstraints<dim> &constraints,
                const BackgroundGrid<dim>  &grid,
                Vector                     &mass,
                Vector                     &velocity,
                Vector                     &acceleration);

  /**
   * The same of a Lagrangian grid before its first step: the velocities of
   * the bodies at its nodes. Collective.
   */
  template <int dim>
  void
  interpolate_initial_velocity(const Bodies<dim>          &bodies,
                               const MaterialPoints<dim>  &points,
                               const Footprints<dim>      &footprints,
                               const StepConstraints<dim> &constraints,
                               const BackgroundGrid<dim>  &grid,
                               const Vector               &mass,
                               Vector                     &velocity);
} // namespace impm

#endif
