#ifndef impm_run_motion_limits_h
#define impm_run_motion_limits_h

#include <impm/balance/step_problem.h>
#include <impm/grid/grid_policy.h>

#include <string>

namespace impm
{
  /** Why an increment that has converged must not be used; empty if it may.
   * Collective. */
  template <int dim>
  std::string
  forbidden_motion(const StepProblem<dim>    &problem,
                   const Vector              &increment,
                   const BackgroundGrid<dim> &grid,
                   const MaterialPoints<dim> &points,
                   const GridPolicy<dim>     &policy);
} // namespace impm

#endif
