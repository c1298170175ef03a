#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/numerics/rtree.h>

#include <impm/base/exceptions.h>
#include <impm/scene/part_of_box.h>
#include <impm/scene/point_file.h>
#include <impm/scene/seeding.h>

#include <boost/lexical_cast.hpp>

#include <array>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    double
    circumference(const GeometryKind geometry, const Point<dim> &position)
    {
      return geometry == GeometryKind::axisymmetric ?
               2 * numbers::PI * position[0] :
               1.;
    }

    /** The pattern of points in a cell: evenly spaced, or those of Gauss. */
    template <int dim>
    Quadrature<dim>
    points_of_a_cell(const std::array<unsigned int, dim> &numbers,
                     const bool                           gauss)
    {
      const auto line = [&](const unsigned int d) -> Quadrature<1> {
        const unsigned int n = numbers[d];
        if (gauss)
          return QGauss<1>(n);
        std::vector<Point<1>> points;
        for (unsigned int i = 0; i < n; ++i)
          points.emplace_back((i + 0.5) / n);
        return points;
      };
      if constexpr (dim == 2)
        return QAnisotropic<2>(line(0), line(1));
      else
        return QAnisotropic<3>(line(0), line(1), line(2));
    }

    /** How many points of a body lie in each other one, by its number. */
    using SharedPoints = std::vector<unsigned int>;

    /** Calls an action with the number of every other body that has a shape. */
    template <int dim, typename Action>
    void
    for_others(const Bodies<dim>   &bodies,
               const BodySpec<dim> &body,
               const Action        &action)
    {
      for (unsigned int b = 0; b < bodies.size(); ++b)
        if (bodies[b].name != body.name && bodies[b].shape)
          action(b);
    }

    template <int dim>
    void
    count_shared(const Bodies<dim>   &bodies,
                 const BodySpec<dim> &body,
                 const Seed<dim>     &seed,
                 SharedPoints        &shared)
    {
      for_others(bodies, body, [&](const unsigned int b) {
        const auto &other = bodies[b];
        shared[b] += other.shape->contains(
          other.surface == SurfaceSeeding::whole_cells ? seed.cell->center() :
                                                         seed.position);
      });
    }

    /** Whether the surface of a shape goes through a box, if it is nearly flat
     * there. */
    template <int dim>
    bool
    is_cut(const BoundingBox<dim> &box, const Shape<dim> &shape)
    {
      const bool is_inside = shape.contains(box.center());
      for (const unsigned int v : GeometryInfo<dim>::vertex_indices())
        if (shape.contains(box.vertex(v)) != is_inside)
          return true;
      return false;
    }

    /** Makes a seed stand for what of its box lies in the shape of its body;
     * tells whether there is any. The centroid of that may well lie outside. */
    template <int dim>
    bool
    cut_to_shape(const Bodies<dim>      &bodies,
                 const BodySpec<dim>    &body,
                 const BoundingBox<dim> &box,
                 Seed<dim>              &seed,
                 SharedPoints           &shared)
    {
      const auto &contains = body.shape->contains;
      const auto  part     = find_part(contains, box);
      if (part.share == 0)
        return false;
      for_others(bodies, body, [&](const unsigned int b) {
        const std::function<bool(const Point<dim> &)> in_both =
          [&](const Point<dim> &place) {
            return contains(place) && bodies[b].shape->contains(place);
          };
        shared[b] += bodies[b].surface == SurfaceSeeding::whole_cells ?
                       bodies[b].shape->contains(seed.cell->center()) :
                       find_part(in_both, box).share > 0;
      });
      if (part.share == 1)
        return true;
      seed.domain   = part.extents;
      seed.position = part.centroid;
      seed.volume *= part.share;
      for (unsigned int d = 0; d < dim; ++d)
        seed.unit_position[d] = (seed.position[d] - seed.cell->vertex(0)[d]) /
                                cell_extent(seed.cell, d);
      return true;
    }

    /** The cells of a Lagrangian grid have to lie in the body as a whole. */
    template <int dim>
    void
    seed_shape(const GeometryKind         geometry,
               const Bodies<dim>         &bodies,
               const BodySpec<dim>       &body,
               const BackgroundGrid<dim> &grid,
               std::vector<Seed<dim>>    &seeds,
               SharedPoints              &shared)
    {
      const auto pattern_of = [&](const unsigned int multiple) {
        auto numbers = body.points_per_cell;
        for (auto &number : numbers)
          number *= multiple;
        return points_of_a_cell<dim>(numbers, grid.is_lagrangian);
      };
      const auto            regular = pattern_of(1);
      const FE_Nothing<dim> no_field;
      FEValues<dim>         values(*grid.mapping,
                           no_field,
                           regular,
                           update_quadrature_points | update_JxW_values);
      std::string           cut;
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            // Rigid bodies must have no gaps where cells become finer.
            const unsigned int multiple =
              body.rigid ?
                1u << std::max(0, grid.finest_level - grid.level(cell)) :
                1u;
            const auto pattern = multiple == 1 ? regular : pattern_of(multiple);
            const unsigned int n_before = seeds.size();
            if (grid.is_lagrangian)
              values.reinit(cell);
            for (unsigned int q = 0; q < pattern.size(); ++q)
              {
                Seed<dim> seed;
                seed.cell          = cell;
                seed.unit_position = pattern.point(q);
                seed.volume        = 1;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    const double extent = cell_extent(cell, d);
                    seed.domain[d] =
                      extent / (multiple * body.points_per_cell[d]);
                    seed.position[d] =
                      cell->vertex(0)[d] + seed.unit_position[d] * extent;
                    seed.volume *= seed.domain[d];
                  }
                if (grid.is_lagrangian)
                  {
                    seed.position = values.quadrature_point(q);
                    seed.volume   = values.JxW(q);
                  }
                const BoundingBox<dim> box({seed.position - 0.5 * seed.domain,
                                            seed.position + 0.5 * seed.domain});
                if (body.surface == SurfaceSeeding::cut_boxes &&
                    is_cut(box, *body.shape))
                  {
                    if (!cut_to_shape(bodies, body, box, seed, shared))
                      continue;
                  }
                else if (body.shape->contains(body.surface ==
                                                  SurfaceSeeding::whole_cells ?
                                                cell->center() :
                                                seed.position))
                  count_shared(bodies, body, seed, shared);
                else
                  continue;
                seed.volume *= circumference(geometry, seed.position);
                seeds.push_back(seed);
              }
            const unsigned int n_inside = seeds.size() - n_before;
            if (grid.is_lagrangian && n_inside > 0 && n_inside < pattern.size())
              cut = boost::lexical_cast<std::string>(cell->center());
          }
      for (const auto &place :
           Utilities::MPI::all_gather(grid.communicator, cut))
        if (!place.empty())
          throw InputError("Bodies/" + body.name + "/Shape",
                           "the surface of body '" + body.name +
                             "' cuts the cell around " + place +
                             ", but a Lagrangian grid must fit its bodies");
    }

    template <int dim>
    void
    seed_file(const GeometryKind         geometry,
              const Bodies<dim>         &bodies,
              const BodySpec<dim>       &body,
              const BackgroundGrid<dim> &grid,
              std::vector<Seed<dim>>    &seeds,
              SharedPoints              &shared)
    {
      const auto cloud = read_point_file<dim>(body.point_file);
      if (cloud.volumes.empty() && !body.rigid)
        throw InputError("Bodies/" + body.name + "/File",
                         "found no column 'volume' in '" + body.point_file +
                           "', which a deformable body needs");
      // Owned by the first cell, by number, that contains it: a point on a
      // face between two ranks must be taken once.
      const double        nowhere = 1e300;
      std::vector<double> owner(cloud.positions.size(), nowhere);
      std::vector<decltype(Seed<dim>::cell)> cells(owner.size());
      const auto tree = pack_rtree_of_indices(cloud.positions);
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const auto box = cell->bounding_box();
            // A box says of itself what is inside, up to round-off.
            auto near = box;
            near.extend(1e-9 * box.side_length(0));
            for (const auto p :
                 tree | boost::geometry::index::adaptors::queried(
                          boost::geometry::index::intersects(near)))
              if (owner[p] == nowhere && box.point_inside(cloud.positions[p]))
                {
                  owner[p] = cell->global_active_cell_index();
                  cells[p] = cell;
                }
          }
      std::vector<double> first(owner.size());
      Utilities::MPI::min(owner, grid.communicator, first);
      const auto refuse = [&](const unsigned int p, const std::string &why) {
        throw InputError(
          "Bodies/" + body.name + "/File",
          "point " + std::to_string(p + 1) + " of '" + body.point_file +
            "' at " + boost::lexical_cast<std::string>(cloud.positions[p]) +
            why);
      };
      for (unsigned int p = 0; p < owner.size(); ++p)
        {
          if (first[p] == nowhere)
            refuse(p, " lies outside the grid");
          if (!body.rigid && circumference(geometry, cloud.positions[p]) == 0)
            refuse(p,
                   " lies on the axis, where a ring has no volume; allowed is "
                   "r > 0");
          if (owner[p] != first[p])
            continue;
          Seed<dim> seed;
          seed.cell     = cells[p];
          seed.position = cloud.positions[p];
          seed.unit_position =
            grid.mapping->transform_real_to_unit_cell(seed.cell, seed.position);
          seed.volume = body.rigid ? 1. : cloud.volumes[p];
          const double extent =
            std::pow(seed.volume / circumference(geometry, seed.position),
                     1. / dim);
          for (unsigned int d = 0; d < dim; ++d)
            seed.domain[d] = extent;
          count_shared(bodies, body, seed, shared);
          seeds.push_back(seed);
        }
    }
  } // namespace

  template <int dim>
  std::vector<Seed<dim>>
  seed_body(const Bodies<dim>         &bodies,
            const BodySpec<dim>       &body,
            const GeometryKind         geometry,
            const BackgroundGrid<dim> &grid,
            const bool                 may_be_empty)
  {
    std::vector<Seed<dim>> seeds;
    SharedPoints           shared(bodies.size());
    if (body.shape)
      seed_shape(geometry, bodies, body, grid, seeds, shared);
    else
      seed_file(geometry, bodies, body, grid, seeds, shared);

    const std::string entry =
      "Bodies/" + body.name + (body.shape ? "/Shape" : "/File");
    if (!may_be_empty &&
        Utilities::MPI::sum(seeds.size(), grid.communicator) == 0)
      throw InputError(entry,
                       "body '" + body.name +
                         "' has no points: it is empty, lies outside the grid "
                         "or is too thin for 'Points per cell'");
    Utilities::MPI::sum(shared, grid.communicator, shared);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (shared[b] > 0)
        throw InputError(entry,
                         "bodies '" + body.name + "' and '" + bodies[b].name +
                           "' overlap: " + std::to_string(shared[b]) +
                           " points of the first lie in the second");
    return seeds;
  }

  template std::vector<Seed<2>>
  seed_body(const Bodies<2> &,
            const BodySpec<2> &,
            GeometryKind,
            const BackgroundGrid<2> &,
            bool);
  template std::vector<Seed<3>>
  seed_body(const Bodies<3> &,
            const BodySpec<3> &,
            GeometryKind,
            const BackgroundGrid<3> &,
            bool);
} // namespace impm
