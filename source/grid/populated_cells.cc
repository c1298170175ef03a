#include <impm/grid/populated_cells.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  PopulatedCells<dim>::PopulatedCells(const Footprints<dim>     &footprints,
                                      const MaterialPoints<dim> &points,
                                      const Discretization<dim> &discretization)
    : stiffness(discretization.triangulation().n_active_cells(), 0.)
  {
    // A point near the border of a rank touches cells of its neighbour. The
    // largest compliance survives the exchange, and zero means empty.
    Vector      compliance(discretization.triangulation()
                        .global_active_cell_index_partitioner()
                        .lock());
    const auto &partitioner = *compliance.get_partitioner();
    const auto  place       = [&](const auto &cell) {
      return partitioner.global_to_local(cell->global_active_cell_index());
    };
    for (const auto &cell : footprints.cells)
      {
        double &value = compliance.local_element(place(cell.cell));
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          value =
            std::max(value,
                     1 / points.material(footprints.point[e]).stiffness());
      }
    compliance.compress(VectorOperation::max);
    compliance.update_ghost_values();

    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (!cell->is_artificial())
        {
          const double value = compliance.local_element(place(cell));
          if (value == 0)
            continue;
          stiffness[cell->active_cell_index()] = 1 / value;
          if (cell->is_locally_owned())
            cells.push_back({cell, discretization.nodes_of(cell)});
        }
  }

  template class PopulatedCells<2>;
  template class PopulatedCells<3>;
} // namespace impm
