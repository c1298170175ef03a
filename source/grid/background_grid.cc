#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <impm/grid/background_grid.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** How often all the numbers can be halved. */
    template <std::size_t n>
    unsigned int
    common_halvings(std::array<unsigned int, n> numbers)
    {
      unsigned int halvings = 0;
      while (std::all_of(numbers.begin(), numbers.end(), [](unsigned int k) {
        return k % 2 == 0;
      }))
        {
          for (auto &k : numbers)
            k /= 2;
          ++halvings;
        }
      return halvings;
    }

    template <int dim>
    std::unique_ptr<const Mapping<dim>>
    make_mapping(const bool any_quadrilaterals)
    {
      // Particles on faces are lost with any mapping but the Cartesian one.
      if (any_quadrilaterals)
        return std::make_unique<MappingQ<dim>>(1);
      return std::make_unique<MappingCartesian<dim>>();
    }
  } // namespace

  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridSpec<dim> &spec,
                                      const MPI_Comm       communicator)
    : communicator(communicator)
    , triangulation(communicator)
    , is_lagrangian(spec.method == GridMethod::lagrangian)
    , mapping(make_mapping<dim>(is_lagrangian))
    , fe(FE_Q<dim>(1), dim)
    , dof_handler(triangulation)
    , lower_corner(spec.lower_corner)
    , upper_corner(spec.upper_corner)
  {
    // Every rank keeps all coarse cells: as few of them as give the cells
    // that were asked for.
    const unsigned int        levels = common_halvings(spec.cells);
    std::vector<unsigned int> coarse_cells;
    for (const auto n : spec.cells)
      coarse_cells.push_back(n >> levels);
    GridGenerator::subdivided_hyper_rectangle(
      triangulation, coarse_cells, lower_corner, upper_corner, true);
    triangulation.refine_global(levels);

    for (unsigned int level = 0; level < spec.refinement_levels; ++level)
      {
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned() &&
              cell->level() == static_cast<int>(levels + level) &&
              spec.refine_where->value(cell->center()) > 0)
            cell->set_refine_flag();
        triangulation.execute_coarsening_and_refinement();
      }
    if (spec.map)
      GridTools::transform(
        [&](const Point<dim> &place) {
          dealii::Vector<double> image(dim);
          spec.map->vector_value(place, image);
          Point<dim> moved;
          std::copy(image.begin(), image.end(), moved.begin_raw());
          return moved;
        },
        triangulation);
    distribute_dofs();
    initial_positions = is_lagrangian ? positions : initial_positions;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::distribute_dofs()
  {
    dof_handler.distribute_dofs(fe);
    DoFTools::extract_locally_relevant_dofs(dof_handler, locally_relevant_dofs);
    hanging_nodes.clear();
    hanging_nodes.reinit(locally_relevant_dofs);
    DoFTools::make_hanging_node_constraints(dof_handler, hanging_nodes);
    if (Utilities::MPI::n_mpi_processes(communicator) > 1 &&
        triangulation.has_hanging_nodes())
      {
        // A box may touch a ghost cell with a node that hangs on a cell which
        // this rank does not see.
        hanging_nodes.make_consistent_in_parallel(
          dof_handler.locally_owned_dofs(),
          locally_relevant_dofs,
          communicator);
        locally_relevant_dofs = hanging_nodes.get_local_lines();
        for (const auto &line : hanging_nodes.get_lines())
          for (const auto &entry : line.entries)
            locally_relevant_dofs.add_index(entry.first);
        AffineConstraints<double> known(locally_relevant_dofs);
        known.merge(hanging_nodes,
                    AffineConstraints<double>::no_conflicts_allowed,
                    true);
        hanging_nodes.copy_from(known);
      }
    hanging_nodes.close();
    partitioner = std::make_shared<Utilities::MPI::Partitioner>(
      dof_handler.locally_owned_dofs(), locally_relevant_dofs, communicator);
    locate_nodes();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::locate_nodes()
  {
    smallest_extent = std::numeric_limits<double>::max();
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int d = 0; d < dim; ++d)
          smallest_extent = std::min(smallest_extent, cell_extent(cell, d));
    smallest_extent = Utilities::MPI::min(smallest_extent, communicator);

    // Through a vector, for nodes that belong to no cell of this rank.
    Vector coordinates;
    initialize(coordinates);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const auto nodes = nodes_of(cell);
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int d = 0; d < dim; ++d)
              coordinates.local_element(dim * nodes[v] + d) =
                cell->vertex(v)[d];
        }
    coordinates.zero_out_ghost_values();
    coordinates.update_ghost_values();
    positions.resize(
      (partitioner->locally_owned_size() + partitioner->n_ghost_indices()) /
      dim);
    for (unsigned int n = 0; n < positions.size(); ++n)
      for (unsigned int d = 0; d < dim; ++d)
        positions[n][d] = coordinates.local_element(dim * n + d);
  }

  template <int dim>
  std::array<unsigned int, (1u << dim)>
  BackgroundGrid<dim>::nodes_of(const CellIterator &cell) const
  {
    std::array<unsigned int, (1u << dim)> nodes;
    for (const unsigned int v : cell->vertex_indices())
      nodes[v] = local_index(cell->vertex_dof_index(v, 0)) / dim;
    return nodes;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::move_face(const unsigned int face, const double position)
  {
    const unsigned int d       = face / 2;
    const double       fixed   = face_position(face ^ 1u);
    const double       before  = face_position(face);
    const double       stretch = (position - fixed) / (before - fixed);
    GridTools::transform(
      [&](const Point<dim> &vertex) {
        Point<dim> moved = vertex;
        moved[d]         = vertex[d] == before ? position :
                                                 fixed + stretch * (vertex[d] - fixed);
        return moved;
      },
      triangulation);
    (face % 2 == 0 ? lower_corner : upper_corner)[d] = position;
    locate_nodes();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::carry(const Vector &u)
  {
    for (unsigned int n = 0; n < positions.size(); ++n)
      for (unsigned int d = 0; d < dim; ++d)
        positions[n][d] += u.local_element(dim * n + d);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::initialize(Vector &vector) const
  {
    vector.reinit(partitioner);
  }

  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace impm
