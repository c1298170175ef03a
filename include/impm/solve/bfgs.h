#ifndef impm_solve_bfgs_h
#define impm_solve_bfgs_h

#include <impm/base/vector.h>

#include <deque>
#include <functional>

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
    explicit Bfgs(const unsigned int largest_number)
      : largest_number(largest_number)
    {}

    /** After K_0 has become another. */
    void
    clear()
    {
      pairs.clear();
    }

    /** Whether it is time for another K_0. */
    bool
    is_full() const
    {
      return pairs.size() >= largest_number;
    }

    /**
     * Takes a change of the increment (m) and of the residual (N), unless
     * their product is not clearly positive: the inverse must stay so.
     * Collective.
     */
    void
    add(const Vector &change, const Vector &residual_change);

    /** Writes K_0^-1 times the second vector into the first. */
    using Solve = std::function<void(Vector &, const Vector &)>;

    /** dst = the corrected inverse times src. Collective. */
    void
    apply(Vector &dst, const Vector &src, const Solve &solve) const;

  private:
    struct Pair
    {
      Vector change, residual_change;
      double product;
    };

    const unsigned int largest_number;
    std::deque<Pair>   pairs; ///< the oldest first
    mutable Vector     work;
  };
} // namespace impm

#endif
