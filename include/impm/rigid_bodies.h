#ifndef impm_rigid_bodies_h
#define impm_rigid_bodies_h

#include <impm/material_points.h>

#include <memory>
#include <vector>

namespace impm
{
  /**
   * Bodies of points that move as prescribed and impose their motion on every
   * node of the cells that they touch (Sulsky & Kaul 2004, sec. 3.2.7). They
   * only move; they have no fields.
   */
  template <int dim>
  class RigidBodies
  {
  public:
    RigidBodies(const Scene<dim> &scene, const BackgroundGrid<dim> &grid);

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

    /** Moves the points and sorts them. Collective. */
    void
    move(double from, double to);

    /** Sorts the points after the grid has moved. Collective. */
    void
    sort();

    const SortedParticles<dim> &
    points(const unsigned int body) const
    {
      return *bodies[body].points;
    }

  private:
    struct Body
    {
      const BodySpec<dim>                  *spec;
      std::unique_ptr<SortedParticles<dim>> points;
    };
    std::vector<Body> bodies;
  };
} // namespace impm

#endif
