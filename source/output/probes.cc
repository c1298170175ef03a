#include <impm/base/exceptions.h>
#include <impm/output/probes.h>
#include <impm/points/point_fields.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** The number of the point that is nearest to a place, or was so at the
     * start. Collective. */
    template <int dim>
    double
    nearest_point(const std::vector<double> &place,
                  const MaterialPoints<dim> &points,
                  const bool                 at_start)
    {
      Point<dim> center;
      std::copy_n(place.begin(), dim, center.begin_raw());
      // Of several that are as near, the oldest one, whichever rank has it.
      std::pair<double, double> best(std::numeric_limits<double>::max(), -1);
      const auto consider = [&](const double square, const double id) {
        const double slack = 1e-9 * (best.first + square);
        if (square < best.first - slack ||
            (square < best.first + slack && id < best.second))
          best = {square, id};
      };
      unsigned int p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const auto x =
            at_start ? points.initial_position(p) : particle.get_location();
          consider(x.distance_square(center), particle.get_id());
          ++p;
        }
      for (const auto &[square, id] :
           Utilities::MPI::all_gather(points.communicator, best))
        consider(square, id);
      return best.second;
    }

    template <int dim>
    double
    motion_of(const typename RigidBodies<dim>::Body &body,
              const ProbeSpec                       &spec,
              const double                           time)
    {
      const unsigned int c       = spec.component;
      const bool         is_free = body.spec->is_free;
      switch (spec.quantity)
        {
          case ProbeSpec::Quantity::velocity:
            return body.state.velocity[c];
          case ProbeSpec::Quantity::angular_velocity:
            return body.state.angular_velocity()[c];
          case ProbeSpec::Quantity::rotation:
            return !is_free ? body.angle(time) * body.spec->axis[c] :
                   dim == 2 ? body.state.angles[c] :
                              body.state.since_start.rotation_vector()[c];
          default:
            return body.since_start(time).shift[c];
        }
    }
  } // namespace

  template <int dim>
  std::function<double(double time)>
  make_probe(const ProbeSpec           &spec,
             const Scene<dim>          &scene,
             const MaterialPoints<dim> &points,
             const RigidBodies<dim>    &rigid,
             const BackgroundGrid<dim> &grid,
             double                    *id)
  {
    using Kind           = ProbeSpec::Kind;
    const auto component = spec.component;
    if (spec.kind == Kind::motion)
      {
        for (unsigned int f = 0; f < 2 * dim; ++f)
          if (scene.faces[f].name == spec.of)
            return
              [&grid, f, component, start = grid.face_position(f)](double) {
                return component == f / 2 ? grid.face_position(f) - start : 0.;
              };
        for (const auto &body : rigid.bodies)
          if (body.spec->name == spec.of)
            return [&body, &spec](const double time) {
              return motion_of<dim>(body, spec, time);
            };
      }

    std::optional<PointField<dim>> field;
    if (!spec.field.empty())
      {
        const std::string section = "Output/" + spec.name;
        field =
          make_point_field(spec.field, points, scene.output.fringe_number);
        if (!field)
          throw InputError(section + "/Field",
                           "found '" + spec.field +
                             (spec.field == "temperature" ?
                                "', which needs a 'Specific heat' or a "
                                "'Prescribed temperature' of every material" :
                                "', which the points of this scene do "
                                "not have"));
        if (component >= field->n_components)
          throw InputError(section + "/Component",
                           "found " + std::to_string(component) +
                             ", allowed is less than " +
                             std::to_string(field->n_components));
      }
    if (spec.kind == Kind::point)
      *id = nearest_point(spec.position, points, false);
    const auto is_meant =
      [&spec, &bodies = scene.bodies, &points](const unsigned int point) {
        return (spec.bodies.empty() ||
                std::count(spec.bodies.begin(),
                           spec.bodies.end(),
                           bodies[points.body(point)].name) > 0) &&
               (!spec.where ||
                spec.where(points.initial_position(point).begin_raw()) > 0);
      };
    unsigned int n_meant = 0;
    for (unsigned int point = 0; point < points.size(); ++point)
      n_meant += is_meant(point);
    if (spec.kind != Kind::point &&
        Utilities::MPI::sum(n_meant, points.communicator) == 0)
      throw InputError("Output/" + spec.name +
                         (spec.where ? "/Where" : "/Bodies"),
                       "makes the probe be of no point at all");
    return [&spec, is_meant, &points, component, field, id](double) {
      // Points that split or merge hand on the place.
      if (spec.kind == Kind::point && points.layout.find("parent"))
        *id = nearest_point(spec.position, points, true);
      if (field)
        field->prepare();
      const double limit    = std::numeric_limits<double>::max();
      double       smallest = limit, largest = -limit, sum = 0, weight = 0;
      unsigned int p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const unsigned int point = p++;
          if (spec.kind == Kind::point ? points.id(point) != *id :
                                         !is_meant(point))
            continue;
          double values[9] = {};
          if (field)
            field->evaluate(point, particle.get_location(), values);
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
          if (spec.kind == Kind::extent || spec.kind == Kind::lower_extent)
            {
              // Half the box that the point stands for, stretched by F.
              const double  side = spec.kind == Kind::extent ? 0.5 : -0.5;
              const auto    F    = deformation_gradient(points, point);
              const double *domain =
                points.fields(point) + points.layout.offset("initial_domain");
              value = particle.get_location()[component];
              for (unsigned int d = 0; d < dim; ++d)
                value += side * std::abs(F[component][d]) * domain[d];
            }
          smallest = std::min(smallest, value);
          largest  = std::max(largest, value);
          sum += value * points.initial_volume(point);
          weight += points.initial_volume(point);
        }
      const auto comm = points.communicator;
      if (spec.kind == Kind::mean)
        return Utilities::MPI::sum(sum, comm) /
               Utilities::MPI::sum(weight, comm);
      if (spec.kind == Kind::smallest || spec.kind == Kind::lower_extent)
        return Utilities::MPI::min(smallest, comm);
      largest = Utilities::MPI::max(largest, comm);
      return spec.kind == Kind::spread ?
               largest - Utilities::MPI::min(smallest, comm) :
               largest;
    };
  }

  template decltype(make_probe<2>) make_probe<2>;
  template decltype(make_probe<3>) make_probe<3>;
} // namespace impm
