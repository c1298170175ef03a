#ifndef impm_solve_newton_solver_h
#define impm_solve_newton_solver_h

#include <impm/solve/bfgs.h>
#include <impm/solve/convergence_test.h>
#include <impm/solve/linear_solver.h>

#include <string>

namespace impm
{
  /**
   * Newton's method with backtracking, or BFGS, which goes on with a tangent
   * that it corrects, for one step. Where there is a potential, an iteration
   * must lower it (Armijo); else, the residual. All is collective.
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
      /** Along which the equilibrium at the start is not stable: its largest
       * value is one; empty if it is, or none looks. */
      Vector unstable_mode;

      /** When the step was solved anew, in a system that has changed. */
      void
      append(const Result &more);

      void
      fail(const std::string &why)
      {
        converged = false;
        failure   = why;
      }
    };

    NewtonSolver(const SolverSpec    &spec,
                 NonlinearSystem     &system,
                 dealii::TimerOutput &timer);

    /**
     * `u` comes with a first guess that need not satisfy the constraints; what
     * is prescribed is spread into the body by the tangent there. When a
     * result has converged, the system stands evaluated at it.
     */
    Result
    solve(Vector &u);

  private:
    using Evaluation = NonlinearSystem::Evaluation;

    Result
    iterate(Vector &u);

    /**
     * From a guess to an iterate that satisfies the constraints, where the
     * system then stands evaluated: a prescribed motion alone would crush the
     * cells next to it, so one linear solve takes it into the body.
     */
    Evaluation
    first_iterate(Vector &u, unsigned int &n_solves);

    /**
     * Finds the `step` from u, where the system stands evaluated; returns its
     * slope, negative if it descends (J).
     */
    double
    find_step(const Vector &u);

    /**
     * Goes along the step from u, by its parts from the whole on, until the
     * trial is better than `now`, which it becomes then: with a smaller
     * potential (along a slope below zero) or residual. Returns the part, or 0
     * if none is better. If the search is off, the first part will do that is
     * admissible.
     */
    double
    backtrack(const Vector &u, double slope, Evaluation &now);

    /** At u, where the system stands evaluated. */
    void
    take_tangent(const Vector &u);

    /** With the first tangent of a step: looks for a mode along which it is
     * negative. */
    void
    watch_stability();

    /** If the tangent as it is now still is, turns the part of `step` along the
     * mode downhill. */
    void
    leave_saddle();

    const SolverSpec &spec;
    NonlinearSystem  &system;
    const bool        has_potential, has_guide, uses_bfgs;
    ConvergenceTest   test;
    LinearSolver      linear_solver;
    Bfgs              bfgs;
    bool              has_tangent = false; ///< taken in this step
    bool              is_fresh    = false; ///< and at this iterate
    bool              is_watched  = false; ///< the stability of the start
    Vector            unstable_mode;
    Vector            step, trial, right_side;
    unsigned int      n_linear_iterations = 0, n_projections = 0;
  };
} // namespace impm

#endif
