#ifndef impm_footprints_scatter_h
#define impm_footprints_scatter_h

#include <impm/balance/step_problem.h>

namespace impm
{
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
   * The points are not sorted. Collective.
   */
  template <int dim>
  void
  advance_points(const StepProblem<dim> &problem,
                 const StepResult       &result,
                 const TimeSpec         &time,
                 MaterialPoints<dim>    &points);
} // namespace impm

#endif
