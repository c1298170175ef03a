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
   * a whole, and turn; of others, the force at the end counts, but for their
   * mean motion. Inertia of what they hold counts by its mean force. Internal
   * work is that of the stresses along the grid's increments. What external
   * work leaves beside it, stabilization and kinetic energy is lost where
   * points go on to a new grid, out of balance, and to integrators that damp.
   */
  template <int dim>
  class WorkDone
  {
  public:
    /** The work (J) of a step, and at its end, by carrier, the forces (N) and
     * their moments about the centres of what turns (N m). */
    struct Step
    {
      double external = 0, internal = 0, stabilization = 0, contact = 0;
      double heat = 0; ///< see PointResponse::work_of_heat
      /** Between the trapezoidal rule and the forces at one end (J). */
      double                              uncertain = 0;
      std::vector<dealii::Tensor<1, dim>> last_forces;
      std::vector<RotationVector>         last_moments;
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
      archive &external &internal &stabilization &uncertain &contact &heat
        &last_forces &last_moments;
    }

    double external      = 0; ///< (J)
    double internal      = 0; ///< (J)
    double stabilization = 0; ///< by ghost penalty and holding (J)
    double uncertain     = 0; ///< of the external work (J)
    double contact       = 0; ///< stored in contact, or lost to friction (J)
    double heat          = 0; ///< by thermal expansion (J)

  private:
    // At the end of the last step, see Step.
    std::vector<dealii::Tensor<1, dim>> last_forces;
    std::vector<RotationVector>         last_moments;
  };
} // namespace impm

#endif
