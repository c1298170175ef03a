#include <deal.II/grid/grid_tools.h>

#include <impm/balance/terms/isolated_cells.h>

#include <map>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /**
     * Numbers that cells of one piece share: the smallest of a cell in it,
     * plus one; zero without material.
     */
    template <int dim>
    std::vector<double>
    label_pieces(const PopulatedCells<dim> &populated,
                 const Discretization<dim> &discretization)
    {
      std::vector<double> label(populated.stiffness.size());
      std::vector<typename Discretization<dim>::CellIterator> neighbors;
      for (const auto &cell : populated.cells)
        label[cell.cell->active_cell_index()] =
          1. + cell.cell->global_active_cell_index();
      for (bool changed = true; changed;)
        {
          exchange_cell_data(discretization, label);
          changed = false;
          for (bool again = true; again; changed = changed || again)
            {
              again = false;
              for (const auto &cell : populated.cells)
                {
                  double &own = label[cell.cell->active_cell_index()];
                  GridTools::get_active_neighbors<DoFHandler<dim>>(cell.cell,
                                                                   neighbors);
                  for (const auto &neighbor : neighbors)
                    {
                      const double other = label[neighbor->active_cell_index()];
                      if (other > 0 && other < own)
                        {
                          own   = other;
                          again = true;
                        }
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
  std::vector<char>
  find_isolated_cells(const PopulatedCells<dim>  &populated,
                      const Discretization<dim>  &discretization,
                      const StepConstraints<dim> &constraints,
                      const bool                  axisymmetric)
  {
    const auto label = label_pieces(populated, discretization);

    // Directions, as bits, in which something holds a piece; the hoop strain
    // does along the radius.
    std::map<double, unsigned int> held;
    for (const auto &cell : populated.cells)
      {
        unsigned int &bits = held[label[cell.cell->active_cell_index()]];
        if (axisymmetric)
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

    std::vector<char> isolated(label.size());
    for (unsigned int i = 0; i < label.size(); ++i)
      {
        const auto piece = held.find(label[i]);
        isolated[i] = piece != held.end() && piece->second != (1u << dim) - 1;
      }
    return isolated;
  }

  template std::vector<char>
  find_isolated_cells(const PopulatedCells<2> &,
                      const Discretization<2> &,
                      const StepConstraints<2> &,
                      bool);
  template std::vector<char>
  find_isolated_cells(const PopulatedCells<3> &,
                      const Discretization<3> &,
                      const StepConstraints<3> &,
                      bool);
} // namespace impm
