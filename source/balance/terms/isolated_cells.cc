#include <deal.II/grid/grid_tools.h>

#include <impm/balance/terms/isolated_cells.h>

#include <cmath>

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
    : discretization(discretization)
  {
    const auto label = label_pieces(populated, discretization);

    // Directions, as bits, in which something holds a piece; the hoop strain
    // does along the radius.
    std::map<double, unsigned int> bits_of;
    for (const auto &cell : populated.cells)
      {
        unsigned int &bits =
          bits_of[label[cell.layer][cell.cell->active_cell_index()]];
        if (points.layout.geometry == GeometryKind::axisymmetric)
          bits |= 1u;
        for (const unsigned int node : cell.nodes)
          for (unsigned int d = 0; d < dim; ++d)
            if (constraints.carrier[dim * node + d] != constraints.no_carrier)
              bits |= 1u << d;
      }
    for (const auto &others :
         Utilities::MPI::all_gather(discretization.communicator, bits_of))
      for (const auto &[piece, bits] : others)
        bits_of[piece] |= bits;
    std::map<double, unsigned int> number_of;
    for (const auto &[piece, bits] : bits_of)
      {
        number_of[piece] = held.size();
        held.push_back(bits);
      }

    const unsigned int all      = (1u << dim) - 1;
    const auto         piece_at = [&](const auto &cell) {
      const unsigned int layer = discretization.layer(cell.nodes[0]);
      return number_of.at(label[layer][cell.cell->active_cell_index()]);
    };
    for (const auto &cell : populated.cells)
      n += held[piece_at(cell)] != all;
    n = Utilities::MPI::sum(n, discretization.communicator);
    discretization.initialize(stiffness);
    for (const auto &cell : footprints.cells)
      if (const unsigned int piece = piece_at(cell); held[piece] != all)
        {
          double sum = 0;
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            sum += factor * footprints.weight[e] *
                   points.initial_volume(footprints.point[e]) *
                   points.remaining_stiffness(footprints.point[e]) /
                   (cell.extent * cell.extent);
          for (const unsigned int node : cell.nodes)
            {
              for (unsigned int c = 0; c < dim; ++c)
                if ((held[piece] >> c & 1u) == 0)
                  stiffness.local_element(dim * node + c) += sum;
              if (dim * node < stiffness.locally_owned_size())
                piece_of_node[node] = piece;
            }
        }
    stiffness.compress(VectorOperation::add);
    discretization.condense_hanging(stiffness);
  }

  template <int dim>
  double
  IsolatedCells<dim>::resultants(const Vector &forces) const
  {
    // Of each piece: nodes, sums of places, of forces, of squares of places and
    // of moments.
    constexpr unsigned int n_sums = 2 + 2 * dim + 3;
    std::vector<double>    sums(n_sums * held.size());
    const auto             add_up = [&](const auto &add) {
      for (const auto &[node, piece] : piece_of_node)
        {
          const auto    &x = discretization.node_positions[node];
          Tensor<1, dim> force;
          for (unsigned int c = 0; c < dim; ++c)
            force[c] = forces.local_element(dim * node + c);
          add(&sums[n_sums * piece], x, force);
        }
      Utilities::MPI::sum(sums, discretization.communicator, sums);
    };
    add_up([](double *sum, const Point<dim> &x, const Tensor<1, dim> &force) {
      sum[0] += 1;
      for (unsigned int c = 0; c < dim; ++c)
        {
          sum[2 + c] += x[c];
          sum[2 + dim + c] += force[c];
        }
    });
    const auto first = sums;
    std::fill(sums.begin(), sums.end(), 0.);
    add_up([&](double *sum, const Point<dim> &x, const Tensor<1, dim> &force) {
      const double *of_piece = &first[sum - sums.data()];
      Tensor<1, 3>  r, f;
      for (unsigned int c = 0; c < dim; ++c)
        {
          r[c] = x[c] - of_piece[2 + c] / of_piece[0];
          f[c] = force[c];
        }
      sum[1] += r.norm_square();
      const auto moment = cross_product_3d(r, f);
      for (unsigned int c = 0; c < 3; ++c)
        sum[2 + 2 * dim + c] += moment[c];
    });

    double all = 0;
    for (unsigned int piece = 0; piece < held.size(); ++piece)
      {
        const double *one = &first[n_sums * piece],
                     *two = &sums[n_sums * piece];
        if (one[0] == 0)
          continue;
        double resultant = 0;
        for (unsigned int c = 0; c < dim; ++c)
          resultant += one[2 + dim + c] * one[2 + dim + c];
        all += std::sqrt(resultant);
        for (unsigned int axis = 0; axis < 3; ++axis)
          if ((held[piece] & ~(1u << axis)) == 0 && (dim == 3 || axis == 2) &&
              two[1] > 0)
            all +=
              std::abs(two[2 + 2 * dim + axis]) / std::sqrt(two[1] / one[0]);
      }
    return all;
  }

  template class IsolatedCells<2>;
  template class IsolatedCells<3>;
} // namespace impm
