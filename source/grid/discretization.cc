#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>

#include <impm/base/compat.h>
#include <impm/grid/discretization.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Lower corner of a cell of this extent, where the coarsest stand in rows
     * of so many. */
    template <int dim>
    std::array<int, dim>
    corner_on_lattice(const typename Triangulation<dim>::cell_iterator &cell,
                      const std::vector<unsigned int> &coarse_cells,
                      const int                        extent)
    {
      auto ancestor = cell; // p4est numbers them in an order of its own
      while (ancestor->level() > 0)
        ancestor = ancestor->parent();
      const auto           id    = cell->id();
      int                  place = ancestor->index();
      std::array<int, dim> corner;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const int n = coarse_cells[d];
          corner[d]   = place % n;
          place /= n;
          for (const auto child : id.get_child_indices())
            corner[d] = 2 * corner[d] + (child >> d & 1u);
          corner[d] *= extent;
        }
      return corner;
    }
  } // namespace

  template <int dim>
  NodeNumbering<dim>::NodeNumbering(
    const parallel::TriangulationBase<dim> &triangulation,
    const std::vector<unsigned int>        &coarse_cells,
    const unsigned int                      n_layers,
    const unsigned int                      epoch)
    : epoch(epoch)
    , n_layers(n_layers)
    , triangulation(triangulation)
    , dof_handler(triangulation)
    , any_hanging(triangulation.has_hanging_nodes())
  {
    dof_handler.distribute_dofs(FESystem<dim>(FE_Q<dim>(1), dim * n_layers));
    const IndexSet &owned = dof_handler.locally_owned_dofs();
    locally_relevant_dofs =
      DoFTools::extract_locally_relevant_dofs(dof_handler);
    hanging_nodes = compat::make_constraints(owned, locally_relevant_dofs);
    DoFTools::make_hanging_node_constraints(dof_handler, hanging_nodes);
    const MPI_Comm communicator = triangulation.get_communicator();
    if (any_hanging && Utilities::MPI::n_mpi_processes(communicator) > 1)
      {
        // A box may touch a ghost cell with a node that hangs on a cell which
        // this rank does not see.
        hanging_nodes.make_consistent_in_parallel(owned,
                                                  locally_relevant_dofs,
                                                  communicator);
        locally_relevant_dofs = hanging_nodes.get_local_lines();
        for (const auto &line : hanging_nodes.get_lines())
          for (const auto &entry : line.entries)
            locally_relevant_dofs.add_index(entry.first);
        auto known = compat::make_constraints(owned, locally_relevant_dofs);
        known.merge(hanging_nodes,
                    AffineConstraints<double>::no_conflicts_allowed,
                    true);
        hanging_nodes.copy_from(known);
      }
    hanging_nodes.close();
    partitioner =
      std::make_shared<Utilities::MPI::Partitioner>(owned,
                                                    locally_relevant_dofs,
                                                    communicator);
    if (any_hanging)
      masters.resize(locally_relevant_dofs.n_elements() / dim);
    // What holds of one component of a node holds of all.
    for (const auto &line : hanging_nodes.get_lines())
      {
        const unsigned int index = partitioner->global_to_local(line.index);
        if (index % dim != 0)
          continue;
        for (const auto &[master, weight] : line.entries)
          masters[index / dim].emplace_back(
            partitioner->global_to_local(master) / dim, weight);
        if (owned.is_element(line.index))
          hanging.push_back(index / dim);
      }

    int finest = 0;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        finest = std::max(finest, cell->level());
    finest = Utilities::MPI::max(finest, communicator);
    lattice.resize(owned.n_elements() / dim, {{}, 1 << finest, 0});
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const int  extent = 1 << (finest - cell->level());
          const auto corner =
            corner_on_lattice<dim>(cell, coarse_cells, extent);
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int layer = 0; layer < n_layers; ++layer)
              {
                const unsigned int node =
                  partitioner->global_to_local(
                    cell->vertex_dof_index(v, dim * layer)) /
                  dim;
                if (node >= lattice.size())
                  continue;
                lattice[node].layer  = layer;
                lattice[node].extent = std::min(lattice[node].extent, extent);
                for (unsigned int d = 0; d < dim; ++d)
                  lattice[node].place[d] = corner[d] + (v >> d & 1u) * extent;
              }
        }
  }

  template <int dim>
  Discretization<dim>::Discretization(
    std::shared_ptr<const NodeNumbering<dim>> numbering, const Vector &shift)
    : numbering(std::move(numbering))
    , communicator(this->numbering->triangulation.get_communicator())
    , smallest_cell_extent(std::numeric_limits<double>::max())
  {
    // Through a vector, for nodes that belong to no cell of this rank.
    Vector coordinates;
    initialize(coordinates);
    for (const auto &cell : dof_handler().active_cell_iterators())
      if (!cell->is_artificial())
        {
          for (unsigned int layer = 0; layer < this->numbering->n_layers;
               ++layer)
            {
              const auto nodes = nodes_of(cell, layer);
              for (const unsigned int v : cell->vertex_indices())
                for (unsigned int d = 0; d < dim; ++d)
                  coordinates.local_element(dim * nodes[v] + d) =
                    cell->vertex(v)[d];
            }
          if (cell->is_locally_owned())
            for (unsigned int d = 0; d < dim; ++d)
              smallest_cell_extent =
                std::min(smallest_cell_extent, cell_extent(cell, d));
        }
    smallest_cell_extent =
      Utilities::MPI::min(smallest_cell_extent, communicator);
    coordinates.zero_out_ghost_values();
    if (shift.size() > 0)
      coordinates += shift;
    coordinates.update_ghost_values();
    node_positions.resize((coordinates.locally_owned_size() +
                           coordinates.get_partitioner()->n_ghost_indices()) /
                          dim);
    for (unsigned int n = 0; n < node_positions.size(); ++n)
      for (unsigned int d = 0; d < dim; ++d)
        node_positions[n][d] = coordinates.local_element(dim * n + d);
  }

  template <int dim>
  void
  Discretization<dim>::interpolate_hanging(Vector &vector) const
  {
    vector.update_ghost_values();
    if (!numbering->any_hanging)
      return;
    for (const unsigned int node : numbering->hanging)
      for (unsigned int c = 0; c < dim; ++c)
        {
          double sum = 0;
          for (const auto &[master, weight] : numbering->masters[node])
            sum += weight * vector.local_element(dim * master + c);
          vector.local_element(dim * node + c) = sum;
        }
    vector.update_ghost_values();
  }

  template <int dim>
  void
  Discretization<dim>::condense_hanging(Vector &vector) const
  {
    vector.zero_out_ghost_values();
    if (!numbering->any_hanging)
      return;
    for (const unsigned int node : numbering->hanging)
      for (unsigned int c = 0; c < dim; ++c)
        {
          double &value = vector.local_element(dim * node + c);
          for (const auto &[master, weight] : numbering->masters[node])
            vector.local_element(dim * master + c) += weight * value;
          value = 0;
        }
    vector.compress(VectorOperation::add);
  }

  template struct NodeNumbering<2>;
  template struct NodeNumbering<3>;
  template class Discretization<2>;
  template class Discretization<3>;
} // namespace impm
