#ifndef impm_solve_convergence_test_h
#define impm_solve_convergence_test_h

#include <impm/input/sections/solver.h>
#include <impm/solve/nonlinear_system.h>

#include <limits>

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
    using Evaluation = NonlinearSystem::Evaluation;

    explicit ConvergenceTest(const SolverSpec &spec)
      : spec(spec)
    {}

    /** An iteration with the norm of its change and its energy du Q (N m). */
    void
    count(double change, double energy);

    /**
     * Whether an iterate is good enough, every part of it: its residual is
     * small, and small beside what it was at first and beside what acts in it;
     * or it is round-off. The second criterion takes at least one iteration.
     */
    bool
    is_met(const Evaluation &now) const;

    /** Whether it is as good as an error of the solution must be, however
     * little the step has changed. */
    bool
    allows(const Evaluation &now) const;

    /**
     * Whether an iterate that is allowed is one of several in a row that get
     * no better: of a body that comes to rest, round-off is all that is left
     * to reduce. To be asked once for each iterate.
     */
    bool
    stagnates(const Evaluation &now);

    /** What the step has to solve: the residual of its first guess, by parts.
     */
    std::vector<double> first_residual;

  private:
    bool
    changes_little() const;

    const SolverSpec &spec;
    double            smallest_residual = std::numeric_limits<double>::max();
    unsigned int      n_in_vain         = 0;
    bool              any               = false;
    double            largest_change = 0, first_energy = 0;
    double            change = 0, energy = 0; ///< of the last iteration
  };
} // namespace impm

#endif
