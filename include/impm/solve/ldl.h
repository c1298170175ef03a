#ifndef impm_solve_ldl_h
#define impm_solve_ldl_h

#include <impm/solve/sparse_matrix.h>

#include <memory>

namespace impm
{
  /**
   * The inverse of a symmetric matrix as L D L^T (CHOLMOD), which takes half
   * the work of LU and no search for pivots. The first rank does it for all;
   * where entries stand is analysed once. Nothing is exchanged for the sake of
   * round-off, so that a solution has to be looked at where the matrix is not
   * positive definite. The matrix must live as long.
   */
  class Ldl
  {
  public:
    explicit Ldl(const SparseMatrix &matrix);
    ~Ldl();

    /** Takes the matrix as it is now, of which it reads the lower half. Returns
     * whether it could, on every rank alike. Collective. */
    bool
    factorize();

    /** After that. Collective. */
    void
    solve(Vector &x, const Vector &b);

    /** How many eigenvalues of what was factorized are negative: as many as
     * pivots (Sylvester). Collective. */
    unsigned int
    n_negative() const;

  private:
    struct Cholmod;

    const SparseMatrix            &matrix;
    const std::unique_ptr<Cholmod> cholmod;
  };
} // namespace impm

#endif
