#include <deal.II/base/utilities.h>

#include <deal.II/lac/vector.h>

#include <impm/balance/heat_conduction.h>
#include <impm/balance/terms/contact.h>
#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/footprints/transfer.h>
#include <impm/grid/grips.h>
#include <impm/grid/touching.h>
#include <impm/input/expressions.h>
#include <impm/run/motion_limits.h>
#include <impm/run/run_directory.h>
#include <impm/run/signals.h>
#include <impm/run/simulation.h>
#include <impm/run/step_error.h>
#include <impm/scene/scene.h>
#include <impm/scene/shared_cells.h>
#include <impm/scene/thin_parts.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::unique_ptr<GridPolicy<dim>>
    make_policy(const Scene<dim> &scene)
    {
      if (scene.adaptation.criteria.empty())
        return std::make_unique<GridPolicy<dim>>(scene.faces);
      return std::make_unique<AdaptiveGrid<dim>>(scene.faces, scene.adaptation);
    }

    /** Fills the bodies, on a grid that has been adapted to them. */
    template <int dim>
    MaterialPoints<dim>
    seed_points(const Scene<dim>    &scene,
                GridPolicy<dim>     &policy,
                BackgroundGrid<dim> &grid)
    {
      const auto wants_other_cells = [&](const PolicyTime &now) {
        const MaterialPoints<dim> points(choose_layout(scene),
                                         *scene.history,
                                         scene.bodies,
                                         scene.loads.tractions,
                                         grid,
                                         true);
        const RigidBodies<dim>    rigid(scene.bodies, scene.geometry, grid);
        return policy.flag_cells(grid, points, rigid, now);
      };
      if (!scene.adaptation.criteria.empty())
        for (unsigned int i = 0; i < policy.largest_number_of_rounds() + 1 &&
                                 wants_other_cells({0, i});
             ++i)
          grid.adapt();
      return MaterialPoints<dim>(choose_layout(scene),
                                 *scene.history,
                                 scene.bodies,
                                 scene.loads.tractions,
                                 grid);
    }
  } // namespace

  template <int dim>
  Simulation<dim>::Simulation(const Scene<dim>                &the_scene,
                              const CommandLine::Verbosity     verbosity,
                              const MPI_Comm                   communicator,
                              std::unique_ptr<GridPolicy<dim>> other_policy)
    : scene(the_scene)
    , communicator(communicator)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , grid(scene.grid, communicator)
    , policy(other_policy ? std::move(other_policy) : make_policy(scene))
    , points(seed_points(scene, *policy, grid))
    , rigid(scene.bodies, scene.geometry, grid)
    , surfaces(SurfacePoints<dim>::exist_in(scene) ?
                 std::make_unique<SurfacePoints<dim>>(scene, grid) :
                 nullptr)
    , balance(grid, points)
    , integrator(make_time_integrator(scene.time))
    , control(scene.time, integrator->order())
    , builder(scene.grid)
    , pictures(
        scene.output, scene.general.units, points, rigid, grid, surfaces.get())
    , history(scene, points, rigid, grid)
    , reference(scene, points, history)
    , console(verbosity, Utilities::MPI::this_mpi_process(communicator) == 0)
    , warnings(scene.warnings, scene.general.units.time)
  {
    check_grips(scene.grips, points);
    if (const auto &force = scene.loads.body_force)
      {
        // As the first step will, which is no longer bad input.
        dealii::Vector<double> value(dim);
        force->set_time(std::min(scene.time.step, scene.time.end));
        for (const auto &particle : points.sorted.particles)
          force->vector_value(particle.get_location(), value);
      }
    if (const auto flaw = find_flaw(communicator))
      throw InputError(*flaw);
  }

  template <int dim>
  double
  Simulation<dim>::cfl_unit() const
  {
    return grid.discretization()->smallest_cell_extent /
           std::max(points.largest_speed(), rigid.largest_speed());
  }

  template <int dim>
  double
  Simulation<dim>::step_unit() const
  {
    return scene.time.cfl_number == 0 ? 1. : cfl_unit();
  }

  template <int dim>
  void
  Simulation<dim>::adapt()
  {
    TimerOutput::Scope scope(timer, "adapt grid and points");
    if (grid.is_moved())
      {
        report.imbalance = balance.imbalance();
        return;
      }
    // Steps of an interval may have passed without a grid to adapt.
    const unsigned int interval = scene.adaptation.interval;
    if (total.step == 0 || total.step / interval != adapted_step / interval)
      {
        adapted_step = total.step;
        for (unsigned int i = 0;
             i < policy->largest_number_of_rounds() &&
             policy->flag_cells(grid, points, rigid, {time, i});
             ++i)
          {
            problem.reset();
            adapt_grid(grid, points, rigid, surfaces.get());
            resample();
          }
      }
    report.imbalance = balance.imbalance();
    if (report.imbalance >
        std::max(scene.grid.largest_imbalance, 1.1 * best_imbalance))
      {
        problem.reset();
        repartition_grid(grid, points, rigid, surfaces.get());
        best_imbalance = report.imbalance = balance.imbalance();
      }
  }

  template <int dim>
  void
  Simulation<dim>::resample()
  {
    if (surfaces)
      surfaces->split();
    const auto changes = adapt_points(scene.bodies, grid, points);
    report.splits += changes.splits;
    report.merges += changes.merges;
    resampled.append(changes);
    report.resampling_kinetic_energy  = resampled.kinetic_energy;
    report.resampling_internal_energy = resampled.internal_energy;
  }

  template <int dim>
  bool
  Simulation<dim>::reset_is_due() const
  {
    const auto  &spec = scene.grid;
    const double next = 1 + 1. / off_grid.n_steps; // goes as far as these did
    const double most = 0.95 * spec.reset_motion;
    if (next * off_grid.in_cells > most ||
        rigid.largest_displacement(off_grid.start, time + report.dt) >
          most * grid.discretization()->smallest_cell_extent)
      return true;
    if (spec.reset == GridReset::interval)
      return off_grid.n_steps >= spec.reset_interval;
    return Utilities::MPI::max(problem->footprints.largest_distortion(
                                 result.increment),
                               communicator) > spec.reset_distortion;
  }

  template <int dim>
  void
  Simulation<dim>::reset_grid()
  {
    grid.reset();
    builder.sort(points, grid);
    rigid.sort();
    resample();
    off_grid = OffGrid();
    ++report.grid_resets;
  }

  template <int dim>
  std::string
  Simulation<dim>::attempt(const double dt)
  {
    report.dt = dt;
    figures   = StepFigures();
    {
      TimerOutput::Scope scope(timer, "set-up of the step");
      problem.reset();
      problem = std::make_unique<StepProblem<dim>>(
        scene,
        grid,
        points,
        rigid,
        *integrator,
        builder,
        counts,
        time,
        dt,
        surfaces.get(),
        jump.damping(grid.discretization()->smallest_cell_extent));
    }
    const auto solution =
      solve_step(*problem, scene.solver, timer, result.increment);
    report.newton_iterations += solution.iterations;
    report.linear_iterations += solution.linear_iterations;
    report.line_searches += solution.line_searches;
    report.projections += solution.projections;
    report.noise_stops = solution.stopped_at_noise;
    residuals          = solution.residuals;
    report.residual    = residuals.empty() ? 0 : residuals.back();
    std::ostringstream iterations;
    for (unsigned int i = 0; i < solution.residuals.size(); ++i)
      iterations << ' ' << solution.residuals[i]
                 << (i < solution.step_lengths.size() &&
                         solution.step_lengths[i] < 1 ?
                       " /" + std::to_string(1 / solution.step_lengths[i]) :
                       "");
    console.detail("  residuals:" + iterations.str());
    if (solution.unstable_mode.size() > 0)
      {
        report_instability(solution.unstable_mode);
        jump.mode = solution.unstable_mode;
      }
    check_expressions();
    if (!solution.converged)
      return solution.failure;
    problem->footprints.move_points(result.increment, increments);
    // Of one step, as ever, unless the grid has moved.
    // Surfaces that come to each other see no further than a cell.
    const double most = is_off_grid() ? scene.grid.reset_motion :
                        surfaces && surfaces->sees_others ?
                                        0.5 :
                                        std::max(1., scene.grid.reset_motion);
    const auto   motion =
      motion_through_grid(*problem, increments, grid, points, *policy, most);
    if (motion.lands)
      {
        console.detail("  points land on a face at t = " +
                       std::to_string(time));
        return attempt(dt);
      }
    if (!motion.forbidden.empty())
      return motion.forbidden;
    off_grid.in_cells  = motion.in_cells;
    figures.iterations = solution.iterations;
    figures.in_cells   = is_off_grid() ? 0. : motion.in_cells / (0.95 * most);
    // Swapped: a vector that is assigned to one of an earlier grid keeps the
    // ghosts of that one if as many values are owned.
    auto end = problem->end_motion(result.increment);
    result.increment.swap(end.increment);
    result.velocity.swap(end.velocity);
    result.acceleration.swap(end.acceleration);
    auto forces = problem->end_forces(result.increment);
    end_forces.swap(forces);
    step_work = work.of_step(*problem, result.increment, end_forces);
    // Of damped steps nothing is known.
    if (scene.time.step_control == StepControlKind::error && !jump.is_on())
      {
        figures.error = control.relative(
          estimate_step_error(*problem, result, increments, points));
        if (!grid.is_lagrangian)
          figures.in_cells =
            std::max(figures.in_cells,
                     way_over_allowed(*problem, increments, points));
      }
    return check_energy();
  }

  template <int dim>
  void
  Simulation<dim>::advance()
  {
    report      = StepReport();
    report.step = total.step + 1;
    if (total.step == 0)
      resample();
    adapt();
    if (!grid.is_moved())
      {
        builder.remember(points);
        remember_touching(scene.faces, grid, points);
      }
    for (double dt = control.begin(time, step_unit());;)
      {
        std::string failure = attempt(dt);
        bool        failed  = !failure.empty();
        if (failed && is_off_grid())
          {
            console.detail("  grid reset at t = " + std::to_string(time) +
                           ": " + failure);
            warn("grid reset",
                 "the grid was reset before it was due, since a step failed on "
                 "the one that has moved: it is distorted too much for a "
                 "'Largest motion' of " +
                   Utilities::to_string(scene.grid.reset_motion) + " cells");
            end_landing(false, points);
            reset_grid();
            builder.remember(points);
            remember_touching(scene.faces, grid, points);
            continue;
          }
        // Nodes must not pass into a rigid body: the first one lands on it.
        double       part   = failed ?
                                0.5 :
                                rigid.first_touch(result.increment,
                                          problem->constraints.is_constrained,
                                          time,
                                          time + dt);
        std::string  why    = failed ? failure : "a node reaches a rigid body";
        const double wanted = failed ? 1 : control.part_for(figures);
        const bool   is_too_long = wanted < part;
        if (is_too_long)
          {
            part = wanted;
            why  = control.why_too_long(figures);
          }
        if (part == 1)
          break;
        // A shorter step need not reach what this one did.
        end_landing(false, points);
        // What is out of balance moves it by as much in however short a step.
        if (!failed && dt < 1e-9 * scene.time.step * step_unit())
          {
            failure = "a node moves into a rigid body, however short the step";
            failed  = true;
            part    = 0.5;
            why     = failure;
          }
        if (failed && can_jump() &&
            (jump.is_on() || jump.mode.size() > 0 || control.is_too_short()))
          {
            dt = jump.is_on() ? dt : control.cut_to_smallest();
            damp(failure);
            continue;
          }
        ++report.step_cuts;
        console.detail("  step cut at t = " + std::to_string(time) +
                       ", dt = " + std::to_string(dt) + ": " + why);
        dt = control.cut(part, failed || is_too_long);
        if (failed && control.is_too_short() && !can_jump())
          {
            std::ostringstream where;
            const auto        &unit = scene.general.units.time;
            where << "at t = " << time << ' ' << unit << ", step "
                  << report.step << ": " << failure << ", and dt = " << dt
                  << ' ' << unit
                  << " is below the smallest time step: " << explain(failure);
            throw ComputationError(where.str());
          }
      }
    end_landing(true, points);
    report.solver_fallbacks = counts.solver_fallbacks - total.solver_fallbacks;
    report.held_cells       = problem->n_held_cells;
    report.limited_boxes    = problem->n_limited_boxes;
    report.active_cells =
      Utilities::MPI::sum<unsigned int>(problem->populated.cells.size(),
                                        communicator);
    report.dofs = problem->n_active_dofs;
    work.add(step_work);
    history.energy().add_step(step_gain);
    report.external_work      = work.external;
    report.internal_work      = work.internal;
    report.stabilization_work = work.stabilization;
    report.uncertain_work     = work.uncertain;
    report.work_of_heat       = work.heat;
    report.heat_supplied      = total.heat_supplied;
    watch_contact();
    watch_springs();
    history.take_figures(*problem, result.increment, end_forces);
    watch_faces();
    // While points are in the order of their footprints.
    if (row_is_due(report.step, time + report.dt))
      {
        watch_pieces();
        watch_flow();
        watch_softening();
      }
    report.damped     = jump.is_on();
    report.step_error = figures.error;
    if (control.is_wrong(figures))
      warn("step control",
           "steps are as short as they may be, and too long: " +
             control.why_too_long(figures) +
             " (a motion that sets in at once, or a 'Smallest time step' that "
             "is too large)");
    commit();
    watch_failed_points();
    control.accept(figures, !jump.is_on());
    jump.end_step(off_grid.in_cells, control.step_size() >= scene.time.step);
    report.time         = time;
    report.wall_seconds = wall_seconds();
    total.append(report);
  }

  template <int dim>
  void
  Simulation<dim>::commit()
  {
    const double end = time + report.dt;
    is_between_steps = false;
    {
      TimerOutput::Scope scope(timer, "move points and grid");
      advance_points(*problem, result, increments, scene.time, points);
    }
    if (scene.heat.is_conducted)
      {
        TimerOutput::Scope scope(timer, "heat conduction");
        report.heat_supplied +=
          conduct_heat(*problem, grid, result.increment, points);
      }
    TimerOutput::Scope scope(timer, "move points and grid");
    if (problem->contact)
      problem->contact->remember_meetings(*surfaces);
    if (surfaces)
      surfaces->advance(*problem->surface_prints, result.increment);
    policy->advance(grid, result, time, end);
    if (problem->free_bodies)
      problem->free_bodies->advance(rigid);
    rigid.move(time, end);
    if (is_off_grid() && off_grid.n_steps++ == 0)
      off_grid.start = time;
    time = end;
    if (is_off_grid() && reset_is_due())
      reset_grid();
    else if (!grid.is_moved())
      {
        points.sort();
        if (surfaces)
          surfaces->sort();
        resample();
      }
    is_between_steps = true;
  }

  template <int dim>
  void
  Simulation<dim>::check_expressions() const
  {
    if (const auto flaw = find_flaw(communicator))
      throw ComputationError(flaw->what(), flaw->entry);
  }

  template <int dim>
  void
  Simulation<dim>::picture(const bool grid_has_step)
  {
    TimerOutput::Scope scope(timer, "output");
    pictures.write(directory, time, nodal_picture(grid_has_step));
  }

  template <int dim>
  void
  Simulation<dim>::pause(const bool is_last)
  {
    const auto &output = scene.output;
    const bool  by_steps =
      output.checkpoint_steps > 0 && report.step % output.checkpoint_steps == 0;
    const bool by_time =
      output.checkpoint_seconds > 0 &&
      wall.wall_time() - last_checkpoint >= output.checkpoint_seconds;
    // Ranks may differ in both.
    std::vector<int> asked = {caught_signal(), by_time};
    Utilities::MPI::max(asked, communicator, asked);
    if (is_last)
      {
        if (output.checkpoint_steps > 0 || output.checkpoint_seconds > 0)
          save_checkpoint("the end");
      }
    else if (asked[0] > 0)
      {
        save_checkpoint("a signal");
        write_summary("stopped by a signal");
        console.finish();
        throw Interruption(asked[0],
                           "after step " + std::to_string(total.step) +
                             ", which is saved");
      }
    else if (by_steps || asked[1] > 0)
      save_checkpoint("the interval");
  }

  template <int dim>
  void
  Simulation<dim>::run(const std::string &directory,
                       const std::string &scene_name,
                       const std::string &parameters,
                       const FinerRuns   &finer_runs,
                       const bool         restart)
  {
    this->directory  = directory;
    this->scene_name = scene_name;
    this->parameters = parameters;
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    wall.restart();
    checkpoints = std::make_unique<CheckpointFiles>(directory);
    const RunDirectory place(directory, communicator, !restart);
    if (restart)
      load_checkpoint();
    else
      place.clear();
    if (first)
      replace_file(directory + "/parameters.prm", parameters);
    history.open(directory, restart);
    const double interval = scene.output.picture_interval;
    // A long step may have passed several.
    const auto picture_after = [&](const double now) {
      return interval > 0 ?
               interval * (std::floor(now / interval * (1 + 1e-9)) + 1) :
               0.;
    };
    double next_picture = picture_after(time);
    if (restart)
      {
        if (first)
          pictures.write_records(directory);
        if (is_over(total.step, time))
          console.message("the run is done; a later end time, or more steps, "
                          "would let it go on");
      }
    else
      {
        warn_of_instability();
        for (const auto &sentence : find_thin_parts(scene.bodies, grid, points))
          warn(sentence, sentence);
        if (const auto sentence = find_shared_cells(points); !sentence.empty())
          warn("shared cells", sentence);
        warn_of_overfull_cells();
        if (scene.output.pictures)
          picture(false);
      }
    try
      {
        while (!is_over(total.step, time))
          {
            advance();
            check_expressions();
            since_row.append(report);
            const bool last = is_over(total.step, time);
            if (row_is_due(total.step, time))
              write_row();
            const bool due = interval > 0 ?
                               time >= next_picture * (1 - 1e-9) :
                               report.step % scene.output.picture_steps == 0;
            if (scene.output.pictures && (due || last))
              {
                picture(true);
                next_picture = picture_after(time);
              }
            pause(last);
          }
      }
    catch (const ComputationError &error)
      {
        // What is not finite may be behind another flaw.
        const auto             flaw = find_flaw(communicator);
        const ComputationError cause =
          flaw ? ComputationError(flaw->what(), flaw->entry) : error;
        console.finish();
        picture(false);
        // What a step has left half done is nothing to go on from.
        if (is_between_steps)
          save_checkpoint(cause.what());
        write_summary(cause.what());
        throw cause;
      }
    report_energy_loss();
    write_summary("done", finer_runs);
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace impm
