#ifndef impm_scene_proximity_h
#define impm_scene_proximity_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace impm
{
  /**
   * Where a place lies relative to a surface. Its numbers are finite and its
   * normal a unit vector at any place, also where the distance has a kink: one
   * of the normals around is taken there. The curvature of a point, an edge or
   * an axis is 0 at the place itself.
   */
  template <int dim>
  struct Proximity
  {
    double                          distance;  ///< (m), negative inside
    dealii::Tensor<1, dim>          normal;    ///< gradient of the distance
    dealii::SymmetricTensor<2, dim> curvature; ///< its second derivative (1/m)
  };

  /** To a box between two corners, which may be as far away as numbers go. */
  template <int dim>
  Proximity<dim>
  proximity_to_box(const dealii::Point<dim> &place,
                   const dealii::Point<dim> &lower,
                   const dealii::Point<dim> &upper);

  template <int dim>
  Proximity<dim>
  proximity_to_ball(const dealii::Point<dim> &place,
                    const dealii::Point<dim> &centre,
                    double                    radius);

  /** To a circular cylinder with plane ends, from one to `length` along a unit
   * vector. */
  Proximity<3>
  proximity_to_cylinder(const dealii::Point<3>     &place,
                        const dealii::Point<3>     &from,
                        const dealii::Tensor<1, 3> &axis,
                        double                      length,
                        double                      radius);

  /**
   * To where a function is zero, up to the square of the distance: by the
   * function over its gradient, which comes from differences. The curvature is
   * not known and 0. Where the function is flat, it is its own distance, and
   * where it is no number, the surface is far away.
   */
  template <int dim>
  Proximity<dim>
  proximity_to_zero(const dealii::Point<dim>    &place,
                    const dealii::Function<dim> &function);

  /** To the same surface from the other side. */
  template <int dim>
  Proximity<dim>
  turn(const Proximity<dim> &proximity)
  {
    return {-proximity.distance, -proximity.normal, -proximity.curvature};
  }
} // namespace impm

#endif
