#include <impm/footprints/footprints.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Writes the shape functions of an axis-aligned cell, times the weight of
     * a piece. */
    template <int dim>
    void
    box_shape(const typename Footprints<dim>::Piece &piece,
              double                                *values,
              double                                *gradients)
    {
      std::array<double, dim> extents;
      for (unsigned int d = 0; d < dim; ++d)
        extents[d] = cell_extent(piece.cell, d);
      for (unsigned int v = 0; v < Footprints<dim>::n_nodes; ++v)
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
              double slope =
                piece.weight * ((v >> d & 1u) ? 1 : -1) / extents[d];
              for (unsigned int e = 0; e < dim; ++e)
                if (e != d)
                  slope *= factor[e];
              gradients[v * dim + d] = slope;
            }
        }
    }

    /** The same of a cell with any corners. */
    template <int dim>
    void
    mapped_shape(const typename Footprints<dim>::Piece &piece,
                 const Discretization<dim>             &discretization,
                 double                                *values,
                 double                                *gradients)
    {
      using Info       = GeometryInfo<dim>;
      const auto nodes = discretization.nodes_of(piece.cell, piece.layer);
      constexpr unsigned int        n = Footprints<dim>::n_nodes;
      std::array<Tensor<1, dim>, n> slopes;
      Tensor<2, dim>                jacobian; // d x_i / d xi_j
      for (unsigned int v = 0; v < n; ++v)
        {
          values[v] =
            piece.weight * Info::d_linear_shape_function(piece.centroid, v);
          slopes[v] = Info::d_linear_shape_function_gradient(piece.centroid, v);
          jacobian +=
            outer_product(discretization.node_positions[nodes[v]], slopes[v]);
        }
      const auto inverse = transpose(invert(jacobian));
      for (unsigned int v = 0; v < n; ++v)
        {
          const auto slope = piece.weight * (inverse * slopes[v]);
          std::copy_n(slope.begin_raw(), dim, gradients + v * dim);
        }
    }
  } // namespace

  template <int dim>
  void
  Footprints<dim>::build(const std::vector<Piece>  &pieces,
                         const unsigned int         n_points,
                         const Discretization<dim> &discretization,
                         const bool                 any_corners)
  {
    const unsigned int        n        = pieces.size();
    const unsigned int        no_slot  = numbers::invalid_unsigned_int;
    const unsigned int        n_layers = discretization.numbering->n_layers;
    std::vector<unsigned int> slots(
      n_layers * discretization.numbering->triangulation.n_active_cells(),
      no_slot);
    const auto slot_of = [&](const Piece &piece) -> unsigned int & {
      return slots[n_layers * piece.cell->active_cell_index() + piece.layer];
    };

    // Cells in the order in which they appear, and how many entries each has.
    for (const auto &piece : pieces)
      {
        const auto   &cell = piece.cell;
        unsigned int &slot = slot_of(piece);
        if (slot == no_slot)
          {
            slot          = cells.size();
            double extent = cell_extent(cell, 0);
            for (unsigned int d = 1; d < dim; ++d)
              extent = std::min(extent, cell_extent(cell, d));
            cells.push_back(
              {cell, discretization.nodes_of(cell, piece.layer), 0, 0, extent});
          }
        ++cells[slot].end;
      }
    cells.shrink_to_fit();
    unsigned int sum = 0;
    for (auto &cell : cells)
      {
        cell.begin = sum;
        sum += cell.end;
        cell.end = cell.begin;
      }

    point.resize(n);
    weight.resize(n);
    cell_of_entry.resize(n);
    values.resize(n * n_nodes);
    gradients.resize(n * n_nodes * dim);
    first.assign(n_points + 1, 0);
    for (const auto &piece : pieces)
      {
        const unsigned int slot = slot_of(piece);
        const unsigned int e    = cells[slot].end++;
        cell_of_entry[e]        = slot;
        point[e]                = piece.point;
        weight[e]               = piece.weight;
        double *value           = &values[e * n_nodes];
        double *gradient        = &gradients[e * n_nodes * dim];
        if (any_corners)
          mapped_shape(piece, discretization, value, gradient);
        else
          box_shape<dim>(piece, value, gradient);
        ++first[piece.point + 1];
      }
    std::partial_sum(first.begin(), first.end(), first.begin());
    entries.resize(n);
    auto next = first;
    for (unsigned int e = 0; e < n; ++e)
      entries[next[point[e]]++] = e;
  }

  template <int dim>
  void
  Footprints<dim>::release_massless_nodes(
    const Discretization<dim> &discretization)
  {
    // The node is across in a direction if it has no share, and its neighbour
    // in that direction has one.
    const double tiny = 1e-13;
    // Entry, direction, side.
    std::vector<std::array<unsigned int, 3>> across;
    for (unsigned int e = 0; e < point.size(); ++e)
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int side = 0; side < 2; ++side)
          {
            double sum = 0;
            for (unsigned int v = 0; v < n_nodes; ++v)
              if ((v >> d & 1u) == side)
                sum += value(e)[v];
            if (sum <= tiny * weight[e])
              across.push_back({{e, d, side}});
          }
    if (Utilities::MPI::max(across.size(), discretization.communicator) == 0)
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
    for (const auto &[e, d, side] : across)
      {
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
  unsigned int
  Footprints<dim>::nearest_node(const unsigned int p) const
  {
    unsigned int node    = numbers::invalid_unsigned_int;
    double       largest = 0;
    for (unsigned int k = first[p]; k < first[p + 1]; ++k)
      for (unsigned int v = 0; v < n_nodes; ++v)
        {
          const unsigned int here  = cells[cell_of_entry[entries[k]]].nodes[v];
          double             share = 0;
          for (unsigned int l = first[p]; l < first[p + 1]; ++l)
            {
              const auto &nodes = cells[cell_of_entry[entries[l]]].nodes;
              for (unsigned int w = 0; w < n_nodes; ++w)
                if (nodes[w] == here)
                  share += value(entries[l])[w];
            }
          if (share > largest * (1 + 1e-12))
            {
              largest = share;
              node    = here;
            }
        }
    for (unsigned int k = first[p]; k < first[p + 1]; ++k)
      {
        const auto &nodes = cells[cell_of_entry[entries[k]]].nodes;
        if (std::find(nodes.begin(), nodes.end(), node) == nodes.end())
          return numbers::invalid_unsigned_int;
      }
    return node;
  }

  template <int dim>
  void
  Footprints<dim>::make_patches(const std::vector<unsigned int> &coupled)
  {
    const unsigned int n_points = first.size() - 1;
    patch_points.resize(n_points);
    std::iota(patch_points.begin(), patch_points.end(), 0);
    place.resize(point.size() * n_nodes);

    // A box without a group goes to the node next to its middle, where it
    // touches cells around this one only: the points around a node make one
    // block.
    std::vector<unsigned int> nearest(n_points, numbers::invalid_unsigned_int);
    if (point.size() != n_points)
      for (unsigned int p = 0; p < n_points; ++p)
        nearest[p] = nearest_node(p);

    // Zero if nothing couples a point: the invalid number overflows.
    const auto group = [&](const unsigned int p) {
      return coupled.empty() ? 0 : coupled[p] + 1;
    };
    // Less than, and equal, by group, else by node, else by cells.
    const auto compare = [&](const unsigned int p, const unsigned int q) {
      if (group(p) != group(q))
        return group(p) < group(q) ? -1 : 1;
      if (group(p) > 0)
        return 0;
      if (nearest[p] != nearest[q])
        return nearest[p] < nearest[q] ? -1 : 1;
      if (nearest[p] != numbers::invalid_unsigned_int)
        return 0;
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
    // Points of one entry each come sorted by cell.
    if (point.size() != n_points || !coupled.empty())
      std::stable_sort(patch_points.begin(),
                       patch_points.end(),
                       [&](const unsigned int p, const unsigned int q) {
                         return compare(p, q) < 0;
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
    patches.shrink_to_fit();
    patch_nodes.shrink_to_fit();
  }

  template <int dim>
  typename Footprints<dim>::Tensors
  Footprints<dim>::deformations(const Vector &u) const
  {
    Tensors result(first.size() - 1,
                   Tensor<2, dim>(unit_symmetric_tensor<dim>()));
    for (const auto &cell : cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int n = 0; n < n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              result[point[e]][c][d] +=
                u.local_element(dim * cell.nodes[n] + c) *
                gradient(e)[n * dim + d];
    return result;
  }

  template <int dim>
  void
  Footprints<dim>::move(const Vector &displacement)
  {
    if (!inverse_radius.empty())
      {
        std::vector<Tensor<1, dim>> at_points;
        interpolate(displacement, at_points);
        for (unsigned int p = 0; p < at_points.size(); ++p)
          inverse_radius[p] = 1 / (1 / inverse_radius[p] + at_points[p][0]);
      }
    moved    = true;
    moved_by = deformations(displacement);
    for (unsigned int e = 0; e < point.size(); ++e)
      {
        const auto inverse = transpose(invert(moved_by[point[e]]));
        for (unsigned int n = 0; n < n_nodes; ++n)
          {
            double        *slope = &gradients[(e * n_nodes + n) * dim];
            Tensor<1, dim> old;
            std::copy_n(slope, dim, old.begin_raw());
            const auto now = inverse * old;
            std::copy_n(now.begin_raw(), dim, slope);
          }
      }
  }

  template <int dim>
  double
  Footprints<dim>::largest_distortion(const Vector &increment) const
  {
    double        largest = 0;
    const Tensors step    = deformations(increment);
    for (unsigned int p = 0; p < step.size(); ++p)
      {
        const auto A = moved ? step[p] * moved_by[p] : step[p];
        for (const double square : eigenvalues(symmetrize(transpose(A) * A)))
          largest = std::max(largest, std::abs(std::log(square)) / 2);
      }
    return largest;
  }

  template <int dim>
  void
  Footprints<dim>::interpolate(const Vector                &field,
                               std::vector<Tensor<1, dim>> &at_points) const
  {
    at_points.assign(first.size() - 1, Tensor<1, dim>());
    for (const auto &cell : cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int n = 0; n < n_nodes; ++n)
          for (unsigned int d = 0; d < dim; ++d)
            at_points[point[e]][d] +=
              value(e)[n] * field.local_element(dim * cell.nodes[n] + d);
  }

  template <int dim>
  void
  Footprints<dim>::move_points(const Vector                &increment,
                               std::vector<Tensor<1, dim>> &of_points) const
  {
    interpolate(increment, of_points);
    if (!middles)
      return;
    std::vector<Tensor<1, dim>> of_middles;
    middles->interpolate(increment, of_middles);
    for (unsigned int p = 0; p < of_points.size(); ++p)
      if (middles->first[p + 1] > middles->first[p])
        of_points[p] = of_middles[p];
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
