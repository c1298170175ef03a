#ifndef impm_scene_closed_surface_h
#define impm_scene_closed_surface_h

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace impm
{
  /** A surface of flat facets: segments in the plane, triangles in space. */
  template <int dim>
  struct FacettedSurface
  {
    using Facet = std::array<unsigned int, dim>;

    std::vector<dealii::Point<dim>> vertices; ///< (m), no two at one place
    std::vector<Facet>              facets;   ///< their vertices
  };

  /**
   * Normal times area of a facet (m^2, in the plane m): the normal lies to the
   * right of a segment, and to where a triangle is seen anticlockwise.
   */
  template <int dim>
  dealii::Tensor<1, dim>
  area_of(const std::array<dealii::Point<dim>, dim> &corners);

  /**
   * Turns the facets of a closed surface so that their normals look out of what
   * it encloses: around its parts, and into the cavities within those, whatever
   * way they looked before. Facets that cut each other are not looked for.
   * Throws InputError, with an empty entry and a message that goes on after the
   * name of a file, for a surface that is not closed, one-sided, or encloses
   * nothing.
   */
  template <int dim>
  void
  turn_outwards(FacettedSurface<dim> &surface);
} // namespace impm

#endif
