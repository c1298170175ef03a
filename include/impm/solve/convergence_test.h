#ifndef impm_solve_convergence_test_h
#define impm_solve_convergence_test_h

#include <impm/scene/scene.h>

namespace impm
{
  /**
   * When Newton's method may stop: where the residual is small, or where an
   * iteration changes little (Guilkey & Weiss 2003, eq. 13),
   *
   *   |du_k| <= eps_d max_i |du_i|  and  |du_k Q_k| <= eps_e |du_0 Q_0|,
   *
   * with the change du of the increment that answers the residual Q.
   */
  class ConvergenceTest
  {
  public:
    explicit ConvergenceTest(const SolverSpec &spec)
      : spec(spec)
    {}

    /** Forgets the step before. */
    void
    begin_step();

    /** What the step has to solve: the scaled residual at its first guess. */
    void
    set_first_residual(double residual);

    /** An iteration with the norm of its change and its energy du Q (N m). */
    void
    count(double change, double energy);

    /**
     * Whether an iterate with this scaled residual is good enough. The second
     * criterion takes at least one iteration.
     */
    bool
    is_met(double residual) const;

    /** Whether it is as good as an error of the solution must be, however
     * little the step has changed. */
    bool
    allows(double residual) const;

  private:
    const SolverSpec &spec;
    double            first_residual = 0;
    bool              any            = false;
    double            largest_change = 0, first_energy = 0;
    double            change = 0, energy = 0; ///< of the last iteration
  };
} // namespace impm

#endif
