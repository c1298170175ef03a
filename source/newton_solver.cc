#include <impm/newton_solver.h>

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
  {
    for (Vector *vector : {&step, &trial, &right_side})
      balance.grid.initialize(*vector);
  }

  template <int dim>
  typename NewtonSolver<dim>::Evaluation
  NewtonSolver<dim>::evaluate(const Vector &u)
  {
    TimerOutput::Scope scope(timer, "points");
    const auto         result = balance.evaluate(u, !spec.without_tangent());
    linear_solver.linearize_at(u);
    return result;
  }

  template <int dim>
  void
  NewtonSolver<dim>::start(Vector &u, Result &result, Evaluation &now)
  {
    balance.constraints.interpolate_hanging(u);
    trial = u;
    balance.constraints.set_prescribed(trial);
    step = trial;
    step -= u;
    const bool complete = step.linfty_norm() == 0;
    if (complete || spec.newton_reduction == 1)
      {
        now            = evaluate(trial);
        first_residual = now.residual;
        if (complete || is_small(now))
          {
            u = trial;
            return;
          }
      }

    // A prescribed motion alone would crush the cells next to it. From the
    // guess without it, one linear solve takes it into the body.
    now = evaluate(u);
    if (!now.admissible)
      return;

    // `lift` is the prescribed part, the free part follows from it.
    for (unsigned int i = 0; i < step.locally_owned_size(); ++i)
      if (!balance.constraints.is_constrained[i])
        step.local_element(i) = 0;
    Vector       lift     = step;
    const Vector residual = balance.residual();
    linear_solver.vmult_lift(right_side, lift);
    right_side += residual;
    right_side *= -1.;
    first_residual = right_side.l2_norm() / balance.unit_of_residual();
    result.linear_iterations +=
      linear_solver.solve(step, right_side, spec.linear_tolerance);
    ++result.iterations;
    u += lift;
    u += step;
    balance.constraints.set_prescribed(u);
    now = evaluate(u);
  }

  template <int dim>
  bool
  NewtonSolver<dim>::is_small(const Evaluation &evaluation) const
  {
    // A slender body resists with little force: what is small against the
    // forces of its material may still be all that happens in the step.
    return evaluation.admissible &&
           evaluation.residual <= spec.newton_tolerance &&
           evaluation.residual <= spec.newton_reduction * first_residual;
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
        if (is_small(now) || now.residual <= now.round_off)
          {
            result.converged        = true;
            result.stopped_at_noise = now.residual > spec.newton_tolerance;
            return result;
          }
        if (result.iterations >= spec.newton_iterations)
          {
            result.failure = "Newton's method did not converge";
            return result;
          }

        right_side.equ(-1., balance.residual());
        const auto solve = [&]() {
          result.linear_iterations +=
            linear_solver.solve(step, right_side, spec.linear_tolerance);
          balance.constraints.set_zero(step);
          return -balance.work_along(step, right_side);
        };
        ++result.iterations;
        double slope = solve();
        if (has_potential && !(slope < 0))
          {
            balance.project_tangent();
            ++result.projections;
            slope = solve();
          }
        balance.constraints.interpolate_hanging(step);
        if (!std::isfinite(slope))
          {
            result.failure = "the linear solver gave no finite step";
            return result;
          }

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
        bool         searched = false;
        double       length   = 1;
        const double shortest = 1. / 1024;
        for (;;)
          {
            trial = u;
            trial.add(length, step);
            now = evaluate(trial);
            if (accept(length))
              break;
            searched = true;
            // The parabola through what is known has its least value there.
            double factor = 0.5;
            if (has_potential && slope < 0 && now.admissible)
              factor =
                std::clamp(-slope * length /
                             (2 * (now.potential - before - slope * length)),
                           0.1,
                           0.5);
            length *= factor;
            if (length < shortest)
              {
                result.line_searches += 1;
                result.failure = "the line search found no descent";
                return result;
              }
          }
        result.line_searches += searched;
        result.step_lengths.push_back(length);
        u = trial;
      }
  }

  template class NewtonSolver<2>;
  template class NewtonSolver<3>;
} // namespace impm
