#ifndef impm_balance_step_problem_h
#define impm_balance_step_problem_h

#include <impm/balance/momentum_balance.h>
#include <impm/balance/point_response.h>
#include <impm/balance/terms/loads.h>
#include <impm/footprints/footprint_builder.h>
#include <impm/footprints/gather.h>
#include <impm/grid/populated_cells.h>
#include <impm/grid/step_result.h>
#include <impm/time/time_integrator.h>

#include <memory>

namespace impm
{
  /**
   * Everything that belongs to one step and dies with it: where the points
   * touch the grid, what holds its nodes, their motion at the start, the trial
   * state of the points, and the balance of momentum with its terms. Making
   * one is the one way to prepare a step: from points and grid as they are,
   * whether they come from the step before, from another grid or from disk.
   */
  template <int dim>
  class StepProblem
  {
  public:
    /**
     * For the step from `time` to `time + dt`. Throws ComputationError, on
     * every rank alike, when a point has no stress at the start. Collective.
     */
    StepProblem(const Scene<dim>          &scene,
                const BackgroundGrid<dim> &grid,
                const MaterialPoints<dim> &points,
                const RigidBodies<dim>    &rigid,
                const TimeIntegrator      &integrator,
                FootprintBuilder<dim>     &builder,
                WorkCounts                &counts,
                double                     time,
                double                     dt);

    StepProblem(const StepProblem &) = delete;

    /**
     * The increment of an explicit step, which the forces at its start give,
     * with what is prescribed. Collective.
     */
    void
    explicit_increment(Vector &u) const;

    /** Motion of the nodes after a step that has converged at `u`. Collective.
     */
    StepResult
    end_motion(const Vector &u) const;

    /** The mean external force over the step (N) at a local element, with the
     * sign of an internal one. */
    double
    load_at(const unsigned int i) const
    {
      const double weight = integrator.force_factor();
      return loads == nullptr ?
               0. :
               weight * loads->at_end.local_element(i) +
                 (1 - weight) * loads->at_start.local_element(i);
    }

    const double          time, dt;
    const TimeIntegrator &integrator;

    const std::shared_ptr<const Discretization<dim>> discretization;
    Footprints<dim>                                  footprints;
    const PopulatedCells<dim>                        populated;
    /** Forces at a strain of one (N), see forces_at_unit_strain(). */
    const Vector               unit_strain_forces;
    const StepConstraints<dim> constraints;
    PointResponse<dim>         response;
    const NodalMotion          motion;
    const unsigned int         n_limited_boxes; ///< of all ranks
    /** Neither constrained nor unused, of all ranks. */
    const unsigned int n_active_dofs;
    unsigned int       n_held_cells = 0;       ///< isolated ones
    Loads             *loads        = nullptr; ///< one of the terms
    const std::unique_ptr<const VelocitySmoothing<dim>> smoothing; ///< or null
    MomentumBalance<dim>                                balance;
    /** What the integrator takes for the acceleration at the start: gathered,
     * or from the forces then (m/s^2). */
    const Vector start_acceleration;

  private:
    /** The terms that this scene needs, and no others. */
    typename MomentumBalance<dim>::Parts
    make_parts(const Scene<dim>          &scene,
               const BackgroundGrid<dim> &grid,
               const MaterialPoints<dim> &points);

    unsigned int
    count_active_dofs() const;

    Vector
    find_start_acceleration() const;
  };
} // namespace impm

#endif
