#ifndef impm_footprints_transfer_h
#define impm_footprints_transfer_h

#include <impm/balance/momentum_balance.h>

namespace impm
{
  /**
   * From grid to points at the end of a step that has converged at `u`:
   * positions, deformation, history and, with inertia, velocity and what else
   * they carry of the motion:
   *
   *   FLIP  the velocity takes the change of the grid's (Sulsky & Kaul 2004,
   *         eq. 2.3.2 and 2.3.3); where points carry an acceleration, with
   *         that in place of the grid's at the start of the step of `dt`
   *         (Guilkey & Weiss 2003, section 3.3, step 7),
   *   PIC   it becomes the grid's,
   *   APIC  so, and the point keeps its gradient (Jiang et al. 2015).
   *
   * Ghosts of all vectors are up to date. The points are not sorted.
   */
  template <int dim>
  void
  advance_points(const MomentumBalance<dim> &balance,
                 const TimeSpec             &time,
                 double                      dt,
                 const Vector               &u,
                 const Vector               &end_velocity,
                 const Vector               &end_acceleration,
                 MaterialPoints<dim>        &points);

  /**
   * Largest motion of any point over the step, relative to a grid that
   * `grid_motion` moves, in extents of its cell. Collective.
   */
  template <int dim>
  double
  largest_motion(
    const MomentumBalance<dim> &balance,
    const Vector               &u,
    const MaterialPoints<dim>  &points,
    const std::function<dealii::Tensor<1, dim>(const dealii::Point<dim> &)>
      &grid_motion);

  /**
   * Names a point that the step would carry out of a domain whose faces lie
   * at `faces` when it ends; empty if none. Collective.
   */
  template <int dim>
  std::string
  find_point_outside(const MomentumBalance<dim>        &balance,
                     const Vector                      &u,
                     const MaterialPoints<dim>         &points,
                     const std::array<double, 2 * dim> &faces);
} // namespace impm

#endif
