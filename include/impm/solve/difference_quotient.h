#ifndef impm_solve_difference_quotient_h
#define impm_solve_difference_quotient_h

#include <impm/balance/momentum_balance.h>

namespace impm
{
  /**
   * The tangent's action by a difference of residuals (Sulsky & Kaul 2004, eq.
   * 2.4.18): J(u) s = |s| (r(u + e s / |s|) - r(u)) / e with e = h |u|, or h
   * itself, in units of a cell, where u = 0. In the momentum formulation the
   * unknown is that of the nodes.
   */
  template <int dim>
  class DifferenceQuotient
  {
  public:
    DifferenceQuotient(MomentumBalance<dim> &balance, double step);

    /** Where the balance stands evaluated at the moment. */
    void
    linearize_at(const Vector &u);

    /**
     * Like MomentumBalance::vmult; leaves the balance evaluated elsewhere.
     * Throws LinearizationError where the laws have no stress. Collective.
     */
    void
    vmult(Vector &dst, const Vector &src);

    /** Like MomentumBalance::vmult_lift. */
    void
    vmult_lift(Vector &dst, const Vector &src);

  private:
    /** Of an increment, or of the momentum that it stands for. */
    double
    norm(const Vector &increment) const;

    MomentumBalance<dim> &balance;
    const double          step;
    Vector                u, residual, direction;
  };
} // namespace impm

#endif
