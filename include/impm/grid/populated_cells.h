#ifndef impm_grid_populated_cells_h
#define impm_grid_populated_cells_h

#include <deal.II/grid/grid_tools.h>

#include <impm/footprints/footprints.h>

#include <vector>

namespace impm
{
  /** Where the material of a step is, whichever rank has the points. */
  template <int dim>
  class PopulatedCells
  {
  public:
    /** Measures what of the cells is filled if asked to. Collective. */
    PopulatedCells(const Footprints<dim>     &footprints,
                   const MaterialPoints<dim> &points,
                   const Discretization<dim> &discretization,
                   bool                       with_filling);

    struct Cell
    {
      typename Discretization<dim>::CellIterator         cell;
      unsigned int                                       layer;
      std::array<unsigned int, Footprints<dim>::n_nodes> nodes;
    };

    std::vector<Cell> cells; ///< owned ones that points of a layer touch

    /**
     * Smallest Young's modulus in a cell, owned or ghost, by layer and active
     * index; 0 where there is no material (Pa).
     */
    std::vector<std::vector<double>> stiffness;

    /**
     * Likewise the part of a cell that is filled by material (-, 1 where it is
     * full), if it was to be measured.
     */
    std::vector<std::vector<double>> filling;

  private:
    void
    measure_filling(const Footprints<dim>     &footprints,
                    const MaterialPoints<dim> &points,
                    const Discretization<dim> &discretization);
  };

  /** Fills the ghost cells of data by active cell index. Collective. */
  template <int dim>
  void
  exchange_cell_data(const Discretization<dim> &discretization,
                     std::vector<double>       &cell_data)
  {
    dealii::GridTools::exchange_cell_data_to_ghosts<double>(
      discretization.dof_handler(),
      [&](const auto &cell) { return cell_data[cell->active_cell_index()]; },
      [&](const auto &cell, const double value) {
        cell_data[cell->active_cell_index()] = value;
      });
  }
} // namespace impm

#endif
