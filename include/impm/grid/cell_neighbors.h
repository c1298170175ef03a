#ifndef impm_grid_cell_neighbors_h
#define impm_grid_cell_neighbors_h

#include <deal.II/grid/grid_tools.h>

#include <impm/grid/discretization.h>

#include <vector>

namespace impm
{
  /** Fills the ghost cells of data by active cell index. Collective. */
  template <int dim>
  void
  exchange_cell_data(const Discretization<dim> &discretization,
                     std::vector<double>       &cell_data)
  {
    using Cell = typename Discretization<dim>::CellIterator;
    dealii::GridTools::exchange_cell_data_to_ghosts<double>(
      discretization.dof_handler(),
      [&](const Cell &cell) { return cell_data[cell->active_cell_index()]; },
      [&](const Cell &cell, const double value) {
        cell_data[cell->active_cell_index()] = value;
      });
  }

  /** Calls `action` with every active cell that shares a face with a cell. */
  template <int dim, typename Action>
  void
  for_each_neighbor(const typename Discretization<dim>::CellIterator &cell,
                    const Action                                     &action)
  {
    using Cell = typename Discretization<dim>::CellIterator;
    for (const unsigned int f : cell->face_indices())
      if (!cell->at_boundary(f))
        {
          const auto neighbor = cell->neighbor(f);
          if (!neighbor->has_children())
            action(Cell(neighbor));
          else
            for (unsigned int s = 0; s < cell->face(f)->n_children(); ++s)
              action(Cell(cell->neighbor_child_on_subface(f, s)));
        }
  }
} // namespace impm

#endif
