#ifndef impm_grid_rigid_bodies_h
#define impm_grid_rigid_bodies_h

#include <deal.II/base/bounding_box.h>

#include <impm/grid/rigid_motion.h>
#include <impm/points/material_points.h>

#include <memory>
#include <vector>

namespace impm
{
  /** Where a free rigid body is and how it moves. Rates of turning are those
   * of axes that are fixed to the body. */
  template <int dim>
  struct RigidState
  {
    RigidMotion<dim>       since_start;
    RotationVector         angles; ///< of all turns since the start, summed up
    dealii::Tensor<1, dim> velocity, acceleration; ///< of the centre
    RotationVector         spin, spin_acceleration;

    /** Angular velocity in space (rad/s). */
    RotationVector
    angular_velocity() const
    {
      return turned_to_space(since_start, spin);
    }

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &since_start.centre &since_start.shift   &since_start
        .turning &angles &velocity &acceleration &spin &spin_acceleration;
    }
  };

  /**
   * Bodies that move as prescribed, and such as forces move (see FreeBodies).
   * The former are made of points, which impose their
   * motion on every node of the cells that they touch (Sulsky & Kaul 2004, sec.
   * 3.2.7) and have no fields.
   *
   * To a Lagrangian grid they are boxes without points: a node that reaches one
   * moves with it from then on. No step may carry a node into a box, so steps
   * are cut where the first of them touches it. What fills the cells between
   * the nodes is not looked at, nor are hanging nodes, which follow others.
   */
  template <int dim>
  class RigidBodies
  {
  public:
    RigidBodies(const Bodies<dim>         &specs,
                GeometryKind               geometry,
                const BackgroundGrid<dim> &grid);

    struct Body
    {
      /** From one time to another, if it is prescribed. */
      RigidMotion<dim>
      motion(double from, double to) const;

      /** Turn about its axis since the start (rad), if it is prescribed. */
      double
      angle(double time) const;

      /** To a time; to where it is now, if it is free. */
      RigidMotion<dim>
      since_start(double time) const;

      /** In the step from a time on; of a free body what it does by itself. */
      RigidMotion<dim>
      in_step(double time, double dt) const;

      const BodySpec<dim>                  *spec;
      std::unique_ptr<SortedParticles<dim>> points;
      dealii::BoundingBox<dim> box; ///< at the start, to a Lagrangian grid
      double radius = 0; ///< of a ball about the centre that has all points (m)
      RigidState<dim> state; ///< if it is free
    };

    /**
     * Moves the points and sorts them; nodes that have come to a box stick to
     * it. Collective.
     */
    void
    move(double from, double to);

    /** Sorts the points into the cells of a grid that has changed. Collective.
     */
    void
    sort();

    /** Of free bodies (m/s). */
    double
    largest_speed() const;

    /** States of free bodies. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      for (auto &body : bodies)
        if (body.spec->is_free)
          archive &body.state;
    }

    /** Bound of the components of the ways of all points from one time to
     * another (m). */
    double
    largest_displacement(double from, double to) const;

    /**
     * The part of a step between two times after which the increment `u` brings
     * the first free node to a box, taking its way as straight; 1 if there is
     * none. `u` (m) has its ghosts; a node is free where any component is not
     * `constrained`. Collective.
     */
    double
    first_touch(const Vector            &u,
                const std::vector<char> &constrained,
                double                   from,
                double                   to) const;

    std::vector<Body> bodies;

    /** By local node, one more than the body that it sticks to; 0: none. */
    std::vector<unsigned int> holders_of_nodes;

  private:
    /** Nodes that lie on a box at a time, or in it, stick to it from now on. */
    void
    stick(double time);

    const BackgroundGrid<dim> &grid;
    const double               tolerance; ///< distance that counts as none (m)
  };
} // namespace impm

#endif
