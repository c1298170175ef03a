#include <impm/run/solve_step.h>

namespace impm
{
  namespace
  {
    template <int dim>
    NewtonSolver::Result
    solve_explicitly(StepProblem<dim> &problem, Vector &u)
    {
      NewtonSolver::Result result;
      problem.explicit_increment(u);
      result.converged = problem.balance.evaluate(u, false).admissible;
      if (!result.converged)
        result.failure = "the explicit step turns a point inside out";
      return result;
    }
  } // namespace

  template <int dim>
  NewtonSolver::Result
  solve_step(StepProblem<dim>    &problem,
             const SolverSpec    &spec,
             dealii::TimerOutput &timer,
             Vector              &u)
  {
    NewtonSolver::Result result;
    problem.discretization->initialize(u);
    if (problem.integrator.is_explicit())
      result = solve_explicitly(problem, u);
    else
      {
        if (problem.integrator.has_inertia())
          u.equ(problem.dt, problem.motion.velocity);
        result = NewtonSolver(spec, problem.balance, timer).solve(u);
      }
    problem.discretization->interpolate_hanging(u);
    return result;
  }

  template NewtonSolver::Result
  solve_step(StepProblem<2> &,
             const SolverSpec &,
             dealii::TimerOutput &,
             Vector &);
  template NewtonSolver::Result
  solve_step(StepProblem<3> &,
             const SolverSpec &,
             dealii::TimerOutput &,
             Vector &);
} // namespace impm
