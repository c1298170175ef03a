#ifndef impm_footprints_transfer_h
#define impm_footprints_transfer_h

#include <impm/footprints/footprints.h>
#include <impm/input/sections/time.h>

namespace impm
{
  template <int dim>
  class StepProblem;

  /** The motion of the nodes at the start of a step; empty without inertia. */
  struct NodalMotion
  {
    Vector mass;                 ///< lumped (kg)
    Vector velocity;             ///< (m/s)
    Vector acceleration;         ///< (m/s^2), or empty if no point carries one
    bool   is_of_points = false; ///< and not what the nodes have kept
  };

  /**
   * From points to grid at the start of a step: lumped mass, whose ghosts are
   * up to date, velocity with the momentum of the points, and acceleration if
   * they carry one. The nodes of a Lagrangian grid bring their own motion;
   * before their first step, the velocities of the bodies there. Collective.
   */
  template <int dim>
  NodalMotion
  gather_motion(const MaterialPoints<dim> &points,
                const Bodies<dim>         &bodies,
                const Footprints<dim>     &footprints,
                const BackgroundGrid<dim> &grid,
                const Discretization<dim> &discretization);

  /** The lumped mass alone. Collective. */
  template <int dim>
  Vector
  gather_mass(const MaterialPoints<dim> &points,
              const Footprints<dim>     &footprints,
              const Discretization<dim> &discretization);

  /**
   * From grid to points at the end of a step that has converged: positions,
   * deformation, history and, with inertia, velocity and what else they carry
   * of the motion:
   *
   *   FLIP  the velocity takes the change of the grid's (Sulsky & Kaul 2004,
   *         eq. 2.3.2 and 2.3.3); where points carry an acceleration, with
   *         that in place of the grid's at the start of the step
   *         (Guilkey & Weiss 2003, section 3.3, step 7),
   *   PIC   it becomes the grid's,
   *   APIC  so, and the point keeps its gradient (Jiang et al. 2015).
   *
   * `increments` are those of the points, as the footprints interpolate the
   * grid's. The points are not sorted. Collective.
   */
  template <int dim>
  void
  advance_points(const StepProblem<dim>                    &problem,
                 const StepResult                          &result,
                 const std::vector<dealii::Tensor<1, dim>> &increments,
                 const TimeSpec                            &time,
                 MaterialPoints<dim>                       &points);
} // namespace impm

#endif
