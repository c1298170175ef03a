#include <impm/solve/newton_solver.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  NewtonSolver<dim>::NewtonSolver(const SolverSpec     &spec,
                                  MomentumBalance<dim> &balance,
                                  LinearSolver<dim>    &linear_solver,
                                  const bool            has_potential,
                                  TimerOutput          &timer)
    : spec(spec)
    , balance(balance)
    , linear_solver(linear_solver)
    , has_potential(has_potential)
    , timer(timer)
    , test(spec)
    , bfgs(spec.bfgs_updates)
  {
    for (Vector *vector : {&step, &trial, &right_side})
      balance.grid.initialize(*vector);
  }

  template <int dim>
  typename NewtonSolver<dim>::Evaluation
  NewtonSolver<dim>::evaluate(const Vector &u, const bool with_tangent)
  {
    TimerOutput::Scope scope(timer, "points");
    const auto         result =
      balance.evaluate(u, with_tangent && !spec.without_tangent());
    linear_solver.linearize_at(u);
    return result;
  }

  template <int dim>
  void
  NewtonSolver<dim>::take_tangent(const Vector &u)
  {
    if (uses_bfgs() && has_tangent)
      evaluate(u, true);
    linear_solver.take_tangent();
    bfgs.clear();
    has_tangent = is_fresh = true;
  }

  template <int dim>
  void
  NewtonSolver<dim>::start(Vector &u, Result &result, Evaluation &now)
  {
    test.begin_step();
    has_tangent = is_fresh = false;
    balance.constraints.interpolate_hanging(u);
    trial = u;
    balance.constraints.set_prescribed(trial);
    step = trial;
    step -= u;
    const bool complete = step.linfty_norm() == 0;
    if (complete || spec.newton_reduction == 1)
      {
        now = evaluate(trial, true);
        test.set_first_residual(now.residual);
        if (complete || (now.admissible && test.is_met(now.residual)))
          {
            u = trial;
            return;
          }
      }

    // A prescribed motion alone would crush the cells next to it. From the
    // guess without it, one linear solve takes it into the body.
    now = evaluate(u, true);
    if (!now.admissible)
      return;

    // `lift` is the prescribed part, the free part follows from it.
    for (unsigned int i = 0; i < step.locally_owned_size(); ++i)
      if (!balance.constraints.is_constrained[i])
        step.local_element(i) = 0;
    const Vector guess = u, lift = step, residual = balance.residual();
    linear_solver.vmult_lift(right_side, lift);
    right_side.sadd(-1., -1., residual);
    test.set_first_residual(right_side.l2_norm() / balance.unit_of_residual());
    take_tangent(u);
    const auto go = [&]() {
      result.linear_iterations +=
        linear_solver.solve(step, right_side, spec.linear_tolerance);
      ++result.iterations;
      u = guess;
      u += lift;
      u += step;
      balance.constraints.set_prescribed(u);
      now = evaluate(u, !uses_bfgs());
    };
    go();
    if (!now.admissible && guess.linfty_norm() == 0)
      {
        // A new grid may be far out of balance however short the step is. What
        // is prescribed goes alone then; the search mends the balance.
        evaluate(guess, true);
        right_side += residual;
        go();
      }
    is_fresh = false;
    trial    = u;
    trial -= guess;
    test.count(trial.l2_norm(), balance.work_along(step, right_side));
  }

  template <int dim>
  double
  NewtonSolver<dim>::solve_for_step(Result &result)
  {
    bfgs.apply(step, right_side, [&](Vector &dst, const Vector &src) {
      result.linear_iterations +=
        linear_solver.solve(dst, src, spec.linear_tolerance);
      balance.constraints.set_zero(dst);
    });
    return -balance.work_along(step, right_side);
  }

  template <int dim>
  double
  NewtonSolver<dim>::find_step(const Vector &u, Result &result)
  {
    ++result.iterations;
    if (!uses_bfgs() || !has_tangent || bfgs.is_full())
      take_tangent(u);
    right_side.equ(-1., balance.residual());
    double slope = solve_for_step(result);
    if (!is_fresh && !(slope < 0))
      {
        take_tangent(u);
        slope = solve_for_step(result);
      }
    if (has_potential && !(slope < 0))
      {
        balance.project_tangent();
        linear_solver.take_tangent();
        ++result.projections;
        slope = solve_for_step(result);
      }
    balance.constraints.interpolate_hanging(step);
    return slope;
  }

  template <int dim>
  double
  NewtonSolver<dim>::search(const Vector &u,
                            const double  slope,
                            Evaluation   &now)
  {
    // Energies cancel to round-off near the solution: hence the slack.
    const double before = now.potential, residual_before = now.residual;
    const double slack  = 1e-9 * std::abs(slope) + 1e-13 * std::abs(before);
    const auto   accept = [&](const double length) {
      if (!now.admissible)
        return false;
      if (!spec.line_search)
        return true;
      if (has_potential && slope < 0)
        return now.potential <= before + 1e-4 * length * slope + slack ||
               now.residual <= 0.1 * residual_before;
      return now.residual <= (1 - 1e-4 * length) * residual_before;
    };
    double       length   = 1;
    const double shortest = 1. / 1024;
    for (;;)
      {
        trial = u;
        trial.add(length, step);
        now = evaluate(trial, !uses_bfgs());
        if (accept(length))
          return length;
        // The parabola through what is known has its least value there.
        double factor = 0.5;
        if (has_potential && slope < 0 && now.admissible)
          factor = std::clamp(-slope * length /
                                (2 * (now.potential - before - slope * length)),
                              0.1,
                              0.5);
        length *= factor;
        if (length < shortest)
          return 0;
      }
  }

  template <int dim>
  typename NewtonSolver<dim>::Result
  NewtonSolver<dim>::solve(Vector &u)
  {
    Result       result;
    const double guess_norm = u.linfty_norm();
    Evaluation   now;
    start(u, result, now);
    if (!now.admissible && guess_norm > 0)
      {
        // The guess may be worse than none.
        u = 0;
        start(u, result, now);
      }
    if (!now.admissible)
      {
        result.failure = "the first guess turns a point inside out";
        return result;
      }

    for (;;)
      {
        result.residuals.push_back(now.residual);
        const bool met = test.is_met(now.residual);
        if (met || now.residual <= now.round_off)
          {
            result.converged        = true;
            result.stopped_at_noise = !test.allows(now.residual);
            return result;
          }
        if (result.iterations >= spec.newton_iterations)
          {
            result.failure = "Newton's method did not converge";
            return result;
          }

        const double slope = find_step(u, result);
        if (!std::isfinite(slope))
          {
            result.failure = "the linear solver gave no finite step";
            return result;
          }
        const Evaluation before = now;
        const double     length = search(u, slope, now);
        result.line_searches += length < 1;
        result.step_lengths.push_back(length);
        if (length == 0 && !is_fresh)
          {
            // What has been kept of an earlier iterate may be to blame.
            take_tangent(u);
            now = before;
            continue;
          }
        if (length == 0)
          {
            result.failure = "the line search found no descent";
            return result;
          }
        step *= length;
        test.count(step.l2_norm(), length * slope);
        if (uses_bfgs())
          {
            right_side += balance.residual();
            bfgs.add(step, right_side);
          }
        is_fresh = false;
        u        = trial;
      }
  }

  template class NewtonSolver<2>;
  template class NewtonSolver<3>;
} // namespace impm
