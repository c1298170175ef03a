#include <impm/solve/direct_solver.h>

namespace impm
{
  DirectSolver::DirectSolver(const SparseMatrix &matrix,
                             const bool          is_symmetric)
    : matrix(matrix)
    , ldl(is_symmetric ? std::make_unique<Ldl>(matrix) : nullptr)
  {}

  void
  DirectSolver::factorize()
  {
    lu = {};
    if (!ldl || !ldl->factorize())
      lu = make_lu(matrix);
  }

  void
  DirectSolver::solve(Vector &x, const Vector &b)
  {
    if (!lu.vmult)
      {
        ldl->solve(x, b);
        // Without a search for pivots an indefinite matrix may be lost in
        // round-off; one that is nearly singular is for LU to judge, too.
        Vector rest = b;
        matrix.vmult(rest, x);
        rest -= b;
        if (rest.l2_norm() <= 1e-8 * b.l2_norm())
          return;
        lu = make_lu(matrix);
      }
    lu.vmult(x, b);
  }
} // namespace impm
