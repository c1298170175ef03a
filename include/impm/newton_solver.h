#ifndef impm_newton_solver_h
#define impm_newton_solver_h

#include <impm/linear_solver.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * Newton's method with backtracking. Where the laws have a potential, a step
   * must lower the incremental potential (Armijo); else, the residual.
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

    Evaluation
    evaluate(const Vector &u);

    /** From a guess to a first iterate that satisfies the constraints. */
    void
    start(Vector &u, Result &result, Evaluation &now);

    bool
    is_small(const Evaluation &evaluation) const;

    const SolverSpec     &spec;
    MomentumBalance<dim> &balance;
    LinearSolver<dim>    &linear_solver;
    const bool            has_potential;
    dealii::TimerOutput  &timer;
    Vector                step, trial, right_side;
    double                first_residual = 0; ///< what the step has to solve
  };
} // namespace impm

#endif
