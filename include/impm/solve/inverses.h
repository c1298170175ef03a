#ifndef impm_solve_inverses_h
#define impm_solve_inverses_h

#include <impm/solve/sparse_matrix.h>

#include <functional>
#include <vector>

namespace impm
{
  /** What deal.II's solvers know of a matrix, a preconditioner, an inverse. */
  struct LinearMap
  {
    std::function<void(Vector &dst, const Vector &src)> vmult;
  };

  /** Throws LinearizationError for a matrix without an inverse. */
  [[noreturn]] void
  blame_matrix();

  /** Unknowns of a system that multigrid factorizes rather than make it
   * coarser: to factorize more is dear in space, not in the plane. */
  inline unsigned int
  largest_coarse_system(const unsigned int dim)
  {
    return dim == 3 ? 500 : 2000;
  }

  /**
   * Smoothed aggregation (ML) of nodes for elastic bodies; `modes` are what
   * costs hardly any energy, by owned compact index. The matrix has to stay
   * where it is. When it gets other entries, those are smoothed with, while the
   * coarser levels stay as they were. Throws LinearizationError, on every rank
   * alike, when the matrix is singular. Collective.
   */
  LinearMap
  make_amg(const SparseMatrix                     &matrix,
           const std::vector<std::vector<double>> &modes);

  /**
   * The inverse of a matrix that stays as it is, as L U (Amesos, KLU). Throws
   * LinearizationError as make_amg() does, when applied, too. Collective.
   */
  LinearMap
  make_lu(const SparseMatrix &matrix);
} // namespace impm

#endif
