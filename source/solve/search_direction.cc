#include <impm/solve/search_direction.h>

namespace impm
{
  SearchDirection::SearchDirection(const SolverSpec &spec,
                                   NonlinearSystem  &system,
                                   LinearSolver     &linear_solver,
                                   const bool        has_potential,
                                   Evaluate          evaluate)
    : spec(spec)
    , system(system)
    , linear_solver(linear_solver)
    , has_potential(has_potential)
    , evaluate_system(std::move(evaluate))
    , bfgs(spec.bfgs_updates)
  {
    system.initialize(right_side);
  }

  void
  SearchDirection::take_tangent(const Vector &u)
  {
    if (uses_bfgs() && has_tangent)
      evaluate_with_tangent(u);
    linear_solver.take_tangent();
    bfgs.clear();
    has_tangent = fresh = true;
  }

  void
  SearchDirection::solve(Vector &step, const Vector &right_side)
  {
    n_linear_iterations +=
      linear_solver.solve(step, right_side, spec.linear_tolerance);
  }

  double
  SearchDirection::correct(Vector &step)
  {
    bfgs.apply(step, right_side, [&](Vector &dst, const Vector &src) {
      solve(dst, src);
      system.set_zero(dst);
    });
    return -system.work_along(step, right_side);
  }

  double
  SearchDirection::find(const Vector &u, Vector &step)
  {
    if (!uses_bfgs() || !has_tangent || bfgs.is_full())
      take_tangent(u);
    right_side.equ(-1., system.residual());
    double slope = correct(step);
    if (!fresh && !(slope < 0))
      {
        take_tangent(u);
        slope = correct(step);
      }
    if (has_potential && !(slope < 0))
      {
        system.project_tangent();
        linear_solver.take_tangent();
        ++n_projections;
        slope = correct(step);
      }
    system.interpolate_hanging(step);
    return slope;
  }

  void
  SearchDirection::learn(const Vector &step)
  {
    fresh = false;
    if (!uses_bfgs())
      return;
    right_side += system.residual();
    bfgs.add(step, right_side);
  }
} // namespace impm
