#ifndef impm_grid_rigid_bodies_h
#define impm_grid_rigid_bodies_h

#include <impm/grid/node_contact.h>
#include <impm/points/material_points.h>

#include <memory>
#include <optional>
#include <vector>

namespace impm
{
  /**
   * Bodies that move as prescribed. They are made of points, which impose their
   * motion on every node of the cells that they touch (Sulsky & Kaul 2004, sec.
   * 3.2.7) and have no fields. To a Lagrangian grid they are boxes to which its
   * nodes stick.
   */
  template <int dim>
  class RigidBodies
  {
  public:
    RigidBodies(const Bodies<dim>         &specs,
                GeometryKind               geometry,
                const BackgroundGrid<dim> &grid);

    unsigned int
    size() const
    {
      return bodies.size();
    }

    const BodySpec<dim> &
    spec(const unsigned int body) const
    {
      return *bodies[body].spec;
    }

    /** Displacement from one time to another (m). */
    dealii::Tensor<1, dim>
    displacement(unsigned int body, double from, double to) const;

    /**
     * Moves the points and sorts them; nodes that have come to a box stick to
     * it. Collective.
     */
    void
    move(double from, double to);

    /**
     * The part of a step between two times after which the increment `u` brings
     * the first free node to a box; 1 if there is none. Collective.
     */
    double
    first_touch(const Vector            &u,
                const std::vector<char> &constrained,
                double                   from,
                double                   to) const;

    /** By local node, one more than the body that it sticks to; 0: none. */
    const std::vector<unsigned int> &
    holders_of_nodes() const
    {
      return contact->boxes_of_nodes();
    }

    /** Sorts the points after the grid has moved. Collective. */
    void
    sort();

    /** Around a change of the grid's cells, then sort(). Collective. */
    void
    prepare_for_adaptation();

    void
    unpack_after_adaptation();

    const SortedParticles<dim> &
    points(const unsigned int body) const
    {
      return *bodies[body].points;
    }

  private:
    /** Displacements of all bodies since the start (m). */
    typename NodeContact<dim>::Shifts
    displacements(double time) const;

    struct Body
    {
      const BodySpec<dim>                  *spec;
      std::unique_ptr<SortedParticles<dim>> points;
    };
    std::vector<Body>               bodies;
    std::optional<NodeContact<dim>> contact; ///< of a Lagrangian grid
  };
} // namespace impm

#endif
