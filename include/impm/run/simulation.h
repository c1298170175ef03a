#ifndef impm_run_simulation_h
#define impm_run_simulation_h

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/timer.h>

#include <impm/app/command_line.h>
#include <impm/app/console.h>
#include <impm/output/history.h>
#include <impm/output/pictures.h>
#include <impm/scene/scene.h>
#include <impm/solve/step_solver.h>
#include <impm/study/reference.h>

namespace impm
{
  /**
   * One run of a scene: the loop over time steps and what it writes. Data
   * flows one way through a step: points -> footprints -> Newton on the grid
   * -> points -> next grid.
   */
  template <int dim>
  class Simulation
  {
  public:
    /**
     * Builds grid and bodies. Throws InputError when they do not fit; writes
     * nothing. Collective.
     */
    Simulation(const Scene<dim>      &scene,
               CommandLine::Verbosity verbosity,
               MPI_Comm               communicator);

    /** Prints what the points carry and how many there are. Collective. */
    void
    describe();

    /**
     * Runs to the end and writes into a directory, with the resolved
     * parameters. Throws ComputationError after it has saved the last good
     * state. The first rank compares with finer runs. Collective.
     */
    void
    run(const std::string &directory,
        const std::string &scene_name,
        const std::string &parameters,
        const FinerRuns   &finer_runs = {});

  private:
    void
    advance();

    typename StepSolver<dim>::Result
    attempt(double dt);

    /** What time steps are counted in (s): a CFL number of one, or 1. */
    double
    step_unit() const;

    /** Warns of steps that a theta below one half cannot take. */
    void
    warn_of_instability();

    void
    commit();

    /** Why the converged increment must not be used; empty if it may. */
    std::string
    forbidden_motion() const;

    double
    external_work_of_step() const;

    /** What is due once a row of the history. Collective. */
    void
    write_row(const StepReport &since_row);

    void
    picture(bool grid_has_increment);

    void
    save_last_good_state(const std::string &reason);

    void
    write_summary(const std::string &scene_name,
                  const std::string &status,
                  const FinerRuns   &finer_runs);

    double
    grid_motion(unsigned int face) const;

    const Scene<dim>                     &scene;
    const MPI_Comm                        communicator;
    dealii::ConditionalOStream            silence;
    dealii::TimerOutput                   timer;
    BackgroundGrid<dim>                   grid;
    MaterialPoints<dim>                   points;
    RigidBodies<dim>                      rigid;
    const std::unique_ptr<TimeIntegrator> integrator;
    MomentumBalance<dim>                  balance;
    StepSolver<dim>                       step_solver;
    Pictures<dim>                         pictures;
    History<dim>                          history;
    Reference<dim>                        reference;
    Console                               console;
    Vector                                u, end_velocity, end_acceleration;

    dealii::Timer wall;
    std::string   directory;
    double        time = 0, step_size, next_picture = 0;
    StepReport    report;
    struct
    {
      unsigned long newton = 0, linear = 0, line_searches = 0, cuts = 0,
                    projections = 0, noise_stops = 0;
    } sums;
  };
} // namespace impm

#endif
