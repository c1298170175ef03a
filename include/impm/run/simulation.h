#ifndef impm_run_simulation_h
#define impm_run_simulation_h

#include <deal.II/base/timer.h>

#include <impm/app/command_line.h>
#include <impm/app/console.h>
#include <impm/contact/surface_points.h>
#include <impm/grid/adaptive_grid.h>
#include <impm/grid/load_balance.h>
#include <impm/output/history.h>
#include <impm/output/pictures.h>
#include <impm/output/warnings.h>
#include <impm/run/checkpoint_files.h>
#include <impm/run/jump.h>
#include <impm/run/solve_step.h>
#include <impm/run/work_done.h>
#include <impm/study/reference.h>
#include <impm/time/step_control.h>

namespace impm
{
  /**
   * One run of a scene: the loop over time steps and what it writes. Data
   * flows one way through a step: policy -> grid and points -> StepProblem ->
   * Newton's method -> StepResult -> points -> grid.
   */
  template <int dim>
  class Simulation
  {
  public:
    /**
     * Builds grid and bodies. Throws InputError when they do not fit; writes
     * nothing. The policy is that of the scene unless another one is given.
     * Collective.
     */
    Simulation(const Scene<dim>                &scene,
               CommandLine::Verbosity           verbosity,
               MPI_Comm                         communicator,
               std::unique_ptr<GridPolicy<dim>> policy = nullptr);

    /** Prints what the points carry and how many there are. Collective. */
    void
    describe();

    /**
     * Runs to the end and writes into a directory, with the resolved
     * parameters: from the start, in place of what an older run has left there,
     * or from its last checkpoint on. Throws ComputationError or Interruption
     * after it has saved the last good state, InputError if another run is in
     * the directory, or its checkpoint is none to restart from. The first rank
     * compares with finer runs. Collective.
     */
    void
    run(const std::string &directory,
        const std::string &scene_name,
        const std::string &parameters,
        const FinerRuns   &finer_runs = {},
        bool               restart    = false);

  private:
    void
    advance();

    /** Prepares a step from points and grid as they are and solves it. Returns
     * why the result must not be used; empty if it may. */
    std::string
    attempt(double dt);

    /**
     * What a step that is solved gains of energy by itself for certain, as the
     * grid sees it (J); 0 if it is not known: with laws without a potential, in
     * explicit and in quasi-static steps. Collective.
     */
    double
    energy_gain_of_step() const;

    /** Why the step must not be used for its energy; empty if it may.
     * Collective. */
    std::string
    check_energy();

    /** Warns of energy that the run has gained by itself; throws
     * ComputationError when that is more than it ever had. */
    void
    watch_energy();

    /** Warns, at the end, of much energy that was lost. */
    void
    report_energy_loss();

    /** Lets the policy change the cells, and ranks share the work anew. */
    void
    adapt();

    /** Lets points split and merge. */
    void
    resample();

    /** After a step: whether nodes that have kept their motion must go back to
     * the grid now. Collective. */
    bool
    reset_is_due() const;

    /** Sends them back and sorts points and rigid bodies into the cells. */
    void
    reset_grid();

    /** Whether nodes are away from a grid to which they can go back. */
    bool
    is_off_grid() const
    {
      return grid.is_moved() && !grid.is_lagrangian;
    }

    /** Hands the result of the step to points and grid. */
    void
    commit();

    /** The time step (s) of a CFL number of one. Collective. */
    double
    cfl_unit() const;

    /** What time steps are counted in (s): a CFL number of one, or 1. */
    double
    step_unit() const;

    /** Warns of steps beyond what the integrator is stable in. */
    void
    warn_of_instability();

    /** Warns of points from files that lie in each other. Collective. */
    void
    warn_of_overfull_cells();

    /** Says what is the first of its kind. Alike on all ranks. */
    void
    warn(const std::string &kind, const std::string &text);

    /** The likely causes of a step that cannot be made, with what failed last.
     * Collective. */
    std::string
    explain(const std::string &failure) const;

    /** Whether steps that fail may be damped. */
    bool
    can_jump() const
    {
      return scene.solver.unstable_equilibria == UnstableEquilibria::leave;
    }

    /** After an attempt that failed where a shorter one does not help: warns,
     * and damps the next one more; throws ComputationError where that does not
     * help either. */
    void
    damp(const std::string &failure);

    /** Warns of a mode along which the equilibrium at the start of a step is
     * not stable. Collective. */
    void
    report_instability(const Vector &mode);

    /** Whether the run ends after a step, at a time. */
    bool
    is_over(const unsigned int step, const double at) const
    {
      return at >= scene.time.end * (1 - 1e-12) ||
             step >= scene.time.largest_number_of_steps;
    }

