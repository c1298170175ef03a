#include <impm/base/exceptions.h>
#include <impm/solve/newton_solver.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  void
  NewtonSolver::Result::append(const Result &more)
  {
    converged        = more.converged;
    stopped_at_noise = more.stopped_at_noise;
    iterations += more.iterations;
    linear_iterations += more.linear_iterations;
    line_searches += more.line_searches;
    projections += more.projections;
    residuals.insert(residuals.end(),
                     more.residuals.begin(),
                     more.residuals.end());
    step_lengths.insert(step_lengths.end(),
                        more.step_lengths.begin(),
                        more.step_lengths.end());
    failure = more.failure;
  }

  NewtonSolver::NewtonSolver(const SolverSpec    &spec,
                             NonlinearSystem     &system,
                             dealii::TimerOutput &timer)
    : spec(spec)
    , system(system)
    // A quotient of residuals is no derivative of the potential.
    , has_potential(system.has_potential() &&
                    spec.tangent != TangentKind::difference_quotient)
    , has_guide(system.has_guide() &&
                spec.tangent != TangentKind::difference_quotient)
    , uses_bfgs(spec.bfgs_updates > 0)
    , test(spec)
    , linear_solver(spec, system, timer)
  {
    for (Vector *vector : {&step, &trial, &right_side})
      system.initialize(*vector);
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
    result.linear_iterations = n_linear_iterations;
    result.projections       = n_projections;
    result.unstable_mode     = unstable_mode;
    return result;
  }

  NewtonSolver::Result
  NewtonSolver::iterate(Vector &u)
  {
    Result     result;
    const bool has_guess = u.linfty_norm() > 0;
    Evaluation now       = first_iterate(u, result.iterations);
    if (!now.admissible && has_guess)
      {
        // The guess may be worse than none.
        u   = 0;
        now = first_iterate(u, result.iterations);
      }
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
        const double slope = find_step(u);
        if (!std::isfinite(slope))
          {
            result.failure = "the linear solver gave no finite step";
            return result;
          }
        const double length = backtrack(u, slope, now);
        result.line_searches += length < 1;
        result.step_lengths.push_back(length);
        if (length == 0 && !is_fresh)
          {
            // What has been kept of an earlier iterate may be to blame.
            take_tangent(u);
            continue;
          }
        if (length == 0)
          {
            result.converged = result.stopped_at_noise = test.allows(now);
            result.failure = "the line search found no descent";
            if (result.converged)
              result.residuals.push_back(
                linear_solver.evaluate(u, true).residual);
            return result;
          }
        step *= length;
        test.count(step.l2_norm(), length * slope);
        u        = trial;
        is_fresh = false;
        if (uses_bfgs)
          {
            right_side += system.residual();
            bfgs.add(step, right_side);
          }
      }
  }

  NewtonSolver::Evaluation
  NewtonSolver::first_iterate(Vector &u, unsigned int &n_solves)
  {
    system.interpolate_hanging(u);
    Vector complete = u;
    system.set_prescribed(complete);
    Vector lift = complete;
    lift -= u;
    const bool is_complete = lift.linfty_norm() == 0;
    if (is_complete || spec.newton_reduction == 1)
      {
        const auto now      = linear_solver.evaluate(complete, true);
        test.first_residual = system.norms_of(system.residual());
        if (is_complete || (now.admissible && test.is_met(now)))
          {
            u = complete;
            return now;
          }
      }

    auto now = linear_solver.evaluate(u, true);
    if (!now.admissible)
      return now;

    // `lift` is the prescribed part, the free part follows from it.
    for (unsigned int i = 0; i < lift.locally_owned_size(); ++i)
      if (!system.is_constrained(i))
        lift.local_element(i) = 0;
    const Vector guess = u, residual = system.residual();
    linear_solver.vmult_lift(right_side, lift);
    right_side.sadd(-1., -1., residual);
    test.first_residual = system.norms_of(right_side);
    take_tangent(u);
    const auto go = [&]() {
      n_linear_iterations += linear_solver.solve(step, right_side);
      ++n_solves;
      watch_stability();
      leave_saddle();
      u = guess;
      u += lift;
      u += step;
      system.set_prescribed(u);
      now = linear_solver.evaluate(u, !uses_bfgs);
    };
    go();
    if (!now.admissible && guess.linfty_norm() == 0)
      {
        // A new grid may be far out of balance however short the step is.
        // What is prescribed goes alone then; the search mends the balance.
        linear_solver.evaluate(guess, true);
        right_side += residual;
        go();
      }
    is_fresh = false;
    if (!now.admissible)
      return now;
    Vector change = u;
    change -= guess;
    test.count(change.l2_norm(), system.work_along(step, right_side));
    return now;
  }

  double
  NewtonSolver::find_step(const Vector &u)
  {
    if (!has_tangent || bfgs.n_updates() >= spec.bfgs_updates)
      take_tangent(u);
    right_side.equ(-1., system.residual());
    const LinearMap inverse = {[&](Vector &dst, const Vector &src) {
      n_linear_iterations += linear_solver.solve(dst, src);
      system.set_zero(dst);
    }};
    const auto      answer  = [&]() {
      bfgs.apply(step, right_side, inverse);
      watch_stability();
      leave_saddle();
      return -system.work_along(step, right_side);
    };
    double slope = answer();
    if (!is_fresh && !(slope < 0))
      {
        take_tangent(u);
        slope = answer();
      }
    if (has_potential && !(slope < 0))
      {
        system.project_tangent();
        linear_solver.take_tangent();
        ++n_projections;
        slope = answer();
      }
    system.interpolate_hanging(step);
    return slope;
  }

  void
  NewtonSolver::watch_stability()
  {
    if (is_watched || spec.unstable_equilibria == UnstableEquilibria::ignore ||
        !has_potential)
      return;
    is_watched = true;
    Vector mode;
    system.initialize(mode);
    if (!linear_solver.find_negative_curvature(mode))
      return;
    system.set_zero(mode);
    unstable_mode = mode;
  }

  void
  NewtonSolver::leave_saddle()
  {
    if (unstable_mode.size() == 0 || !is_fresh ||
        spec.unstable_equilibria != UnstableEquilibria::leave)
      return;
    Vector image;
    system.initialize(image);
    system.vmult(image, unstable_mode);
    const double curvature = system.work_along(unstable_mode, image);
    if (curvature >= 0)
      return;
    // Newton's method goes uphill along it, as far as it should go down; where
    // nothing pulls, to one side.
    const double pull   = system.work_along(unstable_mode, right_side);
    const double uphill = pull / curvature;
    const double extent = system.length_scale();
    const double wanted =
      std::clamp(std::abs(uphill), 0.05 * extent, 0.5 * extent);
    step.add((pull < 0 ? -wanted : wanted) - uphill, unstable_mode);
  }

  double
  NewtonSolver::backtrack(const Vector &u, const double slope, Evaluation &now)
  {
    const Evaluation before       = now;
    const bool       by_potential = has_guide && slope < 0;
    // What is a potential but nearly may be wrong about short steps.
    const auto enough = [&](const double part) {
      return has_potential ? 0.1 : 1 - 1e-4 * part;
    };
    // Energies cancel to round-off near the solution: hence the slack.
    const double slack =
      1e-9 * std::abs(slope) + 1e-13 * std::abs(before.potential);
    const auto is_better = [&](const double part) {
      if (!now.admissible || !spec.line_search)
        return now.admissible;
      if (by_potential)
        return now.potential <=
                 before.potential + 1e-4 * part * slope + slack ||
               now.residual <= enough(part) * before.residual;
      return now.residual <= (1 - 1e-4 * part) * before.residual;
    };
    const double shortest = 1. / 1024;
    for (double part = 1; part >= shortest;)
      {
        trial = u;
        trial.add(part, step);
        now = linear_solver.evaluate(trial, !uses_bfgs);
        if (is_better(part))
          return part;
        // The parabola through what is known has its least value there.
        double factor = 0.5;
        if (by_potential && now.admissible)
          factor = std::clamp(-slope * part /
                                (2 * (now.potential - before.potential -
                                      slope * part)),
                              0.1,
                              0.5);
        part *= factor;
      }
    now = before;
    return 0;
  }

  void
  NewtonSolver::take_tangent(const Vector &u)
  {
    if (uses_bfgs && has_tangent)
      linear_solver.evaluate(u, true);
    linear_solver.take_tangent();
    bfgs.clear();
    has_tangent = is_fresh = true;
  }
} // namespace impm
