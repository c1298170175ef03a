#ifndef impm_run_step_error_h
#define impm_run_step_error_h

#include <impm/balance/step_problem.h>
#include <impm/time/step_control.h>

#include <vector>

namespace impm
{
  /**
   * What a step that has converged loses by its length: its increments of the
   * points less those of a method of lower order, whose error is known. With
   * inertia the integrator knows it from the motion at both ends; without, from
   * the rate of displacement that each point carries from the step before,
   * which there is not in the first step: then the error is zero. Collective.
   */
  template <int dim>
  StepError
  estimate_step_error(const StepProblem<dim>                    &problem,
                      const StepResult                          &result,
                      const std::vector<dealii::Tensor<1, dim>> &increments,
                      const MaterialPoints<dim>                 &points);

  /**
   * The way of the points in a step, over the longest that it may be where
   * bodies come near each other or a wall: they feel each other from when they
   * share nodes on, and should not have gone far by then. Of bodies it is that
   * with respect to all of them. Collective.
   */
  template <int dim>
  double
  way_over_allowed(const StepProblem<dim>                    &problem,
                   const std::vector<dealii::Tensor<1, dim>> &increments,
                   const MaterialPoints<dim>                 &points);
} // namespace impm

#endif
