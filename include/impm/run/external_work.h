#ifndef impm_run_external_work_h
#define impm_run_external_work_h

#include <impm/balance/step_problem.h>

#include <vector>

namespace impm
{
  /**
   * The work (J) that faces, rigid bodies and loads have done since the start,
   * by the trapezoidal rule. The force of a carrier at the start of a step is
   * what it was at the end of the one before, as a whole, since the grid may be
   * another: exact for carriers that move as a whole; of others, the force at
   * the end counts, but for their mean motion. Inertia of what they hold counts
   * by its mean force. What ghost penalty and holding take of it is counted
   * apart.
   */
  template <int dim>
  class ExternalWork
  {
  public:
    /** Adds a step that has converged at `u`, with its end_forces().
     * Collective.
     */
    void
    add(const StepProblem<dim> &problem, const Vector &u, const Vector &forces);

    double done          = 0; ///< (J)
    double stabilization = 0; ///< of it, taken by the ghost penalty (J)

  private:
    /** By carrier: the forces at the end of the last step (N). */
    std::vector<dealii::Tensor<1, dim>> last_forces;
  };
} // namespace impm

#endif
