#ifndef impm_footprints_gather_h
#define impm_footprints_gather_h

#include <impm/footprints/footprints.h>
#include <impm/grid/step_constraints.h>

#include <vector>

namespace impm
{
  /** The motion of the nodes at the start of a step; empty without inertia. */
  struct NodalMotion
  {
    Vector mass;         ///< lumped (kg)
    Vector velocity;     ///< (m/s)
    Vector acceleration; ///< (m/s^2), as far as the integrator wants it
  };

  /**
   * From points to grid at the start of a step: lumped mass, velocity with the
   * momentum of the points, and acceleration if they carry one, both zero where
   * a node is held at rest. The nodes of a Lagrangian grid bring their own
   * motion; before their first step, the velocities of the bodies there.
   * Collective.
   */
  template <int dim>
  NodalMotion
  gather_motion(const MaterialPoints<dim>  &points,
                const Bodies<dim>          &bodies,
                const Footprints<dim>      &footprints,
                const StepConstraints<dim> &constraints,
                const BackgroundGrid<dim>  &grid,
                const Discretization<dim>  &discretization);
} // namespace impm

#endif
