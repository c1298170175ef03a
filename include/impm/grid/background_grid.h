#ifndef impm_grid_background_grid_h
#define impm_grid_background_grid_h

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <impm/input/sections/grid.h>

#include <memory>

namespace impm
{
  /** Every field on the grid: dim values per node, those of a node together. */
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  /** Length of a cell's edge along an axis (m); deal.II averages all edges. */
  template <typename Cell>
  double
  cell_extent(const Cell &cell, const unsigned int direction)
  {
    const auto edge = cell->vertex(1u << direction) - cell->vertex(0);
    return std::sqrt(edge * edge);
  }

  /**
   * The grid of one step: a p4est forest of axis-aligned boxes with Q1
   * displacements. It carries nothing from one step to the next, unless it is
   * Lagrangian: then its nodes move with the material, and its cells may be
   * any quadrilaterals.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    BackgroundGrid(const GridSpec<dim> &spec, MPI_Comm communicator);

    /**
     * Stretches the grid along the normal of a face (deal.II's number) so
     * that the face comes to lie at `position` (m). Collective.
     */
    void
    move_face(unsigned int face, double position);

    /** Where a face lies along its normal (m). */
    double
    face_position(const unsigned int face) const
    {
      return face % 2 == 0 ? lower_corner[face / 2] : upper_corner[face / 2];
    }

    /** Smallest extent of any cell (m). */
    double
    smallest_cell_extent() const
    {
      return smallest_extent;
    }

    /** A vector of this grid, zero, with room for all locally relevant values.
     */
    void
    initialize(Vector &vector) const;

    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const bool                                        is_lagrangian;

    /** From unit cells to where the grid was made. */
    const std::unique_ptr<const dealii::Mapping<dim>> mapping;
    const dealii::FESystem<dim>                       fe;
    dealii::DoFHandler<dim>                           dof_handler;
    dealii::IndexSet                                  locally_relevant_dofs;

    /** Hanging nodes alone. */
    dealii::AffineConstraints<double> hanging_nodes;

    using CellIterator = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /**
     * Where the nodes of a cell stand in a Vector of this grid: component c
     * of node n is its local element dim n + c.
     */
    std::array<unsigned int, (1u << dim)>
    nodes_of(const CellIterator &cell) const;

    unsigned int
    local_index(const dealii::types::global_dof_index dof) const
    {
      return partitioner->global_to_local(dof);
    }

    /** Of the locally relevant nodes, by local number (m). */
    const std::vector<dealii::Point<dim>> &
    node_positions() const
    {
      return positions;
    }

    /** The same where the nodes stood before carry() (m). */
    const std::vector<dealii::Point<dim>> &
    initial_node_positions() const
    {
      return is_lagrangian ? initial_positions : positions;
    }

    /** Moves the nodes of a Lagrangian grid; ghosts of `u` are up to date. */
    void
    carry(const Vector &u);

  private:
    void
    distribute_dofs();

    void
    locate_nodes();

    dealii::Point<dim>              lower_corner, upper_corner;
    std::vector<dealii::Point<dim>> positions, initial_positions;
    double                          smallest_extent;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  };
} // namespace impm

#endif
