#ifndef impm_scene_surface_of_shape_h
#define impm_scene_surface_of_shape_h

#include <impm/scene/shapes.h>

#include <array>
#include <vector>

namespace impm
{
  /** A small part of a surface, as if it were flat. */
  template <int dim>
  struct SurfacePiece
  {
    dealii::Point<dim> position; ///< its middle (m)

    /** Normal times area, out of the shape (m^2; in the plane m, for each meter
     * of thickness). */
    dealii::Tensor<1, dim> area;
  };

  /**
   * The surface of a shape in a box that is divided into so many equal parts
   * along each direction, from where it cuts the edges of simplices within the
   * parts, by `contains`. A part has one piece, or one for each side where
   * sides that look away from each other share it.
   *
   * The volume inside is right to second order in the parts, areas as well, or
   * to first where the surface has edges: those are cut off within a part,
   * unless they lie on the planes between parts and look outwards. What is
   * thinner than a part is found if corners of parts lie in it, and else not.
   *
   * Boxes that fill space, with parts alike, have each place of the surface
   * once, and what they find closes. A surface on the plane between two parts
   * belongs to the one outside of the shape, whatever round-off says; on the
   * boundary of all boxes there is thus none.
   */
  template <int dim>
  std::vector<SurfacePiece<dim>>
  surface_in_box(const Shape<dim>                    &shape,
                 const dealii::Point<dim>            &lower,
                 const dealii::Tensor<1, dim>        &extents,
                 const std::array<unsigned int, dim> &divisions);
} // namespace impm

#endif
