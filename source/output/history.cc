#include <impm/base/exceptions.h>
#include <impm/output/history.h>

#include <algorithm>
#include <iomanip>
#include <limits>

namespace impm
{
  using namespace dealii;

  void
  StepReport::append(const StepReport &next)
  {
    const auto before = *this;
    *this             = next;
    newton_iterations += before.newton_iterations;
    linear_iterations += before.linear_iterations;
    line_searches += before.line_searches;
    step_cuts += before.step_cuts;
    projections += before.projections;
    solver_fallbacks += before.solver_fallbacks;
    noise_stops += before.noise_stops;
  }

  template <int dim>
  Totals<dim>
  total(const MaterialPoints<dim> &points)
  {
    std::vector<double> sums(7 + dim);
    unsigned int        p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const double mass = points.mass(p);
        sums[0] += mass;
        if (points.offset_velocity > 0)
          {
            Tensor<1, 3> x, v;
            for (unsigned int d = 0; d < dim; ++d)
              {
                x[d] = particle.get_location()[d];
                v[d] = points.fields(p)[points.offset_velocity + d];
                sums[7 + d] += mass * v[d];
              }
            sums[1] += 0.5 * mass * v.norm_square();
            const auto spin = cross_product_3d(x, v);
            for (unsigned int d = 0; d < 3; ++d)
              sums[4 + d] += mass * spin[d];
          }
        const auto energy =
          points.material(p).energy(deformation_gradient(points, p),
                                    points.fields(p) + points.offset_history);
        sums[2] += points.initial_volume(p) * energy.stored;
        sums[3] += points.initial_volume(p) * energy.dissipated;
        ++p;
      }
    Utilities::MPI::sum(sums, points.communicator, sums);
    Totals<dim> totals;
    totals.mass           = sums[0];
    totals.kinetic_energy = sums[1];
    totals.strain_energy  = sums[2];
    totals.plastic_work   = sums[3];
    for (unsigned int d = 0; d < dim; ++d)
      totals.momentum[d] = sums[7 + d];
    for (unsigned int d = 0; d < 3; ++d)
      totals.angular_momentum[d] = sums[4 + d];
    return totals;
  }

  template <int dim>
  std::vector<std::string>
  history_columns(const OutputSpec &output, const GeometryKind geometry)
  {
    std::vector<std::string> names = {"step",
                                      "time",
                                      "dt",
                                      "newton_iterations",
                                      "linear_iterations",
                                      "line_searches",
                                      "step_cuts",
                                      "points",
                                      "active_cells",
                                      "dofs",
                                      "mass"};
    for (unsigned int d = 0; d < dim; ++d)
      names.push_back(std::string("momentum_") + "xyz"[d]);
    names.insert(names.end(),
                 {"kinetic_energy",
                  "strain_energy",
                  "plastic_work",
                  "external_work",
                  "wall_seconds"});
    for (const auto &probe : output.probes)
      names.push_back(probe.name);
    for (const auto &reaction : output.reactions)
      names.push_back(reaction.name);
    names.insert(names.end(),
                 {"residual",
                  "tangent_projections",
                  "solver_fallbacks",
                  "noise_stops",
                  "held_cells",
                  "limited_boxes",
                  "total_energy"});
    if (geometry != GeometryKind::axisymmetric)
      for (unsigned int d = dim == 2 ? 2 : 0; d < 3; ++d)
        names.push_back(std::string("angular_momentum_") + "xyz"[d]);
    names.push_back("stabilization_work");
    return names;
  }

  template <int dim>
  History<dim>::History(const OutputSpec          &output,
                        const Faces<dim>          &faces,
                        const Bodies<dim>         &bodies,
                        const MaterialPoints<dim> &points,
                        const RigidBodies<dim>    &rigid,
                        const BackgroundGrid<dim> &grid)
    : columns(history_columns<dim>(output, points.layout.geometry))
    , output(output)
    , faces(faces)
    , bodies(bodies)
    , points(points)
    , rigid(rigid)
    , grid(grid)
    , reactions(output.reactions.size())
  {
    for (unsigned int f = 0; f < 2 * dim; ++f)
      face_start[f] = grid.face_position(f);
    for (const auto &probe : output.probes)
      {
        Follower follower;
        if (!probe.field.empty())
          {
            const std::string entry = "Output/" + probe.name + "/Field";
            follower.field =
              make_point_field(probe.field, points, output.fringe_number);
            if (!follower.field)
              throw InputError(entry,
                               "found '" + probe.field +
                                 (probe.field == "temperature" ?
                                    "', which needs a 'Specific heat' of "
                                    "every material" :
                                    "', which the points of this scene do "
                                    "not have"));
            if (probe.component >= follower.field->n_components)
              throw InputError("Output/" + probe.name + "/Component",
                               "found " + std::to_string(probe.component) +
                                 ", allowed is less than " +
                                 std::to_string(follower.field->n_components));
          }
        if (probe.kind == ProbeSpec::Kind::point)
          {
            struct
            {
              double distance = std::numeric_limits<double>::max();
              int    rank;
            } mine, nearest;
            mine.rank = Utilities::MPI::this_mpi_process(points.communicator);
            double id = -1;
            for (const auto &particle : points.sorted.particles)
              {
                double square = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  square +=
                    std::pow(particle.get_location()[d] - probe.position[d], 2);
                if (square < mine.distance)
                  {
                    mine.distance = square;
                    id            = particle.get_id();
                  }
              }
            MPI_Allreduce(&mine,
                          &nearest,
                          1,
                          MPI_DOUBLE_INT,
                          MPI_MINLOC,
                          points.communicator);
            follower.id =
              Utilities::MPI::broadcast(points.communicator, id, nearest.rank);
          }
        followers.push_back(follower);
      }
  }

  template <int dim>
  void
  History<dim>::open(const std::string &directory)
  {
    if (Utilities::MPI::this_mpi_process(points.communicator) != 0)
      return;
    file.open(directory + "/history.csv");
    for (const auto &name : columns)
      file << (name == columns.front() ? "" : ",") << name;
    file << std::endl;
    if (!file)
      throw SystemError("cannot write '" + directory + "/history.csv'");
  }

  template <int dim>
  void
  History<dim>::take_reactions(const StepProblem<dim> &problem,
                               const Vector           &forces)
  {
    for (unsigned int r = 0; r < reactions.size(); ++r)
      {
        const auto &spec = output.reactions[r];
        double      norm = 0;
        for (const double d : spec.direction)
          norm += d * d;
        // What the carrier exerts balances the material: the force on it is
        // the opposite.
        reactions[r] =
          -spec.factor / std::sqrt(norm) *
          problem.constraints.sum_over(spec.on, forces, spec.direction);
      }
  }

  template <int dim>
  double
  History<dim>::probe(const unsigned int index, const double time) const
  {
    using Kind            = ProbeSpec::Kind;
    const auto &spec      = output.probes[index];
    const auto &follower  = followers[index];
    const auto  component = spec.component;

    if (spec.kind == Kind::motion)
      {
        for (unsigned int f = 0; f < 2 * dim; ++f)
          if (faces[f].name == spec.of)
            return component == f / 2 ? grid.face_position(f) - face_start[f] :
                                        0.;
        for (const auto &body : rigid.bodies)
          if (body.spec->name == spec.of)
            return body.displacement(0, time)[component];
      }

    if (follower.field)
      follower.field->prepare();
    const double limit    = std::numeric_limits<double>::max();
    double       smallest = limit, largest = -limit, sum = 0, weight = 0;
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const unsigned int point = p++;
        const auto        &body =
          bodies[static_cast<unsigned int>(points.fields(point)[0])];
        if (spec.kind == Kind::point ?
              particle.get_id() != follower.id :
              !spec.bodies.empty() &&
                std::find(spec.bodies.begin(), spec.bodies.end(), body.name) ==
                  spec.bodies.end())
          continue;
        if (spec.where)
          {
            const auto start = points.initial_position(point);
            if (!(spec.where(start.begin_raw()) > 0))
              continue;
          }
        double values[9] = {};
        if (follower.field)
          follower.field->evaluate(point, particle.get_location(), values);
        double value = values[component];
        if (spec.kind == Kind::point && spec.field == "displacement" &&
            component < dim)
          {
            // From the point to the place that was asked for.
            const auto F     = deformation_gradient(points, point);
            const auto start = points.initial_position(point);
            for (unsigned int d = 0; d < dim; ++d)
              value += (F[component][d] - (component == d ? 1 : 0)) *
                       (spec.position[d] - start[d]);
          }
        if (spec.kind == Kind::extent)
          {
            // Half the box that the point stands for, stretched by F.
            const auto    F = deformation_gradient(points, point);
            const double *domain =
              points.fields(point) + points.layout.offset("initial_domain");
            value = particle.get_location()[component];
            for (unsigned int d = 0; d < dim; ++d)
              value += 0.5 * std::abs(F[component][d]) * domain[d];
          }
        smallest = std::min(smallest, value);
        largest  = std::max(largest, value);
        sum += value * points.initial_volume(point);
        weight += points.initial_volume(point);
      }
    const auto comm = points.communicator;
    if (spec.kind == Kind::mean)
      return Utilities::MPI::sum(sum, comm) / Utilities::MPI::sum(weight, comm);
    if (spec.kind == Kind::smallest)
      return Utilities::MPI::min(smallest, comm);
    largest = Utilities::MPI::max(largest, comm);
    return spec.kind == Kind::spread ?
             largest - Utilities::MPI::min(smallest, comm) :
             largest;
  }

  template <int dim>
  void
  History<dim>::write(const StepReport &report)
  {
    const auto totals   = total(points);
    const auto n_points = points.sorted.n_global();
    figures.clear();
    for (unsigned int i = 0; i < output.probes.size(); ++i)
      figures.emplace_back(output.probes[i].name,
                           output.probes[i].factor * probe(i, report.time));
    for (unsigned int i = 0; i < reactions.size(); ++i)
      figures.emplace_back(output.reactions[i].name, reactions[i]);
    if (Utilities::MPI::this_mpi_process(points.communicator) != 0)
      return;

    std::vector<double> row;
    const auto          add = [&](const double value) { row.push_back(value); };
    add(report.step);
    add(report.time);
    add(report.dt);
    add(report.newton_iterations);
    add(report.linear_iterations);
    add(report.line_searches);
    add(report.step_cuts);
    add(n_points);
    add(report.active_cells);
    add(report.dofs);
    add(totals.mass);
    for (unsigned int d = 0; d < dim; ++d)
      add(totals.momentum[d]);
    add(totals.kinetic_energy);
    add(totals.strain_energy);
    add(totals.plastic_work);
    add(report.external_work);
    add(report.wall_seconds);
    for (const auto &figure : figures)
      add(figure.second);
    add(report.residual);
    add(report.projections);
    add(report.solver_fallbacks);
    add(report.noise_stops);
    add(report.held_cells);
    add(report.limited_boxes);
    add(totals.kinetic_energy + totals.strain_energy);
    if (points.layout.geometry != GeometryKind::axisymmetric)
      for (unsigned int d = dim == 2 ? 2 : 0; d < 3; ++d)
        add(totals.angular_momentum[d]);
    add(report.stabilization_work);

    file << std::setprecision(12);
    for (unsigned int i = 0; i < row.size(); ++i)
      file << (i > 0 ? "," : "") << row[i];
    file << std::endl;
    if (remembers)
      rows.push_back(std::move(row));
    if (!file)
      throw SystemError("cannot write the history (disk full?)");
  }

  template <int dim>
  std::vector<double>
  History<dim>::column(const std::string &name) const
  {
    const auto          i = std::find(columns.begin(), columns.end(), name);
    std::vector<double> values;
    for (const auto &row : rows)
      values.push_back(row.at(i - columns.begin()));
    return values;
  }

  template std::vector<std::string>
  history_columns<2>(const OutputSpec &, GeometryKind);
  template std::vector<std::string>
  history_columns<3>(const OutputSpec &, GeometryKind);
  template class History<2>;
  template class History<3>;
  template Totals<2>
  total(const MaterialPoints<2> &);
  template Totals<3>
  total(const MaterialPoints<3> &);
} // namespace impm
