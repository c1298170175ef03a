#include <impm/grid/populated_cells.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  PopulatedCells<dim>::PopulatedCells(const Footprints<dim>     &footprints,
                                      const MaterialPoints<dim> &points,
                                      const Discretization<dim> &discretization)
  {
    // A point near the border of a rank touches cells of its neighbour. The
    // largest compliance survives the exchange, and zero means empty.
    const auto &triangulation = discretization.numbering->triangulation;
    Vector      compliance(
      triangulation.global_active_cell_index_partitioner().lock());
    for (const auto &cell : footprints.cells)
      {
        double &value = compliance(cell.cell->global_active_cell_index());
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          value =
            std::max(value,
                     1 / points.material(footprints.point[e]).stiffness());
      }
    compliance.compress(VectorOperation::max);
    compliance.update_ghost_values();

    stiffness.resize(triangulation.n_active_cells());
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (!cell->is_artificial())
        if (const double value = compliance(cell->global_active_cell_index());
            value > 0)
          {
            stiffness[cell->active_cell_index()] = 1 / value;
            if (cell->is_locally_owned())
              cells.push_back({cell, discretization.nodes_of(cell)});
          }
  }

  template class PopulatedCells<2>;
  template class PopulatedCells<3>;
} // namespace impm
