#ifndef impm_scene_part_of_box_h
#define impm_scene_part_of_box_h

#include <deal.II/base/bounding_box.h>

#include <functional>

namespace impm
{
  /** What lies inside a surface of a box that it cuts. */
  template <int dim>
  struct PartOfBox
  {
    double             share = 0; ///< of the measure of the box, 0 to 1
    dealii::Point<dim> centroid;  ///< (m)

    /** Edges of the box with the measure of the part whose second moments are
     * proportional to those of the part (m). */
    dealii::Tensor<1, dim> extents;
  };

  /**
   * The part of a box where `contains` holds, to second order in the spacing of
   * the lines along which it is looked for: eight in a plane and six by six in
   * space, along the axis that is nearest to the surface's normal; along a line
   * to 1e-5 of its length. What is narrower than a line's eighth (sixth) may be
   * missed. A part of less than a thousandth is none, since its surface is
   * where round-off puts it, and one that lacks as little is the whole box,
   * exactly.
   */
  template <int dim>
  PartOfBox<dim>
  find_part(const std::function<bool(const dealii::Point<dim> &)> &contains,
            const dealii::BoundingBox<dim>                        &box);
} // namespace impm

#endif
