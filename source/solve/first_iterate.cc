#include <impm/solve/first_iterate.h>

namespace impm
{
  namespace
  {
    NonlinearSystem::Evaluation
    from_guess(const SolverSpec &spec,
               NonlinearSystem  &system,
               LinearSolver     &linear_solver,
               SearchDirection  &direction,
               ConvergenceTest  &test,
               unsigned int     &n_solves,
               Vector           &u)
    {
      test.begin_step();
      system.interpolate_hanging(u);
      Vector complete = u;
      system.set_prescribed(complete);
      Vector lift = complete;
      lift -= u;
      const bool is_complete = lift.linfty_norm() == 0;
      if (is_complete || spec.newton_reduction == 1)
        {
          const auto now = direction.evaluate_with_tangent(complete);
          test.set_first_residual(system.norms_of(system.residual()));
          if (is_complete || (now.admissible && test.is_met(now)))
            {
              u = complete;
              return now;
            }
        }

      auto now = direction.evaluate_with_tangent(u);
      if (!now.admissible)
        return now;

      // `lift` is the prescribed part, the free part follows from it.
      for (unsigned int i = 0; i < lift.locally_owned_size(); ++i)
        if (!system.is_constrained(i))
          lift.local_element(i) = 0;
      const Vector guess = u, residual = system.residual();
      Vector       step, right_side;
      system.initialize(step);
      system.initialize(right_side);
      linear_solver.vmult_lift(right_side, lift);
      right_side.sadd(-1., -1., residual);
      test.set_first_residual(system.norms_of(right_side));
      direction.take_tangent(u);
      const auto go = [&]() {
        direction.solve(step, right_side);
        ++n_solves;
        u = guess;
        u += lift;
        u += step;
        system.set_prescribed(u);
        now = direction.evaluate(u);
      };
      go();
      if (!now.admissible && guess.linfty_norm() == 0)
        {
          // A new grid may be far out of balance however short the step is.
          // What is prescribed goes alone then; the search mends the balance.
          direction.evaluate_with_tangent(guess);
          right_side += residual;
          go();
        }
      direction.leave_tangent();
      Vector change = u;
      change -= guess;
      test.count(change.l2_norm(), system.work_along(step, right_side));
      return now;
    }
  } // namespace

  NonlinearSystem::Evaluation
  first_iterate(const SolverSpec &spec,
                NonlinearSystem  &system,
                LinearSolver     &linear_solver,
                SearchDirection  &direction,
                ConvergenceTest  &test,
                unsigned int     &n_solves,
                Vector           &u)
  {
    const double guess_norm = u.linfty_norm();
    auto         now =
      from_guess(spec, system, linear_solver, direction, test, n_solves, u);
    if (!now.admissible && guess_norm > 0)
      {
        // The guess may be worse than none.
        u = 0;
        now =
          from_guess(spec, system, linear_solver, direction, test, n_solves, u);
      }
    return now;
  }
} // namespace impm
