#ifndef impm_solve_first_iterate_h
#define impm_solve_first_iterate_h

#include <impm/solve/convergence_test.h>
#include <impm/solve/search_direction.h>

namespace impm
{
  /**
   * From a guess `u`, which need not satisfy the constraints, to a first
   * iterate that does, where the system then stands evaluated: a prescribed
   * motion alone would crush the cells next to it, so one linear solve, counted
   * in `n_solves`, takes it into the body. Where a guess has no residual, it is
   * zero. Collective.
   */
  NonlinearSystem::Evaluation
  first_iterate(const SolverSpec &spec,
                NonlinearSystem  &system,
                LinearSolver     &linear_solver,
                SearchDirection  &direction,
                ConvergenceTest  &test,
                unsigned int     &n_solves,
                Vector           &u);
} // namespace impm

#endif
