#ifndef impm_solve_linear_solver_h
#define impm_solve_linear_solver_h

#include <deal.II/base/timer.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <impm/solve/difference_quotient.h>

#include <memory>

namespace impm
{
  /**
   * Solves the linear systems of Newton's method: CG or GMRES of deal.II with
   * AMG, Jacobi or no preconditioner, or a direct solver, which also takes
   * over, counted, where an iterative one fails, unless what it has then is
   * good enough for Newton's method to go on.
   */
  template <int dim>
  class LinearSolver
  {
  public:
    LinearSolver(const SolverSpec     &spec,
                 MomentumBalance<dim> &balance,
                 dealii::TimerOutput  &timer);

    /** Prepares for the sparsity of a new step. Collective. */
    void
    begin_step();

    /** Says that the balance stands evaluated at u, for what follows. */
    void
    linearize_at(const Vector &u);

    /** dst = K src as MomentumBalance::vmult_lift. Collective. */
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
     * iterations. Throws ComputationError when even the direct solver fails,
     * LinearizationError when there is no tangent. Collective.
     */
    unsigned int
    solve(Vector &x, const Vector &b, double tolerance);

    unsigned int n_fallbacks = 0; ///< to the direct solver, all steps
    unsigned int n_tangents  = 0; ///< taken, all steps

  private:
    void
    update_preconditioner();

    unsigned int
    iterate(Vector &x, const Vector &b, double tolerance);

    void
    solve_directly(Vector &x, const Vector &b);

    /**
     * The unknowns of the momentum formulation are the nodes' momenta: an
     * increment of a node with little mass says little.
     */
    bool
    solves_for_momentum() const
    {
      return balance.in_momentum() &&
             spec.preconditioner == PreconditionerKind::none;
    }

    bool
    needs_matrix() const
    {
      return spec.linear_solver == LinearSolverKind::direct ||
             spec.tangent == TangentKind::matrix ||
             spec.preconditioner == PreconditionerKind::amg;
    }

    const SolverSpec       &spec;
    MomentumBalance<dim>   &balance;
    DifferenceQuotient<dim> quotient;
    dealii::TimerOutput    &timer;

    bool                                   matrix_is_current = false;
    dealii::TrilinosWrappers::SparseMatrix matrix;

    /** Of the matrix as it is, or null. */
    std::unique_ptr<dealii::TrilinosWrappers::SolverDirect> factors;
    dealii::SolverControl                                   direct_control;

    dealii::TrilinosWrappers::PreconditionAMG amg;
    std::vector<double>                       rigid_body_modes;
    Vector                                    inverse_diagonal;
  };
} // namespace impm

#endif
