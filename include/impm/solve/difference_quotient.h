#ifndef impm_solve_difference_quotient_h
#define impm_solve_difference_quotient_h

#include <impm/solve/nonlinear_system.h>

namespace impm
{
  /**
   * The tangent's action by a difference of residuals (Sulsky & Kaul 2004, eq.
   * 2.4.18): J(u) s = |s| (r(u + e s / |s|) - r(u)) / e with e = h |u|, a tenth
   * of it and so on where that turns a point inside out, until no node moves by
   * more than h cells; by h cells where u = 0. In the momentum formulation the
   * unknown is that of the nodes.
   */
  class DifferenceQuotient
  {
  public:
    DifferenceQuotient(NonlinearSystem &system, const double step)
      : system(system)
      , step(step)
    {}

    /** Where the system stands evaluated at the moment. */
    void
    linearize_at(const Vector &u);

    /**
     * Like NonlinearSystem::vmult; leaves the system evaluated elsewhere, with
     * the tangent that it had.
     * Throws LinearizationError where there is no residual. Collective.
     */
    void
    vmult(Vector &dst, const Vector &src);

    /** Like NonlinearSystem::vmult_lift. */
    void
    vmult_lift(Vector &dst, const Vector &src);

  private:
    /** Of an increment, or of the momentum that it stands for. */
    double
    norm(Vector increment) const;

    NonlinearSystem &system;
    const double     step;
    Vector           u, residual, direction, moved;
  };
} // namespace impm

#endif
