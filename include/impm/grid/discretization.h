#ifndef impm_grid_discretization_h
#define impm_grid_discretization_h

#include <deal.II/base/partitioner.h>

#include <deal.II/distributed/tria_base.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/lac/affine_constraints.h>

#include <impm/base/vector.h>

#include <array>
#include <memory>
#include <vector>

namespace impm
{
  /** Length of a cell's edge along an axis (m); deal.II averages all edges. */
  template <typename Cell>
  double
  cell_extent(const Cell &cell, const unsigned int direction)
  {
    return cell->vertex(0).distance(cell->vertex(1u << direction));
  }

  /**
   * Numbers of the nodes of a grid, as long as its cells stay the same. Bodies
   * that may slide along each other or part move nodes of their own: every
   * vertex has a node for each layer of bodies, one after the other.
   */
  template <int dim>
  struct NodeNumbering
  {
    /** The coarsest cells stand in rows along the axes, so many along each,
     * the first axis first. Collective. */
    NodeNumbering(const dealii::parallel::TriangulationBase<dim> &triangulation,
                  const std::vector<unsigned int>                &coarse_cells,
                  unsigned int                                    n_layers,
                  unsigned int                                    epoch);

    /** Counts the grids: grows when cells are refined, coarsened or sent to
     * another rank. Whoever keeps something by cell compares it. */
    const unsigned int epoch;

    const unsigned int n_layers; ///< of nodes

    const dealii::parallel::TriangulationBase<dim> &triangulation;
    dealii::DoFHandler<dim>                         dof_handler;
    dealii::IndexSet                                locally_relevant_dofs;

    /** Hanging nodes alone. */
    dealii::AffineConstraints<double> hanging_nodes;

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;

    std::vector<unsigned int> hanging; ///< nodes that hang and are this rank's
    /** Nodes that a hanging one follows, of every local node, with their
     * weights; an empty list if none hangs. */
    std::vector<std::vector<std::pair<unsigned int, double>>> masters;
    const bool any_hanging; ///< on any rank

    /** A node among others, whatever the shape of the grid: in units of its
     * smallest cells. */
    struct LatticeNode
    {
      std::array<int, dim> place;  ///< from the lower corner
      int                  extent; ///< of the smallest cells around it
      unsigned int         layer;
    };

    std::vector<LatticeNode> lattice; ///< of the nodes that this rank owns
  };

  /**
   * The grid of one step for those who compute on it: numbers and places of
   * its nodes. It never changes; a grid that does makes another one. Local
   * numbers of nodes count what this rank owns first, then its ghosts.
   */
  template <int dim>
  class Discretization
  {
  public:
    using CellIterator = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** Nodes stand at the vertices, moved by `shift` unless it is empty (m).
     * Collective. */
    Discretization(std::shared_ptr<const NodeNumbering<dim>> numbering,
                   const Vector                             &shift);

    /** A vector of this grid, zero, with room for all locally relevant values.
     */
    void
    initialize(Vector &vector) const
    {
      vector.reinit(numbering->partitioner);
    }

    /**
     * Where the nodes of a cell in a layer stand in a Vector of this grid:
     * component c of node n is its local element dim n + c.
     */
    std::array<unsigned int, 1u << dim>
    nodes_of(const CellIterator &cell, const unsigned int layer) const
    {
      std::array<unsigned int, 1u << dim> nodes{};
      for (const unsigned int v : cell->vertex_indices())
        nodes[v] = numbering->partitioner->global_to_local(
                     cell->vertex_dof_index(v, dim * layer)) /
                   dim;
      return nodes;
    }

    /** The layer of a node. */
    unsigned int
    layer(const unsigned int node) const
    {
      return node % numbering->n_layers;
    }

    /** The node of the first layer that stands at the same vertex. */
    unsigned int
    in_first_layer(const unsigned int node) const
    {
      return node - layer(node);
    }

    /** The same cell, with unknowns. */
    CellIterator
    with_dofs(
      const typename dealii::Triangulation<dim>::cell_iterator &cell) const
    {
      return CellIterator(*cell, &numbering->dof_handler);
    }

    const dealii::DoFHandler<dim> &
    dof_handler() const
    {
      return numbering->dof_handler;
    }

    const dealii::IndexSet &
    locally_owned_dofs() const
    {
      return numbering->dof_handler.locally_owned_dofs();
    }

    /** Hanging nodes from their masters. Ghosts come up to date. Collective. */
    void
    interpolate_hanging(Vector &vector) const;

    /** Adds what stands at hanging nodes to their masters. Collective. */
    void
    condense_hanging(Vector &vector) const;

    /** Another one when cells are refined, coarsened or change the rank. */
    const std::shared_ptr<const NodeNumbering<dim>> numbering;
    const MPI_Comm                                  communicator;

    /** Of the locally relevant nodes, by local number (m). */
    std::vector<dealii::Point<dim>> node_positions;

    /** Smallest extent of any cell as it was made or stretched (m). */
    double smallest_cell_extent;
  };
} // namespace impm

#endif
