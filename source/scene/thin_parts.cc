#include <impm/grid/populated_cells.h>
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
    using CellIterator = typename Triangulation<dim>::active_cell_iterator;

    template <int dim>
    bool
    may_meet(const CellIterator<dim>               &cell,
             const std::optional<BoundingBox<dim>> &box)
    {
      return !box || box->get_neighbor_type(cell->bounding_box()) !=
                       NeighborType::not_neighbors;
    }

    /** Owned cells a cell or more away from any point of a body that its shape
     * may yet meet. Collective. */
    template <int dim>
    std::vector<CellIterator<dim>>
    cells_without(const unsigned int         body,
                  const Shape<dim>          &shape,
                  const BackgroundGrid<dim> &grid,
                  const MaterialPoints<dim> &points)
    {
      std::vector<double> has_points(grid.triangulation.n_active_cells());
      unsigned int        p = 0;
      for (const auto &particle : points.sorted.particles)
        if (points.body(p++) == body)
          has_points[particle.get_surrounding_cell()->active_cell_index()] = 1;
      exchange_cell_data(*grid.discretization(), has_points);
      std::vector<char> is_near(grid.triangulation.n_vertices());
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (!cell->is_artificial() && has_points[cell->active_cell_index()] > 0)
          for (const auto v : cell->vertex_indices())
            is_near[cell->vertex_index(v)] = 1;
      std::vector<CellIterator<dim>> cells;
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && may_meet(cell, shape.bounding_box))
          {
            const auto vertices = cell->vertex_indices();
            if (std::none_of(vertices.begin(),
                             vertices.end(),
                             [&](const unsigned int v) {
                               return is_near[cell->vertex_index(v)];
                             }))
              cells.push_back(cell);
          }
      return cells;
    }
  } // namespace

  template <int dim>
  std::vector<std::string>
  find_thin_parts(const Bodies<dim>         &bodies,
                  const BackgroundGrid<dim> &grid,
                  const MaterialPoints<dim> &points)
  {
    std::vector<std::string> sentences;
    if (grid.is_lagrangian)
      return sentences;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto &body = bodies[b];
        if (body.rigid || !body.shape)
          continue;
        const auto   cells   = cells_without(b, *body.shape, grid, points);
        const double n_cells = std::max<double>(
          1, Utilities::MPI::sum(cells.size(), grid.communicator));
        const unsigned int most =
          std::max(2., std::floor(std::pow(1e5 / n_cells, 1. / dim)));
        unsigned int n_found = 0;
        Point<dim>   first;
        for (const auto &cell : cells)
          {
            const unsigned int n = std::min(
              most,
              *std::max_element(body.points_per_cell.begin(),
                                body.points_per_cell.end())
                << (1 + std::max(0, grid.finest_level - grid.level(cell))));
            bool found = false;
            for (unsigned int i = 0; i < Utilities::pow(n, dim) && !found; ++i)
              {
                Point<dim> place;
                for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
                  place[d] = cell->vertex(0)[d] +
                             (rest % n + 0.5) / n * cell_extent(cell, d);
                found = body.shape->contains(place);
                if (found && n_found++ == 0)
                  first = place;
              }
          }
        std::string place;
        if (n_found > 0)
          {
            std::ostringstream text;
            text << first;
            place = text.str();
          }
        n_found = Utilities::MPI::sum(n_found, grid.communicator);
        for (const auto &one :
             Utilities::MPI::all_gather(grid.communicator, place))
          if (!one.empty())
            {
              sentences.push_back(
                "a part of body '" + body.name +
                "' has no points, since it is thinner than they are apart: in " +
                std::to_string(n_found) + " cells, one at " + one);
              break;
            }
      }
    return sentences;
  }

  template std::vector<std::string>
  find_thin_parts(const Bodies<2> &,
                  const BackgroundGrid<2> &,
                  const MaterialPoints<2> &);
  template std::vector<std::string>
  find_thin_parts(const Bodies<3> &,
                  const BackgroundGrid<3> &,
                  const MaterialPoints<3> &);
} // namespace impm
