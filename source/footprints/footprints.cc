#include <impm/footprints/footprints.h>

#include <numeric>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  Footprints<dim>::box_shape(const Piece &piece,
                             double      *values,
                             double      *gradients)
  {
    std::array<double, dim> extents;
    for (unsigned int d = 0; d < dim; ++d)
      extents[d] = cell_extent(piece.cell, d);
    for (unsigned int v = 0; v < n_nodes; ++v)
      {
        double                  value = piece.weight;
        std::array<double, dim> factor;
        for (unsigned int d = 0; d < dim; ++d)
          {
            factor[d] =
              (v >> d & 1u) ? piece.centroid[d] : 1 - piece.centroid[d];
            value *= factor[d];
          }
        values[v] = value;
        for (unsigned int d = 0; d < dim; ++d)
          {
            double slope = piece.weight * ((v >> d & 1u) ? 1 : -1) / extents[d];
            for (unsigned int e = 0; e < dim; ++e)
              if (e != d)
                slope *= factor[e];
            gradients[v * dim + d] = slope;
          }
      }
  }

  template <int dim>
  void
  Footprints<dim>::mapped_shape(const Piece               &piece,
                                const Discretization<dim> &discretization,
                                double                    *values,
                                double                    *gradients)
  {
    const auto    &positions = discretization.node_positions;
    const auto     nodes     = discretization.nodes_of(piece.cell);
    Tensor<2, dim> jacobian; // d x_i / d xi_j
    std::array<Tensor<1, dim>, n_nodes> slopes;
    for (unsigned int v = 0; v < n_nodes; ++v)
      {
        values[v] =
          piece.weight *
          GeometryInfo<dim>::d_linear_shape_function(piece.centroid, v);
        slopes[v] =
          GeometryInfo<dim>::d_linear_shape_function_gradient(piece.centroid,
                                                              v);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            jacobian[i][j] += positions[nodes[v]][i] * slopes[v][j];
      }
    const auto inverse = transpose(invert(jacobian));
    for (unsigned int v = 0; v < n_nodes; ++v)
      {
        const auto slope = inverse * slopes[v];
        for (unsigned int d = 0; d < dim; ++d)
          gradients[v * dim + d] = piece.weight * slope[d];
      }
  }

  template <int dim>
  void
  Footprints<dim>::build(const std::vector<Piece>  &pieces,
                         const unsigned int         n_points,
                         const Discretization<dim> &discretization,
                         const Shape               &shape)
  {
    this->n_points                = n_points;
    const unsigned int n          = pieces.size();
    const unsigned int no_slot    = numbers::invalid_unsigned_int;
    const auto         slot_place = [&](const CellIterator &cell) -> auto &
    {
      return slot_of_cell[cell->active_cell_index()];
    };

    // Cells in the order in which they appear, and how many entries each has.
    slot_of_cell.resize(discretization.triangulation().n_active_cells(),
                        no_slot);
    cells.clear();
    cell_of_entry.resize(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const auto   &cell = pieces[i].cell;
        unsigned int &slot = slot_place(cell);
        if (slot == no_slot)
          {
            slot          = cells.size();
            double extent = cell_extent(cell, 0);
            for (unsigned int d = 1; d < dim; ++d)
              extent = std::min(extent, cell_extent(cell, d));
            cells.push_back(
              {cell, discretization.nodes_of(cell), 0, 0, extent});
          }
        ++cells[slot].end;
      }
    unsigned int sum = 0;
    for (auto &cell : cells)
      {
        cell.begin = sum;
        sum += cell.end;
        cell.end = cell.begin;
      }

    point.resize(n);
    weight.resize(n);
    values.resize(n * n_nodes);
    gradients.resize(n * n_nodes * dim);
    first.assign(n_points + 1, 0);
    for (const auto &piece : pieces)
      {
        const unsigned int slot = slot_place(piece.cell);
        const unsigned int e    = cells[slot].end++;
        cell_of_entry[e]        = slot;
        point[e]                = piece.point;
        weight[e]               = piece.weight;
        shape(piece, &values[e * n_nodes], &gradients[e * n_nodes * dim]);
        ++first[piece.point + 1];
      }
    for (const auto &cell : cells)
      slot_place(cell.cell) = no_slot;

    one_entry_each =
      n == n_points && std::all_of(first.begin() + 1,
                                   first.end(),
                                   [](const unsigned int k) { return k == 1; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    entries.resize(n);
    order.assign(first.begin(), first.end());
    for (unsigned int e = 0; e < n; ++e)
      entries[order[point[e]]++] = e;
  }

  template <int dim>
  void
  Footprints<dim>::release_massless_nodes(
    const Discretization<dim> &discretization)
  {
    // The node is across in a direction if it has no share, and its neighbour
    // in that direction has one.
    const double tiny      = 1e-13;
    const auto   is_across = [&](const unsigned int e, const unsigned int d) {
      for (unsigned int side = 0; side < 2; ++side)
        {
          double sum = 0;
          for (unsigned int v = 0; v < n_nodes; ++v)
            if ((v >> d & 1u) == side)
              sum += value(e)[v];
          if (sum <= tiny * weight[e])
            return static_cast<int>(side);
        }
      return -1;
    };
    std::vector<std::pair<unsigned int, unsigned int>> on_faces;
    for (unsigned int e = 0; e < n_entries(); ++e)
      for (unsigned int d = 0; d < dim; ++d)
        if (is_across(e, d) >= 0)
          on_faces.emplace_back(e, d);
    const MPI_Comm communicator = discretization.communicator;
    if (Utilities::MPI::max(on_faces.size(), communicator) == 0)
      return;

    Vector shares;
    discretization.initialize(shares);
    for (const auto &cell : cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int v = 0; v < n_nodes; ++v)
          shares.local_element(dim * cell.nodes[v]) += value(e)[v];
    shares.compress(VectorOperation::add);
    discretization.condense_hanging(shares);
    discretization.interpolate_hanging(shares);
    for (const auto &[e, d] : on_faces)
      {
        const auto  side      = static_cast<unsigned int>(is_across(e, d));
        const auto &nodes     = cells[cell_of_entry[e]].nodes;
        double      elsewhere = 0;
        for (unsigned int v = 0; v < n_nodes; ++v)
          if ((v >> d & 1u) == side)
            elsewhere += shares.local_element(dim * nodes[v]);
        if (elsewhere > tiny)
          continue;
        for (unsigned int v = 0; v < n_nodes; ++v)
          {
            gradients[(e * n_nodes + v) * dim + d] = 0;
            if ((v >> d & 1u) != side)
              continue;
            values[e * n_nodes + v] = 0;
            for (unsigned int c = 0; c < dim; ++c)
              gradients[(e * n_nodes + v) * dim + c] = 0;
          }
      }
  }

  template <int dim>
  void
  Footprints<dim>::make_patches(const std::vector<unsigned int> &coupled)
  {
    patches.clear();
    patch_points.resize(n_points);
    std::iota(patch_points.begin(), patch_points.end(), 0);
    patch_nodes.clear();
    place.resize(n_entries() * n_nodes);

    const auto is_coupled = [&](const unsigned int p) {
      return !coupled.empty() && coupled[p] != numbers::invalid_unsigned_int;
    };
    // Less than, and equal, by the cells of the points.
    const auto compare = [&](const unsigned int p, const unsigned int q) {
      if (is_coupled(p) || is_coupled(q))
        return is_coupled(p) && is_coupled(q) ?
                 (coupled[p] > coupled[q]) - (coupled[p] < coupled[q]) :
                 is_coupled(p) - is_coupled(q);
      for (unsigned int i = first[p], j = first[q];; ++i, ++j)
        {
          if (i == first[p + 1] || j == first[q + 1])
            return (i != first[p + 1]) - (j != first[q + 1]);
          const unsigned int a = cell_of_entry[entries[i]],
                             b = cell_of_entry[entries[j]];
          if (a != b)
            return (a > b) - (a < b);
        }
    };
    if (!one_entry_each || !coupled.empty())
      std::sort(patch_points.begin(),
                patch_points.end(),
                [&](const unsigned int p, const unsigned int q) {
                  const int order = compare(p, q);
                  return order != 0 ? order < 0 : p < q;
                });

    for (unsigned int i = 0; i < n_points;)
      {
        Patch patch;
        patch.begin_points = i;
        patch.begin_nodes  = patch_nodes.size();
        for (; i < n_points && (i == patch.begin_points ||
                                compare(patch_points[patch.begin_points],
                                        patch_points[i]) == 0);
             ++i)
          {
            const unsigned int p = patch_points[i];
            for (unsigned int k = first[p]; k < first[p + 1]; ++k)
              {
                const unsigned int e     = entries[k];
                const auto        &nodes = cells[cell_of_entry[e]].nodes;
                for (unsigned int v = 0; v < n_nodes; ++v)
                  {
                    const auto begin = patch_nodes.begin() + patch.begin_nodes;
                    const auto found =
                      std::find(begin, patch_nodes.end(), nodes[v]);
                    place[e * n_nodes + v] = found - begin;
                    if (found == patch_nodes.end())
                      patch_nodes.push_back(nodes[v]);
                  }
              }
          }
        patch.end_points = i;
        patch.end_nodes  = patch_nodes.size();
        patches.push_back(patch);
      }
  }

  template <int dim>
  void
  Footprints<dim>::interpolate(const Vector                &field,
                               std::vector<Tensor<1, dim>> &at_points) const
  {
    at_points.assign(n_points, Tensor<1, dim>());
    for (const auto &cell : cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int n = 0; n < n_nodes; ++n)
          for (unsigned int d = 0; d < dim; ++d)
            at_points[point[e]][d] +=
              value(e)[n] * field.local_element(dim * cell.nodes[n] + d);
  }

  template <int dim>
  void
  Footprints<dim>::spread(const std::vector<Tensor<1, dim>> &at_points,
                          Vector                            &field) const
  {
    for (const auto &cell : cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int n = 0; n < n_nodes; ++n)
          for (unsigned int d = 0; d < dim; ++d)
            field.local_element(dim * cell.nodes[n] + d) +=
              value(e)[n] * at_points[point[e]][d];
  }

  template class Footprints<2>;
  template class Footprints<3>;
} // namespace impm
