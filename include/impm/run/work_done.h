#ifndef impm_run_work_done_h
#define impm_run_work_done_h

#include <impm/balance/step_problem.h>

#include <vector>

namespace impm
{
  /**
   * The work (J) that has been done since the start, by the trapezoidal rule.
   * External work is that of faces, rigid bodies and loads. The force of a
   * carrier at the start of a step is what it was at the end of the one before,
   * as a whole, since the grid may be another: exact for carriers that move as
   * a whole; of others, the force at the end counts, but for their mean motion.
   * Inertia of what they hold counts by its mean force. Internal work is that
   * of the stresses along the grid's increments. What external work leaves
   * beside it, stabilization and kinetic energy is lost where points go on to a
   * new grid, out of balance, and to integrators that damp.
   */
  template <int dim>
  class WorkDone
  {
  public:
    /** The work (J) of a step, and the forces at its end by carrier (N). */
    struct Step
    {
      double external = 0, internal = 0, stabilization = 0, contact = 0;
      /** Between the trapezoidal rule and the forces at one end (J). */
      double                              uncertain = 0;
      std::vector<dealii::Tensor<1, dim>> last_forces;
    };

    /** Of one that has converged at `u`, with its end_forces(). Collective. */
    Step
    of_step(const StepProblem<dim> &problem,
            const Vector           &u,
            const Vector           &forces) const;

    /** Goes on by one. */
    void
    add(const Step &step);

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &external &internal &stabilization &uncertain &contact
        &last_forces;
    }

    double external      = 0; ///< (J)
    double internal      = 0; ///< (J)
    double stabilization = 0; ///< by ghost penalty and holding (J)
    double uncertain     = 0; ///< of the external work (J)
    double contact       = 0; ///< stored in contact, or lost to friction (J)

  private:
    /** By carrier: the forces at the end of the last step (N). */
    std::vector<dealii::Tensor<1, dim>> last_forces;
  };
} // namespace impm

#endif
