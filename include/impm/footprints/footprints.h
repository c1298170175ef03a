#ifndef impm_footprints_footprints_h
#define impm_footprints_footprints_h

#include <impm/base/memory.h>
#include <impm/grid/discretization.h>
#include <impm/points/material_points.h>

#include <array>
#include <memory>
#include <vector>

namespace impm
{
  /**
   * Where each point touches the grid in this step: entries of (point, values
   * and gradients of the shape functions of one cell), sorted by cell and
   * stored as structure-of-arrays. A point of plain MPM has one entry; one
   * that stands for a box has one for each cell that the box touches, times
   * the share of the box that lies there. What follows never asks where the
   * entries come from.
   */
  template <int dim>
  class Footprints
  {
  public:
    static constexpr unsigned int n_nodes = 1u << dim; ///< of a cell

    using CellIterator = typename Discretization<dim>::CellIterator;

    struct Cell
    {
      CellIterator                      cell; ///< owned, or a ghost cell
      std::array<unsigned int, n_nodes> nodes;
      unsigned int                      begin, end; ///< its entries
      double                            extent;     ///< smallest (m)
    };

    /**
     * Points that touch the same cells, or that something else couples, and
     * all the nodes that they touch: a block of the tangent.
     */
    struct Patch
    {
      unsigned int begin_points, end_points; ///< in patch_points
      unsigned int begin_nodes, end_nodes;   ///< in patch_nodes
    };

    /** Part of a point, as a builder finds it. */
    struct Piece
    {
      unsigned int       point;
      unsigned int       layer; ///< of its nodes
      CellIterator       cell;
      double             weight;   ///< share of the point
      dealii::Point<dim> centroid; ///< in unit coordinates of the cell
    };

    /**
     * Makes entries, for once, of pieces, which come in any order, in cells
     * that are axis-aligned or may have any corners. `inverse_radius` is the
     * caller's.
     */
    void
    build(const std::vector<Piece>  &pieces,
          unsigned int               n_points,
          const Discretization<dim> &discretization,
          bool                       any_corners);

    /**
     * Goes on with nodes that have moved since the entries were made, with
     * their hanging nodes and ghosts: slopes become those with respect to where
     * the nodes are, by the mean deformation A of the points,
     *
     *   A_p = 1 + sum_I u_I grad S_pI,   grad S_pI <- A_p^-T grad S_pI,
     *
     * so that the deformations of steps in a row multiply to A.
     */
    void
    move(const Vector &displacement);

    /** Alike on all ranks. */
    bool
    are_moved() const
    {
      return moved;
    }

    /** Largest |ln lambda| of the principal stretches of A (see move()) at the
     * end of a step, on this rank. */
    double
    largest_distortion(const Vector &increment) const;

    /**
     * Takes nodes out of the reach of points that would move them but give
     * them no mass: a point exactly on a face of its cell has slopes at the
     * nodes across, but no share in them. Where nothing else gives them mass,
     * it goes without the derivative across the face for this step, as if they
     * went along with the nodes on the face. For steps with inertia.
     * Collective.
     */
    void
    release_massless_nodes(const Discretization<dim> &discretization);

    /** Whether an entry has any part in a node of its cell. */
    bool
    touches(const unsigned int entry, const unsigned int node) const
    {
      if (value(entry)[node] != 0)
        return true;
      for (unsigned int d = 0; d < dim; ++d)
        if (gradient(entry)[dim * node + d] != 0)
          return true;
      return false;
    }

    /**
     * Groups the points for the tangent. `coupled` has, for every point, a
     * number of those that must share a block whatever cells they touch, or
     * is empty.
     */
    void
    make_patches(const std::vector<unsigned int> &coupled);

    const double *
    value(const unsigned int entry) const
    {
      return &values[entry * n_nodes];
    }

    /** d N_node / d x_d at [node * dim + d] (1/m). */
    const double *
    gradient(const unsigned int entry) const
    {
      return &gradients[entry * n_nodes * dim];
    }

    /** Values of a grid field, whose ghosts are up to date, at all points. */
    void
    interpolate(const Vector                        &field,
                std::vector<dealii::Tensor<1, dim>> &at_points) const;

    /**
     * How far the points go: with what they stand for but, where a face of the
     * domain cuts a box, with the part of it that is symmetric about the point.
     * The middle of all that is left lies farther from the face than the point,
     * which would pass through it where the material is pressed against it.
     */
    void
    move_points(const Vector                        &increment,
                std::vector<dealii::Tensor<1, dim>> &of_points) const;

    using Tensors = std::vector<dealii::Tensor<2, dim>>;

    /** 1 + sum_I u_I grad S_pI of the points. */
    Tensors
    deformations(const Vector &u) const;

    /** field += sum_p S_p at_points_p; ghosts of the field are not summed. */
    void
    spread(const std::vector<dealii::Tensor<1, dim>> &at_points,
           Vector                                    &field) const;

    /** (bytes) */
    std::size_t
    memory_consumption() const
    {
      return (middles ? middles->memory_consumption() : 0) +
             bytes_of(cells, point, weight, inverse_radius, first, entries) +
             bytes_of(patches, patch_points, patch_nodes, place) +
             bytes_of(values, gradients, moved_by, cell_of_entry);
    }

    /** Of the cell of an entry. */
    const std::array<unsigned int, n_nodes> &
    nodes_of_entry(const unsigned int entry) const
    {
      return cells[cell_of_entry[entry]].nodes;
    }

    std::vector<Cell>         cells;  ///< those that points of a layer touch
    std::vector<unsigned int> point;  ///< of every entry
    std::vector<double>       weight; ///< of every entry
    /** 1/r of every point, if axisymmetric (1/m). */
    std::vector<double> inverse_radius;

    /** The entries of point p: entries[first[p]] to entries[first[p + 1]]. */
    std::vector<unsigned int> first, entries;

    std::vector<Patch>        patches;
    std::vector<unsigned int> patch_points, patch_nodes;
    /** Where the nodes of an entry stand among those of its patch. */
    std::vector<unsigned int> place;

    /** Of boxes that faces cut, see move_points(); null if there are none. */
    std::shared_ptr<Footprints> middles;

    /** Boxes of this rank that had to be cut. */
    unsigned int n_limited_boxes = 0;

  private:
    /** The node that a point gives most to, if all cells that the point touches
     * have it; else the invalid number. */
    unsigned int
    nearest_node(unsigned int point) const;

    std::vector<double>       values, gradients;
    bool                      moved = false;
    Tensors                   moved_by; ///< A, if nodes have moved
    std::vector<unsigned int> cell_of_entry;
  };
} // namespace impm

#endif
