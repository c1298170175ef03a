#include <deal.II/grid/grid_tools.h>

#include <impm/balance/terms/isolated_cells.h>

#include <map>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /**
     * Numbers that cells of one piece share, by layer: the smallest of a cell
     * in it, plus one; zero without material.
     */
    template <int dim>
    std::vector<std::vector<double>>
    label_pieces(const PopulatedCells<dim> &populated,
                 const Discretization<dim> &discretization)
    {
      std::vector<std::vector<double>> label(populated.stiffness.size(),
                                             std::vector<double>(
                                               populated.stiffness[0].size()));
      const double                     n_cells =
        discretization.numbering->triangulation.n_global_active_cells();
      std::vector<typename Discretization<dim>::CellIterator> neighbors;
      for (const auto &cell : populated.cells)
        label[cell.layer][cell.cell->active_cell_index()] =
          1. + cell.layer * n_cells + cell.cell->global_active_cell_index();
      for (bool changed = true; changed;)
        {
          for (auto &of_layer : label)
            exchange_cell_data(discretization, of_layer);
          changed = false;
          for (const auto &cell : populated.cells)
            {
              auto   &of_layer = label[cell.layer];
              double &own      = of_layer[cell.cell->active_cell_index()];
              GridTools::get_active_neighbors<DoFHandler<dim>>(cell.cell,
                                                               neighbors);
              for (const auto &neighbor : neighbors)
                {
                  const double other = of_layer[neighbor->active_cell_index()];
                  if (other > 0 && other < own)
                    {
                      own     = other;
                      changed = true;
                    }
                }
            }
          changed =
            Utilities::MPI::max(changed ? 1 : 0, discretization.communicator);
        }
      return label;
    }
  } // namespace

  template <int dim>
  IsolatedCells<dim>::IsolatedCells(const MaterialPoints<dim>  &points,
                                    const Footprints<dim>      &footprints,
                                    const PopulatedCells<dim>  &populated,
                                    const Discretization<dim>  &discretization,
                                    const StepConstraints<dim> &constraints,
                                    const double                factor)
  {
    const auto label = label_pieces(populated, discretization);

    // Directions, as bits, in which something holds a piece; the hoop strain
    // does along the radius.
    std::map<double, unsigned int> held;
    for (const auto &cell : populated.cells)
      {
        unsigned int &bits =
          held[label[cell.layer][cell.cell->active_cell_index()]];
        if (points.layout.geometry == GeometryKind::axisymmetric)
          bits |= 1u;
        for (const unsigned int node : cell.nodes)
          for (unsigned int d = 0; d < dim; ++d)
            if (constraints.carrier[dim * node + d] != constraints.no_carrier)
              bits |= 1u << d;
      }
    for (const auto &others :
         Utilities::MPI::all_gather(discretization.communicator, held))
      for (const auto &[piece, bits] : others)
        held[piece] |= bits;

    const auto is_isolated = [&](const auto &cell) {
      const unsigned int layer = discretization.layer(cell.nodes[0]);
      return held.at(label[layer][cell.cell->active_cell_index()]) !=
             (1u << dim) - 1;
    };
    for (const auto &cell : populated.cells)
      n += is_isolated(cell);
    n = Utilities::MPI::sum(n, discretization.communicator);
    discretization.initialize(stiffness);
    for (const auto &cell : footprints.cells)
      if (is_isolated(cell))
        {
          double sum = 0;
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            sum += factor * footprints.weight[e] *
                   points.initial_volume(footprints.point[e]) *
                   points.remaining_stiffness(footprints.point[e]) /
                   (cell.extent * cell.extent);
          for (const unsigned int node : cell.nodes)
            for (unsigned int c = 0; c < dim; ++c)
              stiffness.local_element(dim * node + c) += sum;
        }
    stiffness.compress(VectorOperation::add);
    discretization.condense_hanging(stiffness);
  }

  template struct IsolatedCells<2>;
  template struct IsolatedCells<3>;
} // namespace impm
