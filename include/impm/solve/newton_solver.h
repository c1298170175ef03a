#ifndef impm_solve_newton_solver_h
#define impm_solve_newton_solver_h

#include <impm/solve/convergence_test.h>
#include <impm/solve/search_direction.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * Newton's method with backtracking, or BFGS, which goes on with a tangent
   * that it corrects, for one step. Where there is a potential, an iteration
   * must lower it (Armijo); else, the residual.
   */
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

    /** Collective. */
    NewtonSolver(const SolverSpec    &spec,
                 NonlinearSystem     &system,
                 dealii::TimerOutput &timer);

    /**
     * `u` comes with a first guess that need not satisfy the constraints; what
     * is prescribed is spread into the body by the tangent there. When a
     * result has converged, the system stands evaluated at it. Collective.
     */
    Result
    solve(Vector &u);

  private:
    using Evaluation = NonlinearSystem::Evaluation;

    Result
    iterate(Vector &u);

    Evaluation
    evaluate(const Vector &u, bool with_tangent);

    const SolverSpec    &spec;
    NonlinearSystem     &system;
    dealii::TimerOutput &timer;
    const bool           has_potential;
    ConvergenceTest      test;
    LinearSolver         linear_solver;
    SearchDirection      direction;
    Vector               step, trial;
  };
} // namespace impm

#endif
