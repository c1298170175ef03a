#ifndef impm_run_solve_step_h
#define impm_run_solve_step_h

#include <impm/balance/step_problem.h>
#include <impm/solve/newton_solver.h>

#include <cmath>

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
             Vector              &u)
  {
    NewtonSolver::Result result;
    problem.discretization->initialize(u);
    if (problem.integrator.is_explicit())
      {
        problem.explicit_increment(u);
        result.converged =
          problem.balance.strain(u, false) && std::isfinite(u.norm_sqr());
        if (!result.converged)
          result.failure = "the explicit step turns a point inside out";
      }
    else
      {
        if (problem.integrator.has_inertia())
          u.equ(problem.dt, problem.motion.velocity);
        const auto solve = [&]() {
          return NewtonSolver(spec, problem.balance, timer).solve(u);
        };
        result = solve();
        // Friction has an energy only where the pressure is known.
        const unsigned int most = 50;
        for (unsigned int i = 0; problem.contact && result.converged &&
                                 problem.contact->renew_friction(
                                   problem.discretization->communicator);
             ++i)
          {
            if (i < most)
              result.append(solve());
            else
              result.fail("friction does not settle");
          }
      }
    problem.discretization->interpolate_hanging(u);
    return result;
  }
} // namespace impm

#endif
