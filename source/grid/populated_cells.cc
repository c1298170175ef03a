#include <impm/grid/populated_cells.h>
#include <impm/points/point_fields.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  template <int dim>
  PopulatedCells<dim>::PopulatedCells(const Footprints<dim>     &footprints,
                                      const MaterialPoints<dim> &points,
                                      const Discretization<dim> &discretization,
                                      const bool                 with_filling)
  {
    if (with_filling)
      measure_filling(footprints, points, discretization);
    const auto        &triangulation = discretization.numbering->triangulation;
    const unsigned int n_layers      = discretization.numbering->n_layers;
    stiffness.assign(n_layers,
                     std::vector<double>(triangulation.n_active_cells()));
    cells.reserve(footprints.cells.size());
    for (const auto &cell : footprints.cells)
      {
        double smallest = std::numeric_limits<double>::max();
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          smallest =
            std::min(smallest, points.remaining_stiffness(footprints.point[e]));
        const unsigned int layer = discretization.layer(cell.nodes[0]);
        stiffness[layer][cell.cell->active_cell_index()] = smallest;
        if (cell.cell->is_locally_owned())
          cells.push_back({cell.cell, layer, cell.nodes});
      }
    if (Utilities::MPI::n_mpi_processes(discretization.communicator) == 1)
      return;

    // A point near the border of a rank touches cells of its neighbour. The
    // largest compliance survives the exchange, and zero means empty.
    for (unsigned int layer = 0; layer < n_layers; ++layer)
      {
        auto  &of_layer = stiffness[layer];
        Vector compliance(
          triangulation.global_active_cell_index_partitioner().lock());
        for (const auto &cell : footprints.cells)
          if (discretization.layer(cell.nodes[0]) == layer)
            compliance(cell.cell->global_active_cell_index()) =
              1 / of_layer[cell.cell->active_cell_index()];
        compliance.compress(VectorOperation::max);
        compliance.update_ghost_values();
        for (const auto &cell :
             discretization.dof_handler().active_cell_iterators())
          if (!cell->is_artificial())
            if (const double value =
                  compliance(cell->global_active_cell_index());
                value > 0)
              {
                double &here = of_layer[cell->active_cell_index()];
                if (here == 0 && cell->is_locally_owned())
                  cells.push_back(
                    {cell, layer, discretization.nodes_of(cell, layer)});
                here = 1 / value;
              }
      }
  }

  template <int dim>
  void
  PopulatedCells<dim>::measure_filling(
    const Footprints<dim>     &footprints,
    const MaterialPoints<dim> &points,
    const Discretization<dim> &discretization)
  {
    std::vector<double> measures;
    for (const auto &particle : points.sorted.particles)
      measures.push_back(
        present_measure(points, measures.size(), particle.get_location()));

    const auto &triangulation = discretization.numbering->triangulation;
    filling.assign(discretization.numbering->n_layers,
                   std::vector<double>(triangulation.n_active_cells()));
    for (unsigned int layer = 0; layer < filling.size(); ++layer)
      {
        Vector parts(
          triangulation.global_active_cell_index_partitioner().lock());
        for (const auto &cell : footprints.cells)
          if (discretization.layer(cell.nodes[0]) == layer)
            for (unsigned int e = cell.begin; e < cell.end; ++e)
              parts(cell.cell->global_active_cell_index()) +=
                footprints.weight[e] * measures[footprints.point[e]] /
                cell.cell->measure();
        parts.compress(VectorOperation::add);
        parts.update_ghost_values();
        for (const auto &cell :
             discretization.dof_handler().active_cell_iterators())
          if (!cell->is_artificial())
            filling[layer][cell->active_cell_index()] =
              parts(cell->global_active_cell_index());
      }
  }

  template class PopulatedCells<2>;
  template class PopulatedCells<3>;
} // namespace impm