    /** Whether a step, to a time, ends with a row of the history. */
    bool
    row_is_due(const unsigned int step, const double at) const
    {
      return is_over(step, at) || step % scene.output.row_steps == 0;
    }

    /** Counts the pieces of the bodies, and tells when one has come apart.
     * Collective. */
    void
    watch_pieces();

    /** Tells when the plastic flow of a body localises. Collective. */
    void
    watch_flow();

    /** Counts the points that have failed, and tells of the first ones of a
     * body. Collective. */
    void
    watch_failed_points();

    /** Tells when a body begins to soften. Collective. */
    void
    watch_softening();

    /** Warns of prescribed faces that have lost their material. Collective. */
    void
    watch_faces();

    /** Reports on surfaces that meet, and warns of such as pass into each
     * other. Collective. */
    void
    watch_contact();

    /** Warns of loads on pieces of material that nothing holds, without
     * inertia. Collective. */
    void
    watch_springs();

    /** What is due once a row of the history. Collective. */
    void
    write_row();

    /** Throws ComputationError if an expression had a value that is not finite.
     * Collective. */
    void
    check_expressions() const;

    /** Of points and grid as they are, and of the step that ended on it unless
     * there is none. Collective. */
    void
    picture(bool grid_has_step);

    NodalPicture
    nodal_picture(bool grid_has_step);

    /** All that outlives a step. Collective. */
    void
    save_checkpoint(const std::string &reason);

    /** Throws InputError if there is none, or the scene is another. Collective.
     */
    void
    load_checkpoint();

    /** Writes to an archive, or reads from it, all but grid and points.
     * Collective. */
    template <class Archive>
    void
    exchange(Archive &archive);

    /** When a step is complete: saves what is due, and throws Interruption if
     * a signal has come. Collective. */
    void
    pause(bool is_last);

    /** Since the start, the time before a restart included (s). */
    double
    wall_seconds() const;

    /** Wall time by phase, likewise (s). */
    std::map<std::string, double>
    phases() const;

    /** What solves the linear systems. */
    std::string
    name_linear_solver() const;

    void
    write_summary(const std::string &status, const FinerRuns &finer_runs = {});

    const Scene<dim>    scene;
    const MPI_Comm      communicator;
    dealii::TimerOutput timer;

    // What outlives a step.
    BackgroundGrid<dim>                    grid;
    const std::unique_ptr<GridPolicy<dim>> policy;
    MaterialPoints<dim>                    points;
    RigidBodies<dim>                       rigid;
    std::unique_ptr<SurfacePoints<dim>>    surfaces; ///< or null
    LoadBalance<dim>                       balance;
    double       best_imbalance = 1; ///< that could be reached the last time
    unsigned int adapted_step   = 0; ///< the last that began by it
    double       time           = 0;

    const std::unique_ptr<TimeIntegrator> integrator;
    StepControl                           control;
    FootprintBuilder<dim>                 builder;
    WorkCounts                            counts;
    std::unique_ptr<StepProblem<dim>>     problem; ///< of this step
    StepResult                            result;
    std::vector<dealii::Tensor<1, dim>>   increments; ///< of the points in it

    /** Of nodes that keep their motion, since they were on the grid. */
    struct OffGrid
    {
      double       start    = 0; ///< (s)
      unsigned int n_steps  = 0;
      double       in_cells = 0; ///< see GridMotion

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &start &n_steps &in_cells;
      }
    } off_grid;

    WorkDone<dim>                work;
    typename WorkDone<dim>::Step step_work; ///< of the step that is solved
    Vector      end_forces;    ///< of the step that is solved, see StepProblem
    double      step_gain = 0; ///< likewise, see energy_gain_of_step()
    StepFigures figures;       ///< likewise
    std::vector<double> residuals; ///< likewise, see NewtonSolver::Result
    Jump                jump;      ///< that is on its way, if any
    PointChanges        resampled; ///< since the start

    Pictures<dim>             pictures;
    History<dim>              history;
    Reference<dim>            reference;
    Console                   console;
    Warnings                  warnings;
    std::array<bool, 2 * dim> face_holds{}; ///< material, in the last step
    std::vector<unsigned int> pieces;       ///< by body, at the last row
    std::vector<double>       widest_flow;  ///< by body, see PlasticFlow
    std::vector<char>         has_failed;   ///< by body, some of its points
    dealii::Timer             wall;
    std::string               directory, scene_name, parameters;
    StepReport                report; ///< of the step that is being made
    StepReport                total;  ///< of all that are completed
    StepReport                since_row;
    bool                      is_between_steps = true;

    std::unique_ptr<CheckpointFiles> checkpoints;
    double                           last_checkpoint = 0; ///< (s) of `wall`
    double                           seconds_before  = 0; ///< the restart
    std::map<std::string, double>    phases_before;       ///< the restart
  };
} // namespace impm

#endif
