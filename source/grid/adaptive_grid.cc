#include <impm/base/exceptions.h>
#include <impm/grid/adaptive_grid.h>
#include <impm/grid/populated_cells.h>

#include <algorithm>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Of the owned and ghost cells at every vertex, -1 where there is none.
     * Collective. */
    template <int dim>
    std::vector<double>
    largest_at_vertices(const BackgroundGrid<dim> &grid,
                        std::vector<double>       &levels)
    {
      exchange_cell_data(*grid.discretization(), levels);
      std::vector<double> at_vertices(grid.triangulation.n_vertices(), -1);
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (!cell->is_artificial())
          for (const auto v : cell->vertex_indices())
            {
              double &level = at_vertices[cell->vertex_index(v)];
              level = std::max(level, levels[cell->active_cell_index()]);
            }
      return at_vertices;
    }

    /** Gives every owned cell the largest level of those around it, so often.
     * Collective. */
    template <int dim>
    void
    spread_levels(const BackgroundGrid<dim> &grid,
                  const unsigned int         n_cells,
                  std::vector<double>       &levels)
    {
      for (unsigned int i = 0; i < n_cells; ++i)
        {
          const auto at_vertices = largest_at_vertices(grid, levels);
          for (const auto &cell : grid.triangulation.active_cell_iterators())
            if (cell->is_locally_owned())
              for (const auto v : cell->vertex_indices())
                {
                  double &level = levels[cell->active_cell_index()];
                  level = std::max(level, at_vertices[cell->vertex_index(v)]);
                }
        }
    }

    /**
     * Raises the next levels of owned cells until those that touch differ by
     * one at most, whichever of them goes first, and siblings are coarsened
     * together. deal.II would see to that, too, but what it takes back depends
     * on the ranks, since it does not know what becomes of ghost cells, and
     * points split in between.
     *
     * Cells without points become as fine as those with points that they
     * touch, by one level at a time. A node of the material would hang
     * on them otherwise, and so on nodes that have no mass but by it, or that
     * belong to another body. Collective.
     */
    template <int dim>
    void
    settle_levels(const BackgroundGrid<dim> &grid,
                  const MaterialPoints<dim> &points,
                  std::vector<double>       &levels)
    {
      const auto is_empty = [&](const auto &cell) {
        return points.sorted.particles.n_particles_in_cell(cell) == 0;
      };
      const auto next = [&](const auto &cell) -> double & {
        return levels[cell->active_cell_index()];
      };
      const auto may_be_coarsened = [&](const auto &cell) {
        for (const auto &sibling : cell->parent()->child_iterators())
          if (!sibling->is_active() || next(sibling) >= grid.level(sibling))
            return false;
        return true;
      };
      for (bool changed = true; changed;)
        {
          changed                = false;
          auto levels_on_the_way = levels;
          for (const auto &cell : grid.triangulation.active_cell_iterators())
            if (cell->is_locally_owned())
              {
                double &level = levels_on_the_way[cell->active_cell_index()];
                level         = std::max<double>(level, grid.level(cell));
              }
          const auto at_vertices = largest_at_vertices(grid, levels_on_the_way);
          for (const auto &cell : grid.triangulation.active_cell_iterators())
            if (cell->is_locally_owned() && is_empty(cell))
              levels_on_the_way[cell->active_cell_index()] = -1;
          const auto at_material = largest_at_vertices(grid, levels_on_the_way);
          for (const auto &cell : grid.triangulation.active_cell_iterators())
            if (cell->is_locally_owned())
              {
                double least = next(cell);
                for (const auto v : cell->vertex_indices())
                  {
                    const auto vertex = cell->vertex_index(v);
                    least = std::max(least, at_vertices[vertex] - 1);
                    if (is_empty(cell))
                      least = std::max(least,
                                       std::min(at_material[vertex],
                                                grid.level(cell) + 1.));
                  }
                if (least < grid.level(cell) && !may_be_coarsened(cell))
                  least = grid.level(cell);
                changed    = changed || least > next(cell);
                next(cell) = least;
              }
          changed =
            Utilities::MPI::max<unsigned int>(changed, grid.communicator) > 0;
        }
    }
  } // namespace

  template <int dim>
  bool
  AdaptiveGrid<dim>::flag_cells(BackgroundGrid<dim>       &grid,
                                const MaterialPoints<dim> &points,
                                const RigidBodies<dim>    &rigid,
                                const PolicyTime          &now)
  {
    std::vector<int> wanted(grid.triangulation.n_active_cells(), spec.lowest);
    for (const auto &criterion : spec.criteria)
      raise_levels<dim>(criterion,
                        {grid, points, rigid, now.time, now.round == 0},
                        wanted);
    std::vector<double> refine(wanted.size());
    for (unsigned int i = 0; i < wanted.size(); ++i)
      refine[i] = std::min<int>(wanted[i], spec.highest);
    spread_levels(grid, spec.buffer, refine);
    auto keep = refine;
    spread_levels(grid, spec.hysteresis, keep);
    std::vector<double> next(wanted.size());
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto i     = cell->active_cell_index();
          const int  level = grid.level(cell);
          next[i]          = level < refine[i] ? level + 1 :
                             level > keep[i]   ? level - 1 :
                                                 level;
        }
    settle_levels(grid, points, next);
    const auto change = [&](const auto &cell) {
      return next[cell->active_cell_index()] - grid.level(cell);
    };
    std::vector<double> n_changes = {0, 0}; // cells to refine, to coarsen
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          n_changes[0] += change(cell) > 0;
          n_changes[1] += change(cell) < 0;
        }
    Utilities::MPI::sum(n_changes, grid.communicator, n_changes);
    const double children = 1u << dim;
    check_number_of_cells(grid.triangulation.n_global_active_cells() +
                            (children - 1) *
                              (n_changes[0] - n_changes[1] / children),
                          now.time);
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          if (change(cell) > 0)
            cell->set_refine_flag();
          else if (change(cell) < 0)
            cell->set_coarsen_flag();
        }
    return n_changes[0] + n_changes[1] > 0;
  }

  template <int dim>
  void
  AdaptiveGrid<dim>::check_number_of_cells(const double n_cells,
                                           const double time) const
  {
    if (n_cells <= spec.most_cells)
      return;
    std::ostringstream text;
    text << "the criteria of 'Grid/Adaptation' want " << n_cells
         << " cells or more, allowed are " << spec.most_cells
         << " ('Largest number of cells')";
    if (time == 0)
      throw InputError("Grid/Adaptation/Highest level", text.str());
    throw ComputationError(text.str());
  }

  template class AdaptiveGrid<2>;
  template class AdaptiveGrid<3>;
} // namespace impm
