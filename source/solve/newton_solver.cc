#include <impm/base/exceptions.h>
#include <impm/solve/first_iterate.h>
#include <impm/solve/line_search.h>
#include <impm/solve/newton_solver.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  NewtonSolver::NewtonSolver(const SolverSpec &spec,
                             NonlinearSystem  &system,
                             TimerOutput      &timer)
    : spec(spec)
    , system(system)
    , timer(timer)
    // A quotient of residuals is no derivative of the potential.
    , has_potential(system.has_potential() &&
                    spec.tangent != TangentKind::difference_quotient)
    , test(spec)
    , linear_solver(spec, system, timer)
    , direction(spec,
                system,
                linear_solver,
                has_potential,
                [this](const Vector &u, const bool with_tangent) {
                  return evaluate(u, with_tangent);
                })
  {
    system.initialize(step);
    system.initialize(trial);
  }

  NewtonSolver::Evaluation
  NewtonSolver::evaluate(const Vector &u, const bool with_tangent)
  {
    TimerOutput::Scope scope(timer, "points");
    const auto         result =
      system.evaluate(u, with_tangent && !spec.without_tangent());
    linear_solver.linearize_at(u);
    return result;
  }

  NewtonSolver::Result
  NewtonSolver::solve(Vector &u)
  {
    Result result;
    try
      {
        result = iterate(u);
      }
    catch (const LinearizationError &error)
      {
        result.failure = error.what();
      }
    result.linear_iterations = direction.n_linear_iterations;
    result.projections       = direction.n_projections;
    return result;
  }

  NewtonSolver::Result
  NewtonSolver::iterate(Vector &u)
  {
    Result     result;
    Evaluation now = first_iterate(
      spec, system, linear_solver, direction, test, result.iterations, u);
    if (!now.admissible)
      {
        result.failure = "the first guess turns a point inside out";
        return result;
      }
    for (;;)
      {
        result.residuals.push_back(now.residual);
        const bool stagnates = test.stagnates(now);
        if (test.is_met(now) || stagnates)
          {
            result.converged        = true;
            result.stopped_at_noise = stagnates || !test.allows(now);
            return result;
          }
        if (result.iterations >= spec.newton_iterations)
          {
            result.failure = "Newton's method did not converge";
            return result;
          }

        ++result.iterations;
        const double slope = direction.find(u, step);
        if (!std::isfinite(slope))
          {
            result.failure = "the linear solver gave no finite step";
            return result;
          }
        const Evaluation before = now;
        const double     length = backtrack(spec.line_search,
                                        has_potential && slope < 0,
                                        slope,
                                        before,
                                        [&](const double part) {
                                          trial = u;
                                          trial.add(part, step);
                                          return now =
                                                   direction.evaluate(trial);
                                        });
        result.line_searches += length < 1;
        result.step_lengths.push_back(length);
        if (length == 0 && !direction.is_fresh())
          {
            // What has been kept of an earlier iterate may be to blame.
            direction.take_tangent(u);
            now = before;
            continue;
          }
        if (length == 0)
          {
            result.converged = result.stopped_at_noise = test.allows(before);
            result.failure = "the line search found no descent";
            if (result.converged)
              result.residuals.push_back(evaluate(u, true).residual);
            return result;
          }
        step *= length;
        test.count(step.l2_norm(), length * slope);
        direction.learn(step);
        u = trial;
      }
  }
} // namespace impm
