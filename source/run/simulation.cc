#include <deal.II/base/utilities.h>

#include <impm/balance/terms/point_traction.h>
#include <impm/base/exceptions.h>
#include <impm/footprints/transfer.h>
#include <impm/output/summary.h>
#include <impm/run/checkpoint.h>
#include <impm/run/simulation.h>
#include <impm/scene/layout_choice.h>

#include <filesystem>
#include <sstream>

namespace impm
{
  using namespace dealii;

  template <int dim>
  Simulation<dim>::Simulation(const Scene<dim>            &scene,
                              const CommandLine::Verbosity verbosity,
                              const MPI_Comm               communicator)
    : scene(scene)
    , communicator(communicator)
    , silence(std::cout, false)
    , timer(silence, TimerOutput::never, TimerOutput::wall_times)
    , grid(scene.grid, communicator)
    , points(choose_layout(scene), scene.bodies, scene.loads.tractions, grid)
    , rigid(scene.bodies, scene.geometry, grid)
    , integrator(make_time_integrator(scene.time))
    , balance(scene, grid, points, rigid, *integrator)
    , step_solver(scene.solver, scene.bodies, balance, *integrator, timer)
    , pictures(scene.output, points, rigid, balance)
    , history(scene.output, scene.faces, scene.bodies, points, rigid, balance)
    , reference(scene.references,
                scene.bodies,
                scene.output,
                scene.time,
                points,
                history)
    , console(verbosity, Utilities::MPI::this_mpi_process(communicator) == 0)
    , step_size(scene.time.step)
  {
    grid.initialize(u);
    grid.initialize(end_velocity);
    grid.initialize(end_acceleration);
  }

  template <int dim>
  void
  Simulation<dim>::describe()
  {
    std::ostringstream text;
    text << (scene.general.title.empty() ? "scene" : scene.general.title)
         << '\n'
         << "  grid: " << grid.triangulation.n_global_active_cells()
         << " cells, " << grid.dof_handler.n_dofs() << " unknowns\n"
         << "  points: " << points.sorted.n_global() << '\n';
    const auto counts =
      count_points_under_tractions(scene.loads.tractions, points);
    for (unsigned int t = 0; t < counts.size(); ++t)
      text << "  traction " << scene.loads.tractions[t].name << ": on "
           << counts[t] << " points\n";
    text << "  fields of a point:\n";
    for (const auto &field : points.layout.fields())
      text << "    " << field.name << " (" << field.n_components << ")\n";
    text << "  bytes per point: " << points.bytes_per_point();
    console.message(text.str());
  }

  template <int dim>
  double
  Simulation<dim>::grid_motion(const unsigned int face) const
  {
    return balance.constraints.face_motion(face, time, time + report.dt);
  }

  template <int dim>
  std::string
  Simulation<dim>::forbidden_motion() const
  {
    if (grid.is_lagrangian)
      return "";
    // Material that has not reached a face yet does not feel it: a long step
    // could carry it through.
    std::array<double, 2 * dim> faces;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      faces[f] = grid.face_position(f) +
                 (scene.faces[f].moves_grid ? grid_motion(f) : 0.);
    const auto outside = find_point_outside<dim>(balance, u, points, faces);
    if (!outside.empty())
      return outside;
    // Nor does it feel material that it has not reached; and between ranks a
    // point is found only where the neighbour can see it.
    const auto motion = [&](const Point<dim> &x) {
      Tensor<1, dim> displacement;
      for (unsigned int f = 0; f < 2 * dim; ++f)
        if (scene.faces[f].moves_grid)
          {
            const unsigned int d     = f / 2;
            const double       fixed = grid.face_position(f ^ 1u);
            displacement[d] =
              grid_motion(f) * (x[d] - fixed) / (grid.face_position(f) - fixed);
          }
      return displacement;
    };
    return largest_motion<dim>(balance, u, points, motion) > 0.95 ?
             "a point moves across a whole cell" :
             "";
  }

  template <int dim>
  double
  Simulation<dim>::step_unit() const
  {
    if (scene.time.cfl_number == 0)
      return 1;
    return balance.grid.smallest_cell_extent() / largest_speed(points);
  }

