#ifndef impm_run_solve_step_h
#define impm_run_solve_step_h

#include <impm/balance/step_problem.h>
#include <impm/solve/newton_solver.h>

namespace impm
{
  /**
   * Finds the grid's increment over one step: by Newton's method, or at once
   * from the forces at the start where the integrator is explicit. When that
   * has converged, the problem stands evaluated at `u`, hanging nodes included.
   * Collective.
   */
  template <int dim>
  NewtonSolver::Result
  solve_step(StepProblem<dim>    &problem,
             const SolverSpec    &spec,
             dealii::TimerOutput &timer,
             Vector              &u);
} // namespace impm

#endif
