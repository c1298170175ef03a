#ifndef impm_balance_step_problem_h
#define impm_balance_step_problem_h

#include <impm/balance/momentum_balance.h>
#include <impm/balance/point_response.h>
#include <impm/balance/terms/loads.h>
#include <impm/footprints/footprint_builder.h>
#include <impm/footprints/transfer.h>
#include <impm/grid/populated_cells.h>
#include <impm/scene/scene.h>
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

    /**
     * What holds a node exerts at the end of the step that has converged at `u`
     * (N), whatever the integrator weighs: forces of strain less loads, with
     * held_inertia(). Zero or what is left elsewhere. Collective.
     */
    Vector
    end_forces(const Vector &u) const;

    /**
     * The mean force (N) that gives a held value, by local index, its motion:
     * end_motion() takes its velocity for u / dt.
     */
    double
    held_inertia(const Vector &u, const unsigned int i) const
    {
      return integrator.has_inertia() ?
               motion.mass.local_element(i) *
                 (u.local_element(i) / dt - motion.velocity.local_element(i)) /
                 dt :
               0.;
    }

    const double          time, dt;
    const TimeIntegrator &integrator;

    const std::shared_ptr<const Discretization<dim>> discretization;
    Footprints<dim>                                  footprints;
    const PopulatedCells<dim>                        populated;
    const ResidualNorm                               norm;
    const StepConstraints<dim>                       constraints;
    PointResponse<dim>                               response;
    const NodalMotion                                motion;
    const unsigned int n_limited_boxes; ///< of all ranks
    /** Neither constrained nor unused, of all ranks. */
    const unsigned int n_active_dofs;
    unsigned int       n_held_cells  = 0;       ///< isolated ones
    const Loads       *loads         = nullptr; ///< one of the terms
    const Term        *stabilization = nullptr; ///< another one
    /** What the integrator takes for the acceleration at the start: gathered,
     * or from the forces then (m/s^2). */
    Vector                                              start_acceleration;
    const std::unique_ptr<const VelocitySmoothing<dim>> smoothing; ///< or null
    MomentumBalance<dim>                                balance;

  private:
    using Parts = typename MomentumBalance<dim>::Parts;

    /** The terms that this scene needs, and no others. */
    Parts
    make_parts(const Scene<dim>          &scene,
               const BackgroundGrid<dim> &grid,
               const MaterialPoints<dim> &points);

    void
    add_strain_terms(const Scene<dim>          &scene,
                     const BackgroundGrid<dim> &grid,
                     const MaterialPoints<dim> &points,
                     Parts                     &parts);

    /** f(0) and the acceleration that it gives, if they are asked for. */
    void
    find_start_forces(Parts &parts);

    void
    add_node_terms(const Scene<dim>          &scene,
                   const MaterialPoints<dim> &points,
                   Parts                     &parts);

    unsigned int
    count_active_dofs() const;
  };
} // namespace impm

#endif
