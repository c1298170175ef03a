#ifndef impm_solve_newton_solver_h
#define impm_solve_newton_solver_h

#include <impm/solve/bfgs.h>
#include <impm/solve/convergence_test.h>
#include <impm/solve/linear_solver.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * Newton's method with backtracking, or BFGS, which goes on with a tangent
   * that it corrects. Where the laws have a potential, a step must lower the
   * incremental potential (Armijo); else, the residual.
   */
  template <int dim>
  class NewtonSolver
  {
  public:
    struct Result
    {
      bool                converged         = false;
      bool                stopped_at_noise  = false;
      unsigned int        iterations        = 0; ///< linear solves
      unsigned int        linear_iterations = 0;
      unsigned int        line_searches     = 0; ///< iterations that backed off
      unsigned int        projections       = 0; ///< of an indefinite tangent
      std::vector<double> residuals;             ///< scaled, one an iterate
      std::vector<double> step_lengths;          ///< after backtracking
      std::string         failure;               ///< why not converged
    };

    NewtonSolver(const SolverSpec     &spec,
                 MomentumBalance<dim> &balance,
                 LinearSolver<dim>    &linear_solver,
                 bool                  has_potential,
                 dealii::TimerOutput  &timer);

    /**
     * Solves for the increment of a step. `u` comes with a first guess that
     * need not satisfy the constraints; what is prescribed is spread into the
     * body by the tangent there. When a result has converged, the balance
     * stands evaluated at it. Collective.
     */
    Result
    solve(Vector &u);

  private:
    using Evaluation = typename MomentumBalance<dim>::Evaluation;

    bool
    uses_bfgs() const
    {
      return spec.bfgs_updates > 0;
    }

    Evaluation
    evaluate(const Vector &u, bool with_tangent);

    /** From a guess to a first iterate that satisfies the constraints. */
    void
    start(Vector &u, Result &result, Evaluation &now);

    /** Takes the tangent at u, where the balance stands evaluated. */
    void
    take_tangent(const Vector &u);

    /** Solves for `step`; returns its product with the residual (N m). */
    double
    solve_for_step(Result &result);

    /** Finds a `step` from u; returns its slope, negative if it descends. */
    double
    find_step(const Vector &u, Result &result);

    /**
     * Goes along `step` to a `trial` that is better than u, whose evaluation
     * is `now`, and evaluates it there. Returns the length, 0 if there is none.
     */
    double
    search(const Vector &u, double slope, Evaluation &now);

    const SolverSpec     &spec;
    MomentumBalance<dim> &balance;
    LinearSolver<dim>    &linear_solver;
    const bool            has_potential;
    dealii::TimerOutput  &timer;
    ConvergenceTest       test;
    Bfgs                  bfgs;
    bool                  has_tangent = false; ///< taken in this step
    bool                  is_fresh    = false; ///< and at this iterate
    Vector                step, trial, right_side;
  };
} // namespace impm

#endif
