#ifndef impm_solve_direct_solver_h
#define impm_solve_direct_solver_h

#include <impm/solve/inverses.h>
#include <impm/solve/ldl.h>

namespace impm
{
  /**
   * Solves to round-off with a matrix whose entries change: a symmetric one by
   * L D L^T, any other, and one that this cannot eliminate, by LU. The matrix
   * must live as long. All is collective.
   */
  class DirectSolver
  {
  public:
    DirectSolver(const SparseMatrix &matrix, bool is_symmetric);

    /** Takes the matrix as it is now. Throws LinearizationError, on every rank
     * alike, when it is singular. */
    void
    factorize();

    /** With the matrix as it was then, and still is. Throws as factorize(). */
    void
    solve(Vector &x, const Vector &b);

    /** Whether no eigenvalue is negative for sure, of a symmetric matrix. */
    bool
    is_positive() const
    {
      return !lu.vmult && ldl && ldl->n_negative() == 0;
    }

  private:
    const SparseMatrix        &matrix;
    const std::unique_ptr<Ldl> ldl; ///< or null
    LinearMap                  lu;  ///< where L D L^T does not do
  };
} // namespace impm

#endif
