#ifndef impm_solve_negative_curvature_h
#define impm_solve_negative_curvature_h

#include <impm/solve/inverses.h>

namespace impm
{
  /**
   * Looks for a direction x along which a symmetric matrix is negative, beyond
   * round-off: x K x < 0. With its inverse by inverse iteration, with a
   * preconditioner by conjugate gradients on a random right-hand side, which
   * come upon one while they converge. The largest value of x is one; without
   * such a direction x is of no use. Returns whether there is one. Collective.
   */
  bool
  find_negative_curvature(const SparseMatrix &matrix,
                          const LinearMap    &inverse,
                          bool                is_exact,
                          Vector             &x);
} // namespace impm

#endif
