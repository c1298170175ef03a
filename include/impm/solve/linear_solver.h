#ifndef impm_solve_linear_solver_h
#define impm_solve_linear_solver_h

#include <deal.II/base/timer.h>

#include <impm/input/sections/solver.h>
#include <impm/solve/difference_quotient.h>
#include <impm/solve/sparse_matrix.h>

#include <memory>

namespace impm
{
  /**
   * Solves the linear systems of Newton's method in one step: CG or GMRES of
   * deal.II with AMG, Jacobi or no preconditioner, or a direct solver, which
   * also takes over, counted, where an iterative one fails, unless what it has
   * then is good enough for Newton's method to go on.
   */
  class LinearSolver
  {
  public:
    /** Collective. */
    LinearSolver(const SolverSpec    &spec,
                 NonlinearSystem     &system,
                 dealii::TimerOutput &timer);

    /** Says that the system stands evaluated at u, for what follows. */
    void
    linearize_at(const Vector &u);

    /** dst = K src as NonlinearSystem::vmult_lift. Collective. */
    void
    vmult_lift(Vector &dst, const Vector &src);

    /**
     * Takes the tangent as it is now: assembles it, makes the preconditioner,
     * as far as they are wanted. Collective.
     */
    void
    take_tangent();

    /**
     * Solves with the tangent that was taken last, to the residual `tolerance`
     * times that of zero (a direct solver to round-off). Returns the number of
     * iterations. Throws LinearizationError when nothing can be solved.
     * Collective.
     */
    unsigned int
    solve(Vector &x, const Vector &b, double tolerance);

  private:
    void
    assemble();

    void
    update_preconditioner();

    unsigned int
    iterate(Vector &x, const Vector &b, double tolerance);

    void
    solve_directly(Vector &x, const Vector &b);

    /**
     * Unknowns that are momenta are near enough to the right-hand side: an
     * increment of a node with little mass says little.
     */
    bool
    solves_for_momentum() const
    {
      return system.weight_of_unknowns() != nullptr &&
             spec.preconditioner == PreconditionerKind::none;
    }

    bool
    needs_matrix() const
    {
      return spec.linear_solver == LinearSolverKind::direct ||
             spec.tangent == TangentKind::matrix ||
             spec.preconditioner == PreconditionerKind::amg;
    }

    const SolverSpec    &spec;
    NonlinearSystem     &system;
    DifferenceQuotient   quotient;
    dealii::TimerOutput &timer;

    std::unique_ptr<SparseMatrix> matrix;
    bool                          matrix_is_current = false;
    std::unique_ptr<DirectSolver> factors; ///< of the matrix as it is, or null
    AmgPreconditioner             amg;
    Vector                        inverse_diagonal;
  };
} // namespace impm

#endif
