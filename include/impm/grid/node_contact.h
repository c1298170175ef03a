#ifndef impm_grid_node_contact_h
#define impm_grid_node_contact_h

#include <deal.II/base/bounding_box.h>

#include <impm/grid/background_grid.h>

#include <vector>

namespace impm
{
  /**
   * Nodes of a Lagrangian grid that stick to rigid boxes: one that reaches a
   * box moves with it from then on. No step may carry a node into a box, so
   * steps are cut where the first of them touches it. What fills the cells
   * between the nodes is not looked at, nor are hanging nodes, which follow
   * others.
   */
  template <int dim>
  class NodeContact
  {
  public:
    /** The boxes as they are at the start. */
    NodeContact(const BackgroundGrid<dim>                   &grid,
                const std::vector<dealii::BoundingBox<dim>> &boxes);

    /** Displacements of the boxes since the start (m). */
    using Shifts = std::vector<dealii::Tensor<1, dim>>;

    /** Nodes that lie on a box, or in it, stick to it from now on. */
    void
    stick(const Shifts &shifts);

    /**
     * The part of a step after which the first free node touches a box, taking
     * its way as straight; 1 if none goes into a box by the end. `u` (m) has
     * its ghosts; a node is free where any component is not `constrained`.
     * Collective.
     */
    double
    first_touch(const Vector            &u,
                const std::vector<char> &constrained,
                const Shifts            &start,
                const Shifts            &end) const;

    /** By local node: one more than the number of its box; 0: none. */
    const std::vector<unsigned int> &
    boxes_of_nodes() const
    {
      return box_of_node;
    }

  private:
    /** How far a place is outside of a box that has moved, across the side
     * that is furthest from it (m). */
    double
    gap(unsigned int                  box,
        const dealii::Point<dim>     &place,
        const dealii::Tensor<1, dim> &shift) const;

    const BackgroundGrid<dim>                  &grid;
    const std::vector<dealii::BoundingBox<dim>> boxes;
    const double              tolerance; ///< distance that counts as none (m)
    std::vector<unsigned int> box_of_node;
  };
} // namespace impm

#endif
