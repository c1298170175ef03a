#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/grid/grid_tools.h>

#include <impm/balance/terms/ghost_penalty.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using CellIterator = typename Discretization<dim>::CellIterator;

    /** Whether this rank, coming from this cell, works on the face. */
    template <int dim>
    bool
    works_on(const CellIterator<dim> &cell, const unsigned int f)
    {
      const auto neighbor = cell->neighbor(f);
      if (neighbor->has_children())
        return false;
      if (cell->neighbor_is_coarser(f))
        return true;
      if (neighbor->is_locally_owned())
        return cell->active_cell_index() < neighbor->active_cell_index();
      return cell->subdomain_id() < neighbor->subdomain_id();
    }
  } // namespace

  template <int dim>
  GhostPenalty<dim>::GhostPenalty(const PopulatedCells<dim> &populated_cells,
                                  const Mapping<dim>        &mapping,
                                  const Discretization<dim> &discretization,
                                  const GeometryKind         geometry,
                                  const double               gamma)
  {
    std::vector<std::vector<double>> at_edge(
      populated_cells.stiffness.size(),
      std::vector<double>(populated_cells.stiffness[0].size()));
    std::vector<CellIterator<dim>> adjacent;
    for (const auto &[cell, layer, nodes] : populated_cells.cells)
      {
        GridTools::get_active_neighbors<DoFHandler<dim>>(cell, adjacent);
        for (const auto &neighbor : adjacent)
          if (populated_cells.stiffness[layer][neighbor->active_cell_index()] ==
              0)
            at_edge[layer][cell->active_cell_index()] = 1;
      }
    for (auto &of_layer : at_edge)
      exchange_cell_data(discretization, of_layer);

    const FE_Q<dim>       fe(1);
    const QGauss<dim - 1> quadrature(2); // n_quadrature points
    const UpdateFlags     flags = update_gradients | update_normal_vectors |
                              update_quadrature_points | update_JxW_values;
    FEFaceValues<dim>      here(mapping, fe, quadrature, flags);
    FEFaceValues<dim>      there(mapping, fe, quadrature, flags);
    FESubfaceValues<dim>   there_coarser(mapping, fe, quadrature, flags);
    constexpr unsigned int half = max_nodes / 2;
    const bool axisymmetric     = geometry == GeometryKind::axisymmetric;

    for (const auto &populated : populated_cells.cells)
      for (const unsigned int f : populated.cell->face_indices())
        {
          const auto &cell       = populated.cell;
          const auto &stiffness  = populated_cells.stiffness[populated.layer];
          const auto &is_at_edge = at_edge[populated.layer];
          if (cell->at_boundary(f) || !works_on<dim>(cell, f))
            continue;
          const CellIterator<dim> neighbor(cell->neighbor(f));
          const unsigned int      i = cell->active_cell_index(),
                             j      = neighbor->active_cell_index();
          if (stiffness[j] == 0 || (is_at_edge[i] == 0 && is_at_edge[j] == 0))
            continue;

          const typename Triangulation<dim>::active_cell_iterator tria_cell(
            cell),
            tria_neighbor(neighbor);
          here.reinit(tria_cell, f);
          const FEValuesBase<dim> *other = &there;
          if (cell->neighbor_is_coarser(f))
            {
              const auto [face, subface] =
                cell->neighbor_of_coarser_neighbor(f);
              there_coarser.reinit(tria_neighbor, face, subface);
              other = &there_coarser;
            }
          else
            there.reinit(tria_neighbor, cell->neighbor_of_neighbor(f));

          // Where the shape functions of both cells stand among the nodes of
          // the face, which share some.
          Face                                face;
          std::array<unsigned int, max_nodes> place;
          const auto                          neighbors =
            discretization.nodes_of(neighbor, populated.layer);
          for (unsigned int v = 0; v < max_nodes; ++v)
            {
              const unsigned int node =
                v < half ? populated.nodes[v] : neighbors[v - half];
              const auto end = face.nodes.begin() + face.n_nodes;
              place[v] =
                std::find(face.nodes.begin(), end, node) - face.nodes.begin();
              if (place[v] == face.n_nodes)
                face.nodes[face.n_nodes++] = node;
            }
          const double weight = gamma * std::min(stiffness[i], stiffness[j]) *
                                cell_extent(cell, f / 2);
          for (const unsigned int q : here.quadrature_point_indices())
            {
              const double around =
                axisymmetric ? 2 * numbers::PI * here.quadrature_point(q)[0] :
                               1.;
              const double factor = std::sqrt(weight * around * here.JxW(q));
              for (unsigned int v = 0; v < half; ++v)
                {
                  face.jumps[q][place[v]] +=
                    factor * (here.shape_grad(v, q) * here.normal_vector(q));
                  face.jumps[q][place[half + v]] -=
                    factor * (other->shape_grad(v, q) * here.normal_vector(q));
                }
            }
          faces.push_back(face);
        }
    faces.shrink_to_fit(); // they are large
  }

  template <int dim>
  void
  GhostPenalty<dim>::apply(const Vector &u, Vector &image) const
  {
    for (const auto &face : faces)
      for (unsigned int c = 0; c < dim; ++c)
        for (const auto &jump : face.jumps)
          {
            const double value = face.jump_of(u, c, jump);
            for (unsigned int a = 0; a < face.n_nodes; ++a)
              image.local_element(dim * face.nodes[a] + c) += jump[a] * value;
          }
  }

  template <int dim>
  double
  GhostPenalty<dim>::energy(const Vector &u, const Vector & /*felt*/) const
  {
    double sum = 0;
    for (const auto &face : faces)
      for (unsigned int c = 0; c < dim; ++c)
        for (const auto &jump : face.jumps)
          {
            const double value = face.jump_of(u, c, jump);
            sum += 0.5 * value * value;
          }
    return sum;
  }

  template <int dim>
  void
  GhostPenalty<dim>::add_matrix(const bool       only_pattern,
                                const TakeBlock &take) const
  {
    FullMatrix<double> block;
    for (const auto &face : faces)
      {
        const unsigned int n = face.n_nodes;
        if (!only_pattern)
          {
            block.reinit(dim * n, dim * n);
            for (unsigned int a = 0; a < n; ++a)
              for (unsigned int b = 0; b < n; ++b)
                if (const double value = face.matrix(a, b); value != 0)
                  for (unsigned int c = 0; c < dim; ++c)
                    block(dim * a + c, dim * b + c) = value;
          }
        take(make_array_view(face.nodes.begin(), face.nodes.begin() + n),
             block);
      }
  }

  template class GhostPenalty<2>;
  template class GhostPenalty<3>;
} // namespace impm