  template <int dim>
  typename StepSolver<dim>::Result
  Simulation<dim>::attempt(const double dt)
  {
    report.dt = dt;
    {
      TimerOutput::Scope scope(timer, "set-up of the step");
      balance.begin_step(time, dt);
    }
    auto result = step_solver.solve(dt, u);
    report.newton_iterations += result.iterations;
    report.linear_iterations += result.linear_iterations;
    report.line_searches += result.line_searches;
    report.projections += result.projections;
    report.noise_stops = result.stopped_at_noise;
    report.residual    = result.residuals.empty() ? 0 : result.residuals.back();
    std::ostringstream iterations;
    for (unsigned int i = 0; i < result.residuals.size(); ++i)
      iterations << ' ' << result.residuals[i]
                 << (i < result.step_lengths.size() &&
                         result.step_lengths[i] < 1 ?
                       " /" + std::to_string(1 / result.step_lengths[i]) :
                       "");
    console.detail("  residuals:" + iterations.str());
    if (result.converged)
      {
        result.failure   = forbidden_motion();
        result.converged = result.failure.empty();
      }
    return result;
  }

  template <int dim>
  void
  Simulation<dim>::advance()
  {
    const double work    = report.external_work;
    const auto   step    = report.step + 1;
    report               = StepReport();
    report.step          = step;
    report.external_work = work;
    const auto before    = step_solver.linear_solver.n_fallbacks;
    // The last step ends on time, and none is a sliver.
    const double left = scene.time.end - time;
    const double unit = step_unit();
    double       dt   = step_size * unit;
    if (left < 1.001 * dt)
      dt = left;
    else if (left < 1.999 * dt)
      dt = left / 2;
    bool failed = false;
    for (;;)
      {
        const auto result = attempt(dt);
        // Nodes must not pass into a rigid body: the first one lands on it.
        const double part =
          result.converged ?
            rigid.first_touch(u,
                              balance.constraints.is_constrained,
                              time,
                              time + dt) :
            0.5;
        if (result.converged && part == 1)
          break;
        ++report.step_cuts;
        console.detail(
          "  step cut at t = " + std::to_string(time) +
          ", dt = " + std::to_string(dt) + ": " +
          (result.converged ? "a node reaches a rigid body" : result.failure));
        dt *= part;
        if (result.converged)
          continue;
        failed    = true;
        step_size = dt / unit;
        if (dt < scene.time.smallest_step * scene.time.step * unit)
          {
            std::ostringstream where;
            where << "at t = " << time << " s, step " << report.step << ": "
                  << result.failure << ", and dt = " << dt
                  << " s is below the smallest time step";
            throw ComputationError(where.str());
          }
      }
    report.solver_fallbacks = step_solver.linear_solver.n_fallbacks - before;
    report.held_cells       = balance.n_held_cells;
    report.limited_boxes =
      Utilities::MPI::sum(balance.n_limited_boxes(), communicator);
    report.external_work += external_work_of_step();
    history.take_reactions();
    commit();
    report.time         = time;
    report.wall_seconds = wall.wall_time();

    // Grow; after a failure, back to the nominal step first.
    if (!failed && step_size < scene.time.step)
      step_size = std::min(1.5 * step_size, scene.time.step);
    else if (!failed)
      step_size =
        std::min(step_size * scene.time.growth, scene.time.largest_step);

    sums.newton += report.newton_iterations;
    sums.linear += report.linear_iterations;
    sums.line_searches += report.line_searches;
    sums.cuts += report.step_cuts;
    sums.projections += report.projections;
    sums.noise_stops += report.noise_stops;
  }

  template <int dim>
  double
  Simulation<dim>::external_work_of_step() const
  {
    const auto &forces = balance.constraint_forces();
    double      work   = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      {
        if (balance.constraints.is_constrained[i])
          work += forces.local_element(i) * u.local_element(i);
        work -= balance.load_at(i) * u.local_element(i);
      }
    return Utilities::MPI::sum(work, communicator);
  }

  template <int dim>
  void
  Simulation<dim>::commit()
  {
    TimerOutput::Scope scope(timer, "move points and grid");
    balance.end_motion(u, end_velocity, end_acceleration);
    advance_points(balance,
                   scene.time,
                   report.dt,
                   u,
                   end_velocity,
                   end_acceleration,
                   points);
    balance.carry_motion(grid, u, end_velocity, end_acceleration);
    bool grid_moves = false;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (scene.faces[f].moves_grid)
        {
          grid.move_face(f, grid.face_position(f) + grid_motion(f));
          grid_moves = true;
        }
    points.sort();
    if (rigid.size() > 0)
      rigid.move(time, time + report.dt);
    else if (grid_moves)
      rigid.sort();
    time += report.dt;
  }

  template <int dim>
  void
  Simulation<dim>::picture(const bool grid_has_increment)
  {
    TimerOutput::Scope scope(timer, "output");
    pictures.write(directory, time, grid_has_increment ? &u : nullptr);
  }

