#include <impm/balance/terms/contact.h>
#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/output/history.h>
#include <impm/output/probes.h>
#include <impm/output/quantities.h>
#include <impm/points/deformation_drift.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

namespace impm
{
  using namespace dealii;

  void
  StepReport::append(const StepReport &next)
  {
    const auto before = *this;
    *this             = next;
    step_error        = std::max(step_error, before.step_error);
    newton_iterations += before.newton_iterations;
    linear_iterations += before.linear_iterations;
    line_searches += before.line_searches;
    step_cuts += before.step_cuts;
    projections += before.projections;
    solver_fallbacks += before.solver_fallbacks;
    noise_stops += before.noise_stops;
    splits += before.splits;
    merges += before.merges;
    grid_resets += before.grid_resets;
    unstable += before.unstable;
    damped += before.damped;
    smallest_gap = std::min(smallest_gap, before.smallest_gap);
  }

  namespace
  {
    /** The columns of a row in their order, with its values. */
    template <int dim>
    Figures
    make_row(const GeometryKind   geometry,
             const StepReport    &report,
             const double         n_points,
             const PointsPerCell &density,
             const Totals<dim>   &totals,
             const double         start_kinetic_energy,
             const double         energy_gain,
             const double         drift,
             const bool           may_fail,
             const Figures       &of_contact,
             const Figures       &of_heat,
             const Figures       &figures)
    {
      Figures row = {{"step", report.step},
                     {"time", report.time},
                     {"dt", report.dt},
                     {"newton_iterations", report.newton_iterations},
                     {"linear_iterations", report.linear_iterations},
                     {"line_searches", report.line_searches},
                     {"step_cuts", report.step_cuts},
                     {"points", n_points},
                     {"active_cells", report.active_cells},
                     {"dofs", report.dofs},
                     {"mass", totals.mass}};
      for (unsigned int d = 0; d < dim; ++d)
        row.emplace_back(std::string("momentum_") + "xyz"[d],
                         totals.momentum[d]);
      row.insert(row.end(),
                 {{"kinetic_energy", totals.kinetic_energy},
                  {"strain_energy", totals.strain_energy},
                  {"plastic_work", totals.plastic_work},
                  {"external_work", report.external_work},
                  {"wall_seconds", report.wall_seconds}});
      row.insert(row.end(), figures.begin(), figures.end());
      row.insert(row.end(),
                 {{"residual", report.residual},
                  {"tangent_projections", report.projections},
                  {"solver_fallbacks", report.solver_fallbacks},
                  {"noise_stops", report.noise_stops},
                  {"held_cells", report.held_cells},
                  {"limited_boxes", report.limited_boxes},
                  {"total_energy",
                   totals.kinetic_energy + totals.strain_energy}});
      if (geometry != GeometryKind::axisymmetric)
        for (unsigned int d = dim == 2 ? 2 : 0; d < 3; ++d)
          row.emplace_back(std::string("angular_momentum_") + "xyz"[d],
                           totals.angular_momentum[d]);
      row.insert(row.end(),
                 {{"stabilization_work", report.stabilization_work},
                  {"internal_work", report.internal_work},
                  {"transfer_loss",
                   report.external_work - report.stabilization_work -
                     report.internal_work - report.contact_work +
                     report.resampling_kinetic_energy -
                     (totals.kinetic_energy - start_kinetic_energy)},
                  {"splits", report.splits},
                  {"merges", report.merges},
                  {"resampling_energy",
                   report.resampling_kinetic_energy +
                     report.resampling_internal_energy},
                  {"smallest_points_per_cell", density.smallest},
                  {"mean_points_per_cell", density.mean},
                  {"imbalance", report.imbalance},
                  {"energy_gain", energy_gain},
                  {"unstable_equilibria", report.unstable},
                  {"damped_steps", report.damped},
                  {"deformation_drift", drift},
                  {"pieces", report.pieces},
                  {"flow_share", report.flow_share},
                  {"step_error", report.step_error}});
      if (may_fail)
        row.insert(row.end(),
                   {{"failed_points", report.failed_points},
                    {"failed_volume", report.failed_volume}});
      if (!of_contact.empty())
        row.insert(row.end(),
                   {{"contact_work", report.contact_work},
                    {"smallest_gap", report.smallest_gap}});
      row.insert(row.end(), of_contact.begin(), of_contact.end());
      row.insert(row.end(), of_heat.begin(), of_heat.end());
      return row;
    }

