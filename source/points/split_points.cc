#include <deal.II/base/mpi.h>

#include <impm/points/adapt_points.h>
#include <impm/points/point_domains.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Part of a point that may be all of it. */
    template <int dim>
    struct Part
    {
      Point<dim>          position;
      std::vector<double> fields;
    };

    /** Halves a part across its edge along an axis; returns the other half. */
    template <int dim>
    Part<dim>
    halve(const MaterialPoints<dim> &points,
          const BackgroundGrid<dim> &grid,
          const PointDomains<dim>   &fields,
          const unsigned int         point,
          const unsigned int         axis,
          Part<dim>                 &part)
    {
      auto      &x     = part.position;
      const auto edge  = fields.edge(part.fields.data(), axis);
      double     reach = 0.25;
      // Both halves stay in the domain, wherever the point has drifted.
      for (unsigned int d = 0; d < dim; ++d)
        if (edge[d] != 0)
          reach = std::min(
            {reach,
             (x[d] - grid.face_position(2 * d)) / (2 * std::abs(edge[d])),
             (grid.face_position(2 * d + 1) - x[d]) / (2 * std::abs(edge[d]))});
      const auto shift = reach * edge;
      // Rings have volumes as their radii.
      const double excess =
        points.layout.geometry == GeometryKind::axisymmetric ? shift[0] / x[0] :
                                                               0.;
      const auto        &material = points.material(point);
      const bool         conducts = material.conducts();
      const unsigned int temperature =
        points.offset_history + material.temperature_offset;
      Part<dim> other = part;
      for (const auto i : fields.shared)
        {
          other.fields[i] = 0.5 * (1 + excess) * part.fields[i];
          part.fields[i] -= other.fields[i];
        }
      other.position = x + shift;
      x -= shift;
      for (Part<dim> *half : {&part, &other})
        {
          const double sign   = half == &other ? 1 : -1;
          double      *values = half->fields.data();
          if (points.offset_initial_position > 0)
            values[points.offset_initial_position + axis] +=
              sign * reach * values[fields.domain + axis];
          if (points.offset_gradient > 0)
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int d = 0; d < dim; ++d)
                // From the centre of mass.
                values[points.offset_velocity + c] +=
                  values[points.offset_gradient + dim * c + d] *
                  (sign - excess) * shift[d];
          if (conducts)
            values[temperature] +=
              (sign - excess) *
              (points.vector(point, points.offset_temperature_gradient) *
               shift);
          values[fields.domain + axis] /= 2;
        }
      return other;
    }
  } // namespace

  template <int dim>
  PointChanges
  split_points(const Bodies<dim>         &bodies,
               const BackgroundGrid<dim> &grid,
               MaterialPoints<dim>       &points)
  {
    const PointDomains<dim> fields(points);
    PointChanges            changes;
    std::vector<Seed<dim>>  seeds;
    std::vector<Part<dim>>  parts, children;
    unsigned int            p = 0;
    for (auto &particle : points.sorted.particles)
      {
        const unsigned int point = p++;
        const auto        &body  = bodies[points.body(point)];
        if (body.adaptation == PointAdaptation::off)
          continue;
        const auto cell    = particle.get_surrounding_cell();
        const auto extents = extents_of<dim>(cell);
        // A tenth more, so that small strains do not double the points.
        const double longest = 1.1 / body.points_across;
        // Where a flow draws points to threads there are enough of them.
        const double smallest = std::pow(4 * body.points_across, -1. * dim);
        const auto   axis_to_split = [&](const Part<dim> &part) {
          unsigned int   longest_axis = dim;
          double         largest      = longest;
          Tensor<2, dim> edges;
          for (unsigned int axis = 0; axis < dim; ++axis)
            {
              edges[axis]        = fields.edge(part.fields.data(), axis);
              const double share = span(edges[axis], extents);
              if (share > largest)
                {
                  largest      = share;
                  longest_axis = axis;
                }
              for (unsigned int d = 0; d < dim; ++d)
                edges[axis][d] /= extents[d];
            }
          return std::abs(determinant(edges)) > smallest ? longest_axis : dim;
        };

        double *values = points.fields(point);
        parts.assign(1,
                     {particle.get_location(),
                      std::vector<double>(values,
                                          values + points.layout.size())});
        for (unsigned int i = 0; i < parts.size();)
          if (const auto axis = axis_to_split(parts[i]); axis < dim)
            {
              auto other = halve(points, grid, fields, point, axis, parts[i]);
              parts.push_back(std::move(other));
            }
          else
            ++i;
        if (parts.size() == 1)
          continue;

        changes.splits += parts.size() - 1;
        const double density = points.material(point).density;
        changes.kinetic_energy -=
          0.5 * points.mass(point) * square_of_velocity(points, values);
        for (const auto &part : parts)
          changes.kinetic_energy +=
            0.5 * density * part.fields[1] *
            square_of_velocity(points, part.fields.data());
        particle.set_location(parts[0].position);
        std::copy(parts[0].fields.begin(), parts[0].fields.end(), values);
        for (unsigned int i = 1; i < parts.size(); ++i)
          {
            parts[i].fields[fields.parent] = particle.get_id();
            Seed<dim> seed{};
            seed.cell     = cell;
            seed.position = parts[i].position;
            for (unsigned int d = 0; d < dim; ++d)
              seed.unit_position[d] = 0.5; // until they are sorted
            seeds.push_back(seed);
            children.push_back(std::move(parts[i]));
          }
      }
    changes.splits = Utilities::MPI::sum(changes.splits, grid.communicator);
    if (changes.splits == 0)
      return changes;
    changes.kinetic_energy =
      Utilities::MPI::sum(changes.kinetic_energy, grid.communicator);
    unsigned int child = 0;
    points.sorted.insert(seeds, [&](const Seed<dim> &, double *values) {
      const auto &from = children[child++].fields;
      std::copy(from.begin(), from.end(), values);
    });
    points.sort();
    return changes;
  }

  template PointChanges
  split_points(const Bodies<2> &,
               const BackgroundGrid<2> &,
               MaterialPoints<2> &);
  template PointChanges
  split_points(const Bodies<3> &,
               const BackgroundGrid<3> &,
               MaterialPoints<3> &);
} // namespace impm
