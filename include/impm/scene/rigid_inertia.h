#ifndef impm_scene_rigid_inertia_h
#define impm_scene_rigid_inertia_h

#include <impm/scene/shapes.h>

namespace impm
{
  /** What a rigid body opposes to forces: in the plane for each metre of
   * thickness, in axisymmetry of the whole ring. */
  template <int dim>
  struct RigidInertia
  {
    double             mass = 0; ///< (kg)
    dealii::Point<dim> centre;   ///< of mass (m)
    /** About the centre, along the axes of space (kg m^2); in the plane that
     * about z alone counts. */
    dealii::Tensor<2, 3> tensor;
  };

  /** Of a shape that has a bounding box, filled with one density (kg/m^3). */
  template <int dim>
  RigidInertia<dim>
  inertia_of_shape(const Shape<dim> &shape,
                   double            density,
                   bool              is_axisymmetric);
} // namespace impm

#endif
