#include <impm/balance/terms/contact.h>
#include <impm/run/solve_step.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  NewtonSolver::Result
  solve_step(StepProblem<dim> &problem,
             const SolverSpec &spec,
             TimerOutput      &timer,
             Vector           &u)
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
        // Springs hold what nothing holds, but only till contact does.
        const unsigned int most_for_springs = 10;
        for (unsigned int i = 0; i < most_for_springs && result.converged &&
                                 problem.relax_springs(u);
             ++i)
          result.append(solve());
        // Friction has an energy only where the pressure is known.
        const unsigned int most = 50;
        for (unsigned int i = 0;
             problem.contact && result.converged && problem.contact->renew();
             ++i)
          {
            if (i < most)
              result.append(solve());
            else
              result.fail("friction does not settle");
          }
        if (const auto *free = problem.free_bodies.get())
          {
            if (!result.converged && !free->unsettled.empty())
              result.fail("the motion of the rigid body '" + free->unsettled +
                          "' does not settle");
            const auto name =
              free->gone_astray(problem.discretization->smallest_cell_extent);
            if (result.converged && !name.empty())
              result.fail("the rigid body '" + name +
                          "' goes further than a cell from where it was looked "
                          "for");
          }
      }
    problem.discretization->interpolate_hanging(u);
    return result;
  }

  template decltype(solve_step<2>) solve_step<2>;
  template decltype(solve_step<3>) solve_step<3>;
} // namespace impm
