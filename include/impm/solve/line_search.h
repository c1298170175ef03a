#ifndef impm_solve_line_search_h
#define impm_solve_line_search_h

#include <impm/solve/nonlinear_system.h>

#include <functional>

namespace impm
{
  /**
   * Goes along a step, by its parts from the whole on, until what comes is
   * better than `before`: with a smaller potential (Armijo, along a `slope`
   * below zero) or residual. `evaluate` takes the part. Returns it, the last
   * one that was evaluated, or 0 if none is better. If the search is off, the
   * first part will do that is admissible.
   */
  double
  backtrack(
    bool                                                           is_on,
    bool                                                           by_potential,
    double                                                         slope,
    const NonlinearSystem::Evaluation                             &before,
    const std::function<NonlinearSystem::Evaluation(double part)> &evaluate);
} // namespace impm

#endif
