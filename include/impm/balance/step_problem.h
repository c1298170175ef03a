#ifndef impm_balance_step_problem_h
#define impm_balance_step_problem_h

#include <impm/balance/momentum_balance.h>
#include <impm/balance/terms/ghost_penalty.h>
#include <impm/balance/terms/internal_forces.h>
#include <impm/balance/terms/loads.h>
#include <impm/balance/terms/nodal_forces.h>
#include <impm/footprints/footprint_builder.h>
#include <impm/footprints/transfer.h>
#include <impm/grid/populated_cells.h>
#include <impm/scene/scene.h>
#include <impm/time/time_integrator.h>

#include <memory>

namespace impm
{
  /**
   * Springs on all free nodes that hold what a quasi-static step may move: at
   * each the force of the material at a strain of one over a cell, times a
   * factor. They are at rest where the step begins, or pushed along a mode.
   */
  struct StepDamping
  {
    double        factor = 0; ///< none
    double        push   = 0; ///< (m)
    const Vector *mode   = nullptr;
  };

  template <int dim>
  class Contact;

  template <int dim>
  class FollowingLoads;

  template <int dim>
  class FreeBodies;

  template <int dim>
  class IsolatedCells;

  template <int dim>
  class SurfacePoints;

  /**
   * Everything that belongs to one step and dies with it: where the points
   * touch the grid, what holds its nodes, their motion at the start, the trial
   * state of the points, the forces, and the balance of momentum. Making
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
                double                     dt,
                const SurfacePoints<dim>  *surfaces = nullptr,
                const StepDamping         &damping  = {});

    StepProblem(const StepProblem &) = delete;

    ~StepProblem();

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

    /** What a face or a rigid body exerts by what it holds, in end_forces(),
     * and by contact (N), or its moment (N m), along a direction as it is
     * given; after a step that has converged at `u`. Collective. */
    double
    reaction(const ReactionSpec &spec,
             const Vector       &u,
             const Vector       &end_forces) const;

    /**
     * After a step has converged at `u`: lets the springs of pieces that
     * nothing holds but contact be at rest there, and returns whether they took
     * so much of its force that the step is to be solved anew. Collective.
     */
    bool
    relax_springs(const Vector &u);

    /** Part of the force of contact that the springs took last. */
    double spring_share = 0;

    /** After a step has converged at `u`: the resultants of springs that hold
     * pieces of material, over all loads; 0 if there are none. Collective. */
    double
    loads_on_springs(const Vector &u) const;

    /** Those of the terms that are no physics: ghost penalty, springs of pieces
     * that nothing holds and of damping. */
    std::vector<const Term *>
    stabilization() const;

    /** Of this rank, of what is large (bytes). The matrix is none of it. */
    MemoryByOwner
    memory_by_owner() const;

    const double          time, dt;
    const TimeIntegrator &integrator;

    const std::shared_ptr<const Discretization<dim>> discretization;
    Footprints<dim>                                  footprints;
    const PopulatedCells<dim>                        populated;
    const std::unique_ptr<const ResidualNorm>        norm; ///< null if explicit

    const Scene<dim> &scene;

  private:
    NodalMotion gathered; ///< before it is known what holds the nodes

  public:
    const StepConstraints<dim> constraints;
    PointResponse<dim>         response;
    /** Zero where a node is held at rest. */
    const NodalMotion  motion;
    const unsigned int n_limited_boxes; ///< of all ranks
    /** Neither constrained nor unused, of all ranks. */
    const unsigned int n_active_dofs;

    /** Of the points of surfaces, or null if there are none. */
    const std::unique_ptr<const Footprints<dim>> surface_prints;

    // The terms of the balance, or null.
    const std::unique_ptr<InternalForces<dim>> internal_forces;
    const std::unique_ptr<GhostPenalty<dim>>   ghost_penalty;
    const std::unique_ptr<Loads<dim>>          loads;
    const std::unique_ptr<FollowingLoads<dim>> following_loads;
    /** Which contact moves, or null. */
    const std::unique_ptr<FreeBodies<dim>> free_bodies;
    const std::unique_ptr<Contact<dim>>    contact;

    const Vector start_forces; ///< f(0) (N), if asked for, or empty
    /** What the integrator takes for the acceleration at the start: gathered,
     * or from the forces then (m/s^2). */
    const Vector                                        start_acceleration;
    std::unique_ptr<const IsolatedCells<dim>>           isolated; ///< or null
    unsigned int                                        n_held_cells = 0;
    const bool                                          is_damped;
    const std::unique_ptr<NodalForces>                  nodal_forces;
    const std::unique_ptr<const VelocitySmoothing<dim>> smoothing; ///< or null
    MomentumBalance<dim>                                balance;

  private:
    /** Throws ComputationError, on every rank alike, for loads that are no
     * finite numbers. */
    void
    check_loads() const;

    /** Whether there is a potential but for loads that follow surfaces. */
    bool
    has_guide() const;

    /** Finds the stresses at the start; returns f(0), if it is asked for. */
    Vector
    find_start_forces();

    Vector
    find_start_acceleration() const;

    std::unique_ptr<NodalForces>
    make_nodal_forces(const MaterialPoints<dim> &points,
                      double                     isolated_stiffness,
                      const StepDamping         &damping);
  };
} // namespace impm

#endif
