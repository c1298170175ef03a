#include <impm/grid/adaptive_grid.h>
#include <impm/grid/populated_cells.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Gives every owned cell the largest level of those around it, so often.
     * Collective. */
    template <int dim>
    void
    spread_levels(const BackgroundGrid<dim> &grid,
                  const unsigned int         n_cells,
                  std::vector<double>       &levels)
    {
      const auto discretization = grid.discretization();
      const auto cells          = grid.triangulation.active_cell_iterators();
      for (unsigned int i = 0; i < n_cells; ++i)
        {
          exchange_cell_data(*discretization, levels);
          std::vector<double> at_vertices(grid.triangulation.n_vertices(), -1);
          for (const auto &cell : cells)
            if (!cell->is_artificial())
              for (const auto v : cell->vertex_indices())
                {
                  double &level = at_vertices[cell->vertex_index(v)];
                  level = std::max(level, levels[cell->active_cell_index()]);
                }
          for (const auto &cell : cells)
            if (cell->is_locally_owned())
              for (const auto v : cell->vertex_indices())
                {
                  double &level = levels[cell->active_cell_index()];
                  level = std::max(level, at_vertices[cell->vertex_index(v)]);
                }
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
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const int level = grid.level(cell);
          if (level < refine[cell->active_cell_index()])
            cell->set_refine_flag();
          else if (level > keep[cell->active_cell_index()])
            cell->set_coarsen_flag();
        }
    // Takes back the flags of cells whose siblings stay.
    grid.triangulation.prepare_coarsening_and_refinement();
    bool any = false;
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      any = any || (cell->is_locally_owned() &&
                    (cell->refine_flag_set() || cell->coarsen_flag_set()));
    return Utilities::MPI::max<unsigned int>(any, grid.communicator) > 0;
  }

  template class AdaptiveGrid<2>;
  template class AdaptiveGrid<3>;
} // namespace impm
