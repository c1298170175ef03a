#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <deal.II/fe/fe_values.h>

#include <impm/base/exceptions.h>
#include <impm/scene/point_file.h>
#include <impm/scene/seeding.h>

#include <sstream>

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

    template <int dim>
    void
    seed_shape(const GeometryKind         geometry,
               const BodySpec<dim>       &body,
               const BackgroundGrid<dim> &grid,
               std::vector<Seed<dim>>    &seeds)
    {
      unsigned int pattern = 1;
      for (const unsigned int n : body.points_per_cell)
        pattern *= n;
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          for (unsigned int k = 0; k < pattern; ++k)
            {
              Seed<dim>    seed;
              double       volume = 1;
              unsigned int index  = k;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  const unsigned int n      = body.points_per_cell[d];
                  const double       extent = cell_extent(cell, d);
                  seed.domain[d]            = extent / n;
                  seed.unit_position[d]     = (index % n + 0.5) / n;
                  seed.position[d] =
                    cell->vertex(0)[d] + seed.unit_position[d] * extent;
                  volume *= seed.domain[d];
                  index /= n;
                }
              if (!body.shape->contains(seed.position))
                continue;
              seed.cell   = cell;
              seed.volume = volume * circumference(geometry, seed.position);
              seeds.push_back(seed);
            }
    }

    template <int dim>
    Quadrature<dim>
    gauss_points(const std::array<unsigned int, dim> &numbers)
    {
      const QGauss<1> x(numbers[0]), y(numbers[1]);
      if constexpr (dim == 2)
        return QAnisotropic<2>(x, y);
      else
        return QAnisotropic<3>(x, y, QGauss<1>(numbers[2]));
    }

    /** Gauss points, in cells that lie in the body as a whole. */
    template <int dim>
    void
    seed_gauss_points(const GeometryKind         geometry,
                      const BodySpec<dim>       &body,
                      const BackgroundGrid<dim> &grid,
                      std::vector<Seed<dim>>    &seeds)
    {
      const auto    quadrature = gauss_points<dim>(body.points_per_cell);
      FEValues<dim> values(*grid.mapping,
                           grid.discretization()->dof_handler().get_fe(),
                           quadrature,
                           update_quadrature_points | update_JxW_values);
      std::string   cut;
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            unsigned int inside = 0;
            for (const auto &x : values.get_quadrature_points())
              inside += body.shape->contains(x);
            if (inside == 0)
              continue;
            if (inside < quadrature.size())
              {
                std::ostringstream place;
                place << cell->center();
                cut = place.str();
              }
            for (const unsigned int q : values.quadrature_point_indices())
              {
                Seed<dim> seed;
                seed.cell          = cell;
                seed.position      = values.quadrature_point(q);
                seed.unit_position = quadrature.point(q);
                seed.volume =
                  values.JxW(q) * circumference(geometry, seed.position);
                for (unsigned int d = 0; d < dim; ++d)
                  seed.domain[d] =
                    cell_extent(cell, d) / body.points_per_cell[d];
                seeds.push_back(seed);
              }
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
              const BodySpec<dim>       &body,
              const BackgroundGrid<dim> &grid,
              std::vector<Seed<dim>>    &seeds)
    {
      const auto cloud = read_point_file<dim>(body.point_file);
      if (cloud.volumes.empty() && !body.rigid)
        throw InputError("Bodies/" + body.name + "/File",
                         "found no column 'volume' in '" + body.point_file +
                           "', which a deformable body needs");
      // Owned by the first cell, by number, that contains it: a point on a
      // face between two ranks must be taken once.
      std::vector<double> owner(cloud.positions.size(), 1e300);
      std::vector<typename Triangulation<dim>::active_cell_iterator> cells(
        cloud.positions.size());
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          for (unsigned int p = 0; p < cloud.positions.size(); ++p)
            if (cell->bounding_box().point_inside(cloud.positions[p]) &&
                cell->global_active_cell_index() < owner[p])
              {
                owner[p] = cell->global_active_cell_index();
                cells[p] = cell;
              }
      std::vector<double> first(owner.size());
      Utilities::MPI::min(owner, grid.communicator, first);
      const auto refuse = [&](const unsigned int p, const std::string &why) {
        std::ostringstream place;
        place << cloud.positions[p];
        throw InputError("Bodies/" + body.name + "/File",
                         "point " + std::to_string(p + 1) + " of '" +
                           body.point_file + "' at " + place.str() + why);
      };
      for (unsigned int p = 0; p < owner.size(); ++p)
        {
          if (first[p] == 1e300)
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
          seeds.push_back(seed);
        }
    }
  } // namespace

  template <int dim>
  std::vector<Seed<dim>>
  seed_body(const Bodies<dim>         &bodies,
            const BodySpec<dim>       &body,
            const GeometryKind         geometry,
            const BackgroundGrid<dim> &grid)
  {
    std::vector<Seed<dim>> seeds;
    if (grid.is_lagrangian)
      seed_gauss_points(geometry, body, grid, seeds);
    else if (body.shape)
      seed_shape(geometry, body, grid, seeds);
    else
      seed_file(geometry, body, grid, seeds);

    const std::string entry =
      "Bodies/" + body.name + (body.shape ? "/Shape" : "/File");
    if (Utilities::MPI::sum(seeds.size(), grid.communicator) == 0)
      throw InputError(entry,
                       "body '" + body.name +
                         "' has no points: it is empty, lies outside the grid "
                         "or is too thin for 'Points per cell'");
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto &other = bodies[b];
        if (other.name == body.name || !other.shape)
          continue;
        unsigned int shared = 0;
        for (const auto &seed : seeds)
          shared += other.shape->contains(seed.position);
        shared = Utilities::MPI::sum(shared, grid.communicator);
        if (shared > 0)
          throw InputError(entry,
                           "bodies '" + body.name + "' and '" + other.name +
                             "' overlap: " + std::to_string(shared) +
                             " points of the first lie in the second");
      }
    return seeds;
  }

  template std::vector<Seed<2>>
  seed_body(const Bodies<2> &,
            const BodySpec<2> &,
            GeometryKind,
            const BackgroundGrid<2> &);
  template std::vector<Seed<3>>
  seed_body(const Bodies<3> &,
            const BodySpec<3> &,
            GeometryKind,
            const BackgroundGrid<3> &);
} // namespace impm