    /** What heat does, in scenes where it does. */
    template <int dim>
    Figures
    heat_figures(const StepReport  &report,
                 const Totals<dim> &totals,
                 const bool         expands,
                 const bool         conducts)
    {
      Figures figures;
      if (expands)
        figures.emplace_back("work_of_heat", report.work_of_heat);
      if (conducts)
        figures.insert(figures.end(),
                       {{"heat", totals.heat},
                        {"heat_supplied", report.heat_supplied},
                        {"largest_temperature", totals.largest_temperature}});
      return figures;
    }

    template <int dim>
    bool
    any_expands(const Bodies<dim> &bodies)
    {
      return std::any_of(bodies.begin(), bodies.end(), [](const auto &body) {
        return !body.rigid && body.material->expands();
      });
    }

    void
    append(const std::string    &pair,
           const ContactFigures &of_pair,
           Figures              &figures)
    {
      figures.insert(figures.end(),
                     {{pair + "_normal_force", of_pair.normal_force},
                      {pair + "_friction_force", of_pair.friction_force},
                      {pair + "_area", of_pair.area},
                      {pair + "_largest_pressure", of_pair.largest_pressure}});
    }

    Dimension
    dimension_of(const ProbeSpec &probe)
    {
      using Kind     = ProbeSpec::Kind;
      using Quantity = ProbeSpec::Quantity;
      if (probe.kind == Kind::extent || probe.kind == Kind::lower_extent)
        return a_length;
      if (probe.kind == Kind::motion)
        switch (probe.quantity)
          {
            case Quantity::displacement:
              return a_length;
            case Quantity::velocity:
              return a_velocity;
            case Quantity::rotation:
              return no_dimension;
            case Quantity::angular_velocity:
              return a_rate;
          }
      for (const auto &field : point_quantities())
        if (field.name == probe.field)
          return field.dimension;
      return no_dimension;
    }

    template <int dim>
    double
    all_energy(const Totals<dim> &totals)
    {
      return totals.kinetic_energy + totals.strain_energy + totals.plastic_work;
    }
  } // namespace

