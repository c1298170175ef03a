#ifndef impm_contact_contact_links_h
#define impm_contact_contact_links_h

#include <impm/contact/surface_points.h>
#include <impm/footprints/footprint_builder.h>
#include <impm/grid/populated_cells.h>
#include <impm/grid/rigid_bodies.h>
#include <impm/grid/rigid_motion.h>
#include <impm/scene/scene.h>

#include <functional>
#include <optional>
#include <vector>

namespace impm
{
  /** A rigid body or a face of the domain as surfaces meet it in a step. */
  template <int dim>
  struct Obstacle
  {
    /** Of a place, to where it is at the start of the step. */
    std::function<Proximity<dim>(const dealii::Point<dim> &)> proximity;
    RigidMotion<dim> motion; ///< in the step; of a free body a guess
    /** Among the free bodies of the scene, if it is one. */
    std::optional<unsigned int> free_body;
  };

  /**
   * What may meet in a step: a point of a surface and, on the other side, an
   * obstacle or nodes. The way of the surface along the other one is
   *
   *   w = sum_k c_k u_k,
   *
   * linear in the increments of some nodes, and along an obstacle as one sees
   * it that goes with it and turns as it does,
   *
   *   w = M^-1(x + sum_k c_k u_k) - x,   M the obstacle's motion in the step.
   */
  template <int dim>
  struct ContactLink
  {
    unsigned int point; ///< of the surface
    unsigned int pair;  ///< of the scene
    double       area;  ///< (m^2)

    /** Modulus of the layer over its thickness (Pa/m), and that (m). */
    double stiffness, thickness;

    dealii::Point<dim>     place;  ///< at the start (m)
    double                 gap;    ///< likewise (m)
    dealii::Tensor<1, dim> normal; ///< likewise, out of the other one
    dealii::Tensor<1, dim> slip;   ///< likewise, see SurfacePoints
    double                 friction_bound = 0; ///< likewise (Pa)

    bool   is_bond;
    double friction; ///< coefficient

    const Obstacle<dim> *obstacle; ///< or null

    /** c_k of the nodes, from ContactLinks::nodes[begin] on. */
    unsigned int begin, end;
  };

  /** The links of this rank in one step. */
  template <int dim>
  class ContactLinks
  {
  public:
    /** For the step from `time` to `time + dt`. `points` are in the cells of
     * the grid, with these footprints. Collective. */
    ContactLinks(const Scene<dim>          &scene,
                 const BackgroundGrid<dim> &grid,
                 const SurfacePoints<dim>  &points,
                 const Footprints<dim>     &prints,
                 const RigidBodies<dim>    &rigid,
                 const PopulatedCells<dim> &populated,
                 const Discretization<dim> &discretization,
                 FootprintBuilder<dim>     &builder,
                 double                     time,
                 double                     dt);

    std::vector<ContactLink<dim>> links;
    std::vector<unsigned int>     nodes;
    std::vector<double>           coefficients; ///< c_k

    std::vector<Obstacle<dim>> obstacles; ///< by pair; unused of bodies

  private:
    /** Adds the nodes of a place that touches one cell. */
    void
    append(const Footprints<dim> &prints, unsigned int place, double factor);
  };
} // namespace impm

#endif
