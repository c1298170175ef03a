#include <impm/balance/terms/contact.h>
#include <impm/balance/terms/loads.h>
#include <impm/footprints/pieces.h>
#include <impm/output/summary.h>
#include <impm/run/failed_points.h>
#include <impm/run/plastic_flow.h>
#include <impm/run/simulation.h>
#include <impm/solve/linear_solver_choice.h>

#include <algorithm>
#include <iomanip>
#include <numeric>
#include <sstream>

// What a run says of itself.
namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Whether the points of every body split already. */
    template <int dim>
    bool
    all_split(const Bodies<dim> &bodies)
    {
      return std::all_of(bodies.begin(), bodies.end(), [](const auto &body) {
        return body.rigid || body.adaptation >= PointAdaptation::split;
      });
    }

    /** Of all points that carry a load at the start (m^2). Collective. */
    template <int dim>
    double
    area_under(const unsigned int load, const SurfacePoints<dim> &surfaces)
    {
      double area = 0;
      for (unsigned int s = 0; s < surfaces.size(); ++s)
        if (surfaces.carries(s, load))
          area += surfaces.initial_area(s);
      return Utilities::MPI::sum(area, surfaces.communicator);
    }

    /** Faces that hold nothing across and have loaded surface beyond them: what
     * of a body is out there has no grid. Collective. */
    template <int dim>
    std::vector<int>
    passed_by_loads(const Scene<dim>          &scene,
                    const BackgroundGrid<dim> &grid,
                    const SurfacePoints<dim>  &surfaces)
    {
      // Round-off and what a solver leaves is no way out.
      const double most = 1e-3 * grid.discretization()->smallest_cell_extent;
      std::vector<int> passed(2 * dim);
      unsigned int     s = 0;
      for (const auto &particle : surfaces.sorted.particles)
        {
          const auto   place     = surfaces.place(particle);
          bool         is_loaded = false;
          const size_t n_loads   = scene.loads.on_surfaces.size();
          for (unsigned int l = 0; l < n_loads; ++l)
            is_loaded = is_loaded || surfaces.carries(s, l);
          ++s;
          for (unsigned int f = 0; is_loaded && f < 2 * dim; ++f)
            if (!scene.faces[f].constrained[f / 2] &&
                (f % 2 == 0 ? -1 : 1) *
                    (place[f / 2] - grid.face_of_vertices(f)) >
                  most)
              passed[f] = 1;
        }
      Utilities::MPI::max(passed, surfaces.communicator, passed);
      return passed;
    }
  } // namespace

  template <int dim>
  void
  Simulation<dim>::describe()
  {
    std::ostringstream text;
    text << (scene.general.title.empty() ? "scene" : scene.general.title)
         << '\n'
         << "  grid: " << grid.triangulation.n_global_active_cells()
         << " cells, " << grid.discretization()->dof_handler().n_dofs()
         << " unknowns\n"
         << "  points: " << points.sorted.n_global() << ", a cell "
         << to_string(points_per_cell(grid, points)) << '\n'
         << "  linear solver: " << name_linear_solver() << '\n';
    const auto counts =
      count_points_under_tractions(scene.loads.tractions, points);
    for (unsigned int t = 0; t < counts.size(); ++t)
      text << "  traction " << scene.loads.tractions[t].name << ": on "
           << counts[t] << " points\n";
    for (unsigned int l = 0; l < scene.loads.on_surfaces.size(); ++l)
      text << "  load " << scene.loads.on_surfaces[l].name << ": on "
           << area_under(l, *surfaces) << ' ' << scene.general.units.of(an_area)
           << " of the surface\n";
    text << "  fields of a point:\n";
    for (const auto &field : points.layout.fields())
      text << "    " << field.name << " (" << field.n_components << ")\n";
    text << "  bytes per point: " << points.bytes_per_point();
    console.message(text.str());
  }

  template <int dim>
  std::string
  Simulation<dim>::name_linear_solver() const
  {
    return scene.time.is_explicit() ?
             "none" :
             describe_linear_solver(scene.solver, dim, counts);
  }

  template <int dim>
  void
  Simulation<dim>::write_summary(const std::string &status,
                                 const FinerRuns   &finer_runs)
  {
    RunSummary summary;
    summary.scene           = scene_name;
    summary.status          = status;
    summary.linear_solver   = name_linear_solver();
    summary.units           = scene.general.units;
    summary.column_units    = History<dim>::column_units(scene);
    summary.dim             = dim;
    summary.points          = points.sorted.n_global();
    summary.bytes_per_point = points.bytes_per_point();
    summary.steps           = total.step;
    summary.time            = time;
    summary.counts          = {{"newton_iterations", total.newton_iterations},
                               {"linear_iterations", total.linear_iterations},
                               {"line_searches", total.line_searches},
                               {"step_cuts", total.step_cuts},
                               {"tangents", counts.tangents},
                               {"multigrid_hierarchies", counts.hierarchies},
                               {"tangent_projections", total.projections},
                               {"solver_fallbacks", counts.solver_fallbacks},
                               {"noise_stops", total.noise_stops},
                               {"splits", total.splits},
                               {"merges", total.merges},
                               {"grid_resets", total.grid_resets},
                               {"unstable_equilibria", total.unstable},
                               {"damped_steps", total.damped},
                               {"failed_points", total.failed_points},
                               {"stress_evaluations",
                                Utilities::MPI::sum(counts.stress_evaluations,
                                           communicator)},
                               {"operator_applications", counts.operator_applications}};
    summary.figures         = history.last_figures();
    summary.points_per_cell = history.last_density();
    summary.phases          = phases();
    summary.wall_seconds    = wall_seconds();
    if (problem) // none if a run that is done was to go on
      summary.memory = problem->memory_by_owner();
    summary.memory["points"] = points.memory_consumption();
    if (surfaces)
      summary.memory["surfaces"] = surfaces->memory_consumption();
    summary.memory["grid"]   = grid.memory_consumption();
    summary.memory["matrix"] = counts.matrix_bytes;
    summary.warnings         = warnings.list();
    if (status == "done")
      summary.errors = reference.errors(time, finer_runs);
    summary.write(directory, communicator);
    if (status != "done")
      return;
    console.message("  points at the end: " + std::to_string(summary.points) +
                    ", a cell " + to_string(summary.points_per_cell) + '\n' +
                    summary.phase_table());
    if (!summary.errors.empty())
      console.message(summary.error_table());
  }

  template <int dim>
  void
  Simulation<dim>::warn_of_instability()
  {
    if (!integrator->has_inertia())
      return;
    // Of the highest mode of a grid of full cells, eq. 2.4.1.
    const double limit = integrator->stable_step(2 / cfl_unit());
    const double dt =
      std::min(scene.time.largest_step * step_unit(), scene.time.end);
    if (dt <= 1.001 * limit)
      return;
    std::ostringstream text;
    const auto        &unit = scene.general.units.time;
    text << "time steps of up to " << dt << ' ' << unit
         << " grow without bound where they exceed about " << limit << ' '
         << unit << ": the integrator is "
         << "stable only up to there";
    warn("instability", text.str());
  }

  template <int dim>
  void
  Simulation<dim>::warn_of_overfull_cells()
  {
    const double fullest = points_per_cell(grid, points).fullest;
    if (fullest <= 1.2)
      return;
    std::ostringstream text;
    text
      << "points in some cell have " << fullest
      << " times its volume: material lies in itself, and bears as much more";
    warn("overfull cells", text.str());
  }

  template <int dim>
  void
  Simulation<dim>::warn(const std::string &kind, const std::string &text)
  {
    if (warnings.add(kind, text, time))
      console.message("warning: " + text);
  }

  template <int dim>
  void
  Simulation<dim>::watch_contact()
  {
    if (!problem->contact)
      return;
    report.contact_work = work.contact;
    report.smallest_gap =
      Utilities::MPI::min(std::min(1., problem->contact->smallest_gap()),
                          communicator);
    if (report.smallest_gap <= -1)
      warn("surfaces in each other",
           "surfaces have passed into each other at t = " +
             Utilities::to_string(time + report.dt) + ' ' +
             scene.general.units.time +
             ": steps are too long for what comes together, or the pressure "
             "is beyond the modulus of the material");
    if (problem->spring_share >= 1e-3)
      warn(
        "springs that hold pieces",
        "springs that hold pieces of material that nothing else holds take " +
          Utilities::to_string(100 * problem->spring_share) +
          " % of the force of contact at t = " +
          Utilities::to_string(time + report.dt) + ' ' +
          scene.general.units.time +
          ": a piece slides away under its load without inertia");
    if (!problem->free_bodies)
      return;
    for (const auto &body : rigid.bodies)
      if (const auto &box = body.spec->shape->bounding_box;
          body.spec->is_free && box)
        for (unsigned int f = 0; f < 2 * dim; ++f)
          for (unsigned int v = 0; v < (1u << dim); ++v)
            {
              const auto   place = body.state.since_start(box->vertex(v));
              const double beyond =
                (f % 2 == 0 ? -1 : 1) * (place[f / 2] - grid.face_position(f));
              if (scene.faces[f].constrained[f / 2] && beyond > 0)
                warn("face and " + body.spec->name,
                     "free rigid body '" + body.spec->name +
                       "' reaches beyond face '" + scene.faces[f].name +
                       "' of the domain, which holds deformable bodies alone: "
                       "it passes through");
            }
  }

  template <int dim>
  void
  Simulation<dim>::watch_springs()
  {
    const double share = problem->loads_on_springs(result.increment);
    if (share < 0.01)
      return;
    std::ostringstream text;
    text << std::setprecision(3)
         << "nothing holds pieces of material in some direction, "
         << problem->n_held_cells << " cells at t = " << time + report.dt << ' '
         << scene.general.units.time << ", while " << 100 * share
         << " % of the loads would move them: without inertia springs hold "
            "them, and how far they go means nothing (let a face or a rigid "
            "body hold the body, or choose another 'Time/Integrator')";
    warn("loads on springs", text.str());
  }

  template <int dim>
  void
  Simulation<dim>::watch_faces()
  {
    if (std::none_of(scene.faces.begin(),
                     scene.faces.end(),
                     [](const auto &face) { return face.value != nullptr; }))
      return;
    const auto holds = problem->constraints.faces_that_hold();
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (scene.faces[f].value && face_holds[f] && !holds[f])
        warn("face " + scene.faces[f].name,
             "face '" + scene.faces[f].name +
               "', whose motion is prescribed, has lost its material: it holds "
               "no node any more");
    face_holds = holds;
  }

  template <int dim>
  void
  Simulation<dim>::watch_pieces()
  {
    if (grid.is_lagrangian)
      return;
    auto now      = count_pieces(points,
                            problem->footprints,
                            *problem->discretization,
                            scene.bodies.size());
    report.pieces = std::accumulate(now.begin(), now.end(), 0u);
    for (unsigned int b = 0; b < pieces.size(); ++b)
      if (now[b] > pieces[b])
        {
          std::ostringstream text;
          text << "body '" << scene.bodies[b].name << "' has come apart: it is "
               << "in " << now[b] << " pieces instead of " << pieces[b];
          for (const auto &[name, value] : history.last_figures())
            text << "; " << name << " = " << value << " before";
          warn("pieces of " + scene.bodies[b].name, text.str());
        }
    pieces = std::move(now);
  }

  template <int dim>
  void
  Simulation<dim>::watch_flow()
  {
    if (jump.is_on()) // no motion of the material
      return;
    const auto flow = plastic_flow(points, problem->response);
    widest_flow.resize(flow.size());
    for (unsigned int b = 0; b < flow.size(); ++b)
      {
        const double now  = flow[b].share;
        report.flow_share = std::min(report.flow_share, now);
        if (!flow[b].flows)
          continue;
        double &widest = widest_flow[b];
        if (widest < 0.6 || now > 0.4)
          {
            widest = std::max(widest, now);
            continue;
          }
        std::ostringstream text;
        text << std::setprecision(3) << "the flow of body '"
             << scene.bodies[b].name << "' has localised: from " << 100 * widest
             << " to " << 100 * now << " % of its volume, about "
             << flow[b].place << ' ' << scene.general.units.length;
        if (scene.grid.method == GridMethod::mpm)
          text << "; where and when is not to be trusted, since the noise of "
                  "points that cross cells is a stronger flaw than those of "
                  "the body (Grid/Method = GIMP)";
        warn("flow of " + scene.bodies[b].name, text.str());
        widest = now;
      }
  }

  template <int dim>
  void
  Simulation<dim>::watch_failed_points()
  {
    const auto failed = failed_points(points);
    has_failed.resize(failed.size());
    for (unsigned int b = 0; b < failed.size(); ++b)
      {
        report.failed_points += failed[b].n;
        report.failed_volume += failed[b].volume;
        if (failed[b].n == 0 || has_failed[b])
          continue;
        has_failed[b] = true;
        std::ostringstream text;
        text << std::setprecision(3) << "body '" << scene.bodies[b].name
             << "' has begun to fail at t = " << time << ' '
             << scene.general.units.time << ": " << failed[b].n
             << " points, about " << failed[b].place << ' '
             << scene.general.units.length
             << ", have lost their stress; where failure runs, and what it "
                "takes, depends on the size of cells";
        warn("failure of " + scene.bodies[b].name, text.str());
      }
  }

  template <int dim>
  void
  Simulation<dim>::watch_softening()
  {
    if (jump.is_on() || points.history_size() == 0)
      return;
    const auto shares = softening_shares(points, problem->response);
    for (unsigned int b = 0; b < shares.size(); ++b)
      if (shares[b] > 0)
        {
          std::ostringstream text;
          text << std::setprecision(3) << "body '" << scene.bodies[b].name
               << "' softens, now in " << 100 * shares[b]
               << " % of its volume: its yield stress falls as it flows. The "
                  "flow gathers in a band as wide as a cell, so that forces "
                  "and work from here on depend on the size of the cells";
          warn("softening of " + scene.bodies[b].name, text.str());
        }
  }

  template <int dim>
  void
  Simulation<dim>::write_row()
  {
    history.write(since_row);
    if (!scene.loads.on_surfaces.empty())
      {
        const auto passed = passed_by_loads(scene, grid, *surfaces);
        for (unsigned int f = 0; f < 2 * dim; ++f)
          if (passed[f] != 0)
            warn("loads beyond face " + scene.faces[f].name,
                 "a surface with a load is beyond face '" +
                   scene.faces[f].name +
                   "' of the domain, where there is no grid: the body is "
                   "loaded and deforms too little; leave it room there");
      }
    // As many points as there are cells are hardly ever one each to the digit.
    if (history.last_density().smallest < 0.99)
      {
        std::ostringstream text;
        text << "some cell has less than one point for its volume or along an "
                "axis ("
             << history.last_density().smallest
             << "): forces there are those of single points; "
             << (all_split(scene.bodies) ? "begin" :
                                           "let points split, or begin")
             << " with more";
        warn("few points", text.str());
      }
    if (history.last_drift() > 0.2)
      {
        std::ostringstream text;
        text << "the deformation of the points has drifted from how they lie, "
                "by "
             << 100 * history.last_drift()
             << " % of their strain: so may forces; "
             << (scene.grid.method == GridMethod::mpm ?
                   "points that cross cells need Grid/Method = GIMP, or a grid "
                   "that follows the body" :
                 all_split(scene.bodies) ?
                   "smaller steps may help" :
                   "smaller steps, or points that split, may help");
        warn("deformation drift", text.str());
      }
    watch_energy();
    if (reference.follows_steps())
      {
        TimerOutput::Scope scope(timer, "references");
        reference.follow_step(time);
      }
    // A narrow terminal has room for the first ones: forces before probes.
    auto figures = history.last_figures();
    std::rotate(figures.begin(),
                figures.end() - scene.output.reactions.size(),
                figures.end());
    console.step(since_row, scene.time.end, points.sorted.n_global(), figures);
    since_row = StepReport();
  }

  template <int dim>
  double
  Simulation<dim>::wall_seconds() const
  {
    return seconds_before + wall.wall_time();
  }

  template <int dim>
  std::map<std::string, double>
  Simulation<dim>::phases() const
  {
    auto all = phases_before;
    for (const auto &[name, seconds] :
         timer.get_summary_data(TimerOutput::total_wall_time))
      all[name] += seconds;
    return all;
  }

  template void
  Simulation<2>::describe();
  template void
  Simulation<3>::describe();
  template std::string
  Simulation<2>::name_linear_solver() const;
  template std::string
  Simulation<3>::name_linear_solver() const;
  template void
  Simulation<2>::write_summary(const std::string &, const FinerRuns &);
  template void
  Simulation<3>::write_summary(const std::string &, const FinerRuns &);
  template void
  Simulation<2>::warn_of_instability();
  template void
  Simulation<3>::warn_of_instability();
  template void
  Simulation<2>::warn_of_overfull_cells();
  template void
  Simulation<3>::warn_of_overfull_cells();
  template void
  Simulation<2>::warn(const std::string &, const std::string &);
  template void
  Simulation<3>::warn(const std::string &, const std::string &);
  template void
  Simulation<2>::watch_faces();
  template void
  Simulation<2>::watch_contact();
  template void
  Simulation<3>::watch_faces();
  template void
  Simulation<3>::watch_contact();
  template void
  Simulation<2>::watch_springs();
  template void
  Simulation<3>::watch_springs();
  template void
  Simulation<2>::watch_pieces();
  template void
  Simulation<3>::watch_pieces();
  template void
  Simulation<2>::watch_flow();
  template void
  Simulation<2>::watch_softening();
  template void
  Simulation<3>::watch_flow();
  template void
  Simulation<3>::watch_softening();
  template void
  Simulation<2>::watch_failed_points();
  template void
  Simulation<3>::watch_failed_points();
  template void
  Simulation<2>::write_row();
  template void
  Simulation<3>::write_row();
  template double
  Simulation<2>::wall_seconds() const;
  template double
  Simulation<3>::wall_seconds() const;
  template std::map<std::string, double>
  Simulation<2>::phases() const;
  template std::map<std::string, double>
  Simulation<3>::phases() const;
} // namespace impm
