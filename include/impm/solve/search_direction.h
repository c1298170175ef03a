#ifndef impm_solve_search_direction_h
#define impm_solve_search_direction_h

#include <impm/solve/bfgs.h>
#include <impm/solve/linear_solver.h>

#include <functional>

namespace impm
{
  /**
   * The step that answers a residual: by a new tangent in every iteration, or
   * by an old one that BFGS corrects; by its positive part where the step would
   * ascend.
   */
  class SearchDirection
  {
  public:
    using Evaluate =
      std::function<NonlinearSystem::Evaluation(const Vector &, bool)>;

    SearchDirection(const SolverSpec &spec,
                    NonlinearSystem  &system,
                    LinearSolver     &linear_solver,
                    bool              has_potential,
                    Evaluate          evaluate);

    /** As far as the next step will want it: with its tangent. Collective. */
    NonlinearSystem::Evaluation
    evaluate(const Vector &u)
    {
      return evaluate_system(u, !uses_bfgs());
    }

    /** With its tangent in any case. Collective. */
    NonlinearSystem::Evaluation
    evaluate_with_tangent(const Vector &u)
    {
      return evaluate_system(u, true);
    }

    /** Takes the tangent at u, where the system stands evaluated. Collective.
     */
    void
    take_tangent(const Vector &u);

    /** Solves the linear system of the tangent alone. Collective. */
    void
    solve(Vector &step, const Vector &right_side);

    /**
     * Finds a step from u, where the system stands evaluated; returns its
     * slope, negative if it descends (J). Collective.
     */
    double
    find(const Vector &u, Vector &step);

    /** After a step, or a part of it, was made and evaluated. Collective. */
    void
    learn(const Vector &step);

    /** The iterate has moved on without it. */
    void
    leave_tangent()
    {
      fresh = false;
    }

    /** Whether the tangent is that of the iterate. */
    bool
    is_fresh() const
    {
      return fresh;
    }

    unsigned int n_linear_iterations = 0, n_projections = 0;

  private:
    bool
    uses_bfgs() const
    {
      return spec.bfgs_updates > 0;
    }

    /** BFGS's answer to right_side; returns its slope. */
    double
    correct(Vector &step);

    const SolverSpec &spec;
    NonlinearSystem  &system;
    LinearSolver     &linear_solver;
    const bool        has_potential;
    const Evaluate    evaluate_system;
    Bfgs              bfgs;
    bool              has_tangent = false; ///< taken in this step
    bool              fresh       = false; ///< and at this iterate
    Vector            right_side;
  };
} // namespace impm

#endif
