#ifndef impm_solve_linear_solver_h
#define impm_solve_linear_solver_h

#include <deal.II/base/timer.h>

#include <deal.II/lac/full_matrix.h>

#include <impm/input/sections/solver.h>
#include <impm/solve/difference_quotient.h>
#include <impm/solve/direct_solver.h>

namespace impm
{
  /**
   * Solves the linear systems of Newton's method in one step: CG or GMRES of
   * deal.II with multigrid, Jacobi or no preconditioner, or a direct solver,
   * which also takes over, counted, where an iterative one fails, unless what
   * it has then is good enough for Newton's method to go on. One that was
   * chosen automatically and fails is not tried again in this step. All is
   * collective.
   */
  class LinearSolver
  {
  public:
    LinearSolver(const SolverSpec    &spec,
                 NonlinearSystem     &system,
                 dealii::TimerOutput &timer);

    /** As NonlinearSystem::evaluate; what follows is of the tangent at `u`. */
    NonlinearSystem::Evaluation
    evaluate(const Vector &u, bool with_tangent);

    /** dst = K src as NonlinearSystem::vmult_lift. */
    void
    vmult_lift(Vector &dst, const Vector &src);

    /**
     * Takes the tangent as it is now: assembles it, makes the preconditioner,
     * as far as they are wanted. Hierarchies are kept while they are good
     * enough.
     */
    void
    take_tangent();

    /**
     * Solves with the tangent that was taken last (a direct solver to
     * round-off). Returns the number of iterations. Throws LinearizationError
     * when nothing can be solved.
     */
    unsigned int
    solve(Vector &x, const Vector &b);

    /**
     * Looks for a direction along which the tangent that was taken last, a
     * symmetric one, is negative, as far as there is a matrix of it. Its
     * largest value is one.
     */
    bool
    find_negative_curvature(Vector &direction);

  private:
    void
    factorize();

    void
    assemble();

    void
    take_sparse_tangent();

    /** Solves without the correction of the tangent. */
    unsigned int
    solve_sparse(Vector &x, const Vector &b);

    /** Takes it (Woodbury). */
    void
    take_correction();

    void
    set_up_hierarchy();

    unsigned int
    iterate();

    /** The same, with another hierarchy where the one of an earlier tangent
     * fails. */
    unsigned int
    iterate_or_renew();

    const SolverSpec    &spec;
    NonlinearSystem     &system;
    dealii::TimerOutput &timer;
    DifferenceQuotient   quotient;

    const Unknowns                unknowns;
    LinearSolverKind              kind;         ///< anything but automatic
    const bool                    needs_matrix; ///< of every tangent
    std::unique_ptr<SparseMatrix> matrix;
    LinearMap                     preconditioner; ///< if there is one
    // The hierarchy: of an earlier tangent, not good enough for the next.
    bool         hierarchy_is_old = false, hierarchy_is_worn = false;
    unsigned int iterations_when_new = 0; ///< of a solve
    unsigned int place_of_matrix     = 0; ///< of the matrix that it knows
    std::unique_ptr<DirectSolver> direct; ///< once it was needed
    bool is_factorized = false;           ///< the matrix as it is

    // The correction L R^T of the sparse tangent K: R, K^-1 L and the inverse
    // of 1 + R^T K^-1 L.
    LowRank                    correction;
    dealii::FullMatrix<double> of_correction;
    unsigned int correction_iterations = 0; ///< that nobody has counted yet

    // Compact vectors, but for those of operators that know full ones.
    Vector solution, right_side, inverse_diagonal, full_src, full_dst;
  };
} // namespace impm

#endif