  template <int dim>
  Totals<dim>
  total(const MaterialPoints<dim>  &points,
        const std::optional<double> strain_energy)
  {
    Totals<dim> totals;
    totals.strain_energy = strain_energy.value_or(0);
    unsigned int p       = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const double mass = points.mass(p);
        totals.mass += mass;
        if (points.offset_velocity > 0)
          {
            Tensor<1, 3> x, v;
            for (unsigned int d = 0; d < dim; ++d)
              {
                x[d] = particle.get_location()[d];
                v[d] = points.fields(p)[points.offset_velocity + d];
                totals.momentum[d] += mass * v[d];
              }
            totals.kinetic_energy += 0.5 * mass * v.norm_square();
            totals.angular_momentum += mass * cross_product_3d(x, v);
          }
        if (!strain_energy)
          {
            const auto energy = points.material(p).energy_of_point(
              deformation_gradient(points, p),
              points.fields(p) + points.offset_history);
            totals.strain_energy += points.initial_volume(p) * energy.stored;
            totals.plastic_work += points.initial_volume(p) * energy.dissipated;
            if (const auto &law = points.material(p); law.conducts())
              {
                const double temperature =
                  law.temperature(energy.dissipated,
                                  points.fields(p) + points.offset_history);
                totals.heat += mass * law.specific_heat *
                               (temperature - law.initial_temperature);
                totals.largest_temperature =
                  std::max(totals.largest_temperature, temperature);
              }
          }
        ++p;
      }
    const auto add_ranks = [&](auto &sum) {
      sum = Utilities::MPI::sum(sum, points.communicator);
    };
    add_ranks(totals.mass);
    add_ranks(totals.momentum);
    add_ranks(totals.angular_momentum);
    add_ranks(totals.kinetic_energy);
    add_ranks(totals.strain_energy);
    add_ranks(totals.plastic_work);
    add_ranks(totals.heat);
    totals.largest_temperature =
      Utilities::MPI::max(totals.largest_temperature, points.communicator);
    return totals;
  }

  template <int dim>
  void
  add(const RigidBodies<dim> &rigid, Totals<dim> &totals)
  {
    for (const auto &body : rigid.bodies)
      if (body.spec->is_free)
        {
          const auto &inertia = body.spec->inertia;
          const auto &state   = body.state;
          const auto place = state.since_start.centre + state.since_start.shift;
          const auto momentum = inertia.mass * state.velocity;
          const auto spin     = inertia.tensor * state.spin;
          totals.mass += inertia.mass;
          totals.momentum += momentum;
          totals.angular_momentum += moment_of<dim>(place, momentum) +
                                     turned_to_space(state.since_start, spin);
          totals.kinetic_energy +=
            0.5 * (momentum * state.velocity + spin * state.spin);
        }
  }

  template <int dim>
  std::vector<std::string>
  History<dim>::column_names(const Scene<dim> &scene)
  {
    Figures figures;
    for (const auto &probe : scene.output.probes)
      figures.emplace_back(probe.name, 0);
    for (const auto &reaction : scene.output.reactions)
      figures.emplace_back(reaction.name, 0);
    Figures of_contact;
    for (const auto &pair : scene.contact.pairs)
      append(pair.name, {}, of_contact);
    const auto               of_heat = heat_figures<dim>({},
                                           {},
                                           any_expands(scene.bodies),
                                           scene.heat.is_conducted);
    std::vector<std::string> names;
    for (const auto &column :
         make_row<dim>(scene.geometry,
                       {},
                       0,
                       {},
                       {},
                       0,
                       0,
                       0,
                       scene.history->find("failed").has_value(),
                       of_contact,
                       of_heat,
                       figures))
      names.push_back(column.first);
    return names;
  }

  template <int dim>
  std::vector<std::pair<std::string, std::string>>
  History<dim>::column_units(const Scene<dim> &scene)
  {
    std::map<std::string, Dimension> of_scene;
    for (const auto &probe : scene.output.probes)
      of_scene[probe.name] =
        probe.factor == 1 ? dimension_of(probe) : no_dimension;
    for (const auto &reaction : scene.output.reactions)
      of_scene[reaction.name] = reaction.factor != 1 ? no_dimension :
                                reaction.is_moment   ? a_moment :
                                                       a_force;
    for (const auto &column : history_columns())
      if (column.name.size() > 1 && column.name[0] == '*')
        for (const auto &pair : scene.contact.pairs)
          of_scene[pair.name + column.name.substr(1)] = column.dimension;
    const auto &units = scene.general.units;
    std::vector<std::pair<std::string, std::string>> result;
    for (const auto &name : column_names(scene))
      {
        const auto found = of_scene.find(name);
        const auto unit  = found == of_scene.end() ?
                             unit_of(name, history_columns(), units) :
                             units.of(found->second);
        if (!unit.empty())
          result.emplace_back(name, unit);
      }
    return result;
  }

  template <int dim>
  History<dim>::History(const Scene<dim>          &scene,
                        const MaterialPoints<dim> &points,
                        const RigidBodies<dim>    &rigid,
                        const BackgroundGrid<dim> &grid)
    : output(scene.output)
    , bodies(scene.bodies)
    , points(points)
    , rigid(rigid)
    , grid(grid)
    , names(column_names(scene))
    , followed(scene.output.probes.size(), -1)
    , reactions(scene.output.reactions.size())
    , potential_is_energy(points.history_size() == 0 &&
                          std::all_of(scene.bodies.begin(),
                                      scene.bodies.end(),
                                      [](const auto &body) {
                                        return body.rigid ||
                                               body.material->has_potential();
                                      }))
    , expands(any_expands(scene.bodies))
    , conducts(scene.heat.is_conducted)
  {
    auto at_start = total(points);
    add(rigid, at_start);
    start_kinetic_energy = at_start.kinetic_energy;
    budget.begin(all_energy(at_start));
    may_drift = !grid.is_lagrangian && deformation_drift(bodies, points) < 1e-3;
    for (const auto &probe : scene.output.probes)
      probes.push_back(make_probe(
        probe, scene, points, rigid, grid, &followed[probes.size()]));
  }

  template <int dim>
  void
  History<dim>::open(const std::string &directory, const bool goes_on)
  {
    if (Utilities::MPI::this_mpi_process(points.communicator) != 0)
      return;
    file_name = directory + "/history.csv";
    if (!goes_on)
      {
        file.open(file_name);
        write_line(join(names, ","));
        return;
      }
    std::error_code error;
    // A file that cannot be measured seems to be a very large one.
    if (std::filesystem::file_size(file_name, error) < size)
      throw SystemError("'" + file_name + "' lacks rows that it had");
    std::filesystem::resize_file(file_name, size, error);
    file.open(file_name, std::ios::app);
    if (error || !file)
      throw SystemError("cannot go on with '" + file_name + "'");
  }

  template <int dim>
  void
  History<dim>::write_line(const std::string &line)
  {
    // What is written to a file that has been removed is gone.
    if (std::error_code error; !std::filesystem::exists(file_name, error))
      throw SystemError("'" + file_name + "' has been moved or removed");
    file << line << std::endl;
    if (!file)
      {
        // Half a row is none.
        std::error_code ignored;
        std::filesystem::resize_file(file_name, size, ignored);
        throw SystemError("cannot write '" + file_name + "' (disk full?)");
      }
    size += line.size() + 1;
  }

  template <int dim>
  CsvTable
  History<dim>::table() const
  {
    try
      {
        return read_csv_table(file_name);
      }
    catch (const InputError &error)
      {
        // On this rank alone.
        throw SystemError(error.what());
      }
  }

  template <int dim>
  void
  History<dim>::take_figures(const StepProblem<dim> &problem,
                             const Vector           &u,
                             const Vector           &forces)
  {
    potential = problem.response.potential;
    of_contact.clear();
    for (unsigned int q = 0; q < problem.scene.contact.pairs.size(); ++q)
      append(problem.scene.contact.pairs[q].name,
             problem.contact->figures(q, points.communicator),
             of_contact);
    for (unsigned int r = 0; r < reactions.size(); ++r)
      {
        const auto  &spec = output.reactions[r];
        const auto  &n    = spec.direction;
        const double norm =
          std::sqrt(std::inner_product(n.begin(), n.end(), n.begin(), 0.));
        // What the carrier exerts balances the material: the force on it is
        // the opposite.
        reactions[r] = -spec.factor / norm * problem.reaction(spec, u, forces);
      }
  }

  template <int dim>
  void
  History<dim>::write(const StepReport &report)
  {
    // Points that split or merge have another energy than in the step.
    const bool is_known =
      potential_is_energy && report.splits == 0 && report.merges == 0;
    auto totals =
      total(points, is_known ? std::optional(potential) : std::nullopt);
    add(rigid, totals);
    if (!std::isfinite(all_energy(totals)))
      throw ComputationError("at t = " + Utilities::to_string(report.time) +
                             ": the energy of the points is no finite "
                             "number: they are too fast, or too much deformed");
    // What friction has taken is not lost to the method.
    budget.update(all_energy(totals) + report.contact_work,
                  report.external_work + report.work_of_heat +
                    report.resampling_kinetic_energy +
                    report.resampling_internal_energy,
                  report.uncertain_work);
    drift               = may_drift ? deformation_drift(bodies, points) : 0.;
    const auto n_points = points.sorted.n_global();
    density             = points_per_cell(grid, points);
    figures.clear();
    for (unsigned int i = 0; i < probes.size(); ++i)
      {
        const auto &spec = output.probes[i];
        figures.emplace_back(spec.name, spec.factor * probes[i](report.time));
      }
    for (unsigned int i = 0; i < reactions.size(); ++i)
      figures.emplace_back(output.reactions[i].name, reactions[i]);
    if (Utilities::MPI::this_mpi_process(points.communicator) != 0)
      return;

    const auto         row = make_row(points.layout.geometry,
                              report,
                              n_points,
                              density,
                              totals,
                              start_kinetic_energy,
                              budget.gain,
                              drift,
                              points.history_layout.find("failed").has_value(),
                              of_contact,
                              heat_figures(report, totals, expands, conducts),
                              figures);
    std::ostringstream line;
    line << std::setprecision(12);
    for (unsigned int i = 0; i < row.size(); ++i)
      line << (i > 0 ? "," : "") << row[i].second;
    write_line(line.str());
  }

  template class History<2>;
  template class History<3>;
  template void
  add(const RigidBodies<2> &, Totals<2> &);
  template void
                              add(const RigidBodies<3> &, Totals<3> &);
  template decltype(total<2>) total<2>;
  template decltype(total<3>) total<3>;
} // namespace impm
