#ifndef impm_solve_bfgs_h
#define impm_solve_bfgs_h

#include <impm/solve/inverses.h>

#include <deque>

namespace impm
{
  /**
   * The BFGS method (Matthies & Strang, IJNME 14, 1979): the inverse of a
   * tangent K_0 that is kept is corrected by what later iterations have shown,
   * so that it maps each change of the residual to the change of the increment
   * that caused it. Stored as these pairs; applied by two loops over them.
   */
  class Bfgs
  {
  public:
    /** After K_0 has become another. */
    void
    clear()
    {
      pairs.clear();
    }

    unsigned int
    n_updates() const
    {
      return pairs.size();
    }

    /**
     * Takes a change of the increment (m) and of the residual (N), unless
     * their product is not clearly positive: the inverse must stay so.
     * Collective.
     */
    void
    add(const Vector &change, const Vector &residual_change);

    /** dst = K_0^-1, corrected, times src. Collective. */
    void
    apply(Vector &dst, const Vector &src, const LinearMap &inverse) const;

  private:
    struct Pair
    {
      Vector change, residual_change;
      double product;
    };
    std::deque<Pair> pairs; ///< the oldest first
  };
} // namespace impm

#endif