  template <int dim>
  void
  Simulation<dim>::save_last_good_state(const std::string &reason)
  {
    console.finish();
    picture(false);
    write_checkpoint(directory,
                     {report.step - 1, time, step_size, reason},
                     grid,
                     points);
  }

  template <int dim>
  void
  Simulation<dim>::write_summary(const std::string &scene_name,
                                 const std::string &status,
                                 const FinerRuns   &finer_runs)
  {
    RunSummary summary;
    summary.scene           = scene_name;
    summary.status          = status;
    summary.dim             = dim;
    summary.points          = points.sorted.n_global();
    summary.bytes_per_point = points.bytes_per_point();
    summary.steps           = report.step;
    summary.time            = time;
    summary.counts          = {
               {"newton_iterations", sums.newton},
               {"linear_iterations", sums.linear},
               {"line_searches", sums.line_searches},
               {"step_cuts", sums.cuts},
               {"tangents", step_solver.linear_solver.n_tangents},
               {"tangent_projections", sums.projections},
               {"solver_fallbacks", step_solver.linear_solver.n_fallbacks},
               {"noise_stops", sums.noise_stops},
               {"stress_evaluations",
                Utilities::MPI::sum(balance.response.n_evaluations, communicator)},
               {"operator_applications", balance.n_operator_applications}};
    summary.figures      = history.last_figures();
    summary.phases       = timer.get_summary_data(TimerOutput::total_wall_time);
    summary.wall_seconds = wall.wall_time();
    if (status == "done")
      summary.errors = reference.errors(time, finer_runs);
    summary.write(directory, communicator);
    if (status != "done")
      return;
    console.message(summary.phase_table());
    if (!summary.errors.empty())
      console.message(summary.error_table());
  }

  template <int dim>
  void
  Simulation<dim>::warn_of_instability()
  {
    if (!integrator->has_inertia() || scene.time.theta >= 0.5)
      return;
    // Of the highest mode of a grid of full cells, eq. 2.4.1.
    const double unit =
      balance.grid.smallest_cell_extent() / largest_speed(points);
    const double limit = unit / std::sqrt(1 - 2 * scene.time.theta);
    const double dt =
      scene.time.largest_step * (scene.time.cfl_number > 0 ? unit : 1.);
    if (dt <= 1.001 * limit)
      return;
    std::ostringstream text;
    text << "warning: time steps of up to " << dt << " s grow without bound "
         << "where they exceed about " << limit << " s, since theta is below "
         << "0.5";
    console.message(text.str());
  }

  template <int dim>
  void
  Simulation<dim>::write_row(const StepReport &since_row)
  {
    history.write(since_row);
    if (reference.follows_steps())
      {
        TimerOutput::Scope scope(timer, "references");
        reference.follow_step(time);
      }
    console.step(since_row,
                 scene.time.end,
                 points.sorted.n_global(),
                 history.last_figures());
  }

  template <int dim>
  void
  Simulation<dim>::run(const std::string &directory,
                       const std::string &scene_name,
                       const std::string &parameters,
                       const FinerRuns   &finer_runs)
  {
    this->directory = directory;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::error_code error;
        std::filesystem::create_directories(directory, error);
        if (error)
          throw SystemError("cannot make the directory '" + directory +
                            "': " + error.message());
        replace_file(directory + "/parameters.prm", parameters);
      }
    MPI_Barrier(communicator);
    wall.restart();
    history.open(directory);
    balance.begin_step(0, step_size * step_unit());
    warn_of_instability();
    if (scene.output.pictures)
      picture(false);
    next_picture       = scene.output.picture_interval;
    const auto is_over = [&]() {
      return time >= scene.time.end * (1 - 1e-12) ||
             report.step >= scene.time.largest_number_of_steps;
    };
    StepReport since_row;
    try
      {
        while (!is_over())
          {
            advance();
            since_row.append(report);
            const bool last = is_over();
            if (last || report.step % scene.output.row_steps == 0)
              {
                write_row(since_row);
                since_row = StepReport();
              }
            const bool due = scene.output.picture_interval > 0 ?
                               time >= next_picture * (1 - 1e-9) :
                               report.step % scene.output.picture_steps == 0;
            if (scene.output.pictures && (due || last))
              {
                picture(true);
                next_picture += scene.output.picture_interval;
              }
          }
      }
    catch (const ComputationError &error)
      {
        save_last_good_state(error.what());
        write_summary(scene_name, error.what(), {});
        throw;
      }
    write_summary(scene_name, "done", finer_runs);
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace impm
