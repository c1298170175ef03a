#ifndef impm_solve_step_solver_h
#define impm_solve_step_solver_h

#include <impm/solve/newton_solver.h>

namespace impm
{
  /**
   * Finds the grid's increment over one step: by Newton's method, or at once
   * from the forces at the start where the integrator is explicit.
   */
  template <int dim>
  class StepSolver
  {
  public:
    using Result = typename NewtonSolver<dim>::Result;

    StepSolver(const SolverSpec     &spec,
               const Bodies<dim>    &bodies,
               MomentumBalance<dim> &balance,
               const TimeIntegrator &integrator,
               dealii::TimerOutput  &timer);

    /**
     * For the step of length dt that the balance has begun. The balance stands
     * evaluated at u when that has converged, hanging nodes included.
     * Collective.
     */
    Result
    solve(double dt, Vector &u);

    LinearSolver<dim> linear_solver;

  private:
    Result
    solve_by_newton(double dt, Vector &u);

    Result
    solve_explicitly(Vector &u);

    MomentumBalance<dim> &balance;
    const TimeIntegrator &integrator;
    NewtonSolver<dim>     newton;
  };
} // namespace impm

#endif
