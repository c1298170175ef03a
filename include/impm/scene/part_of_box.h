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
   * The part of a box where `contains` holds, found along lines: eight in a
   * plane and six by six in space, along the axis that is nearest to the normal
   * of the surface, with its places on a line to 1e-5 of the box. What is
   * thinner than that many parts of a line may be missed. A part of less than a
   * hundredth is none, since so few points hold nothing, and one that lacks as
   * little is the whole box, exactly: on average over surfaces neither adds nor
   * takes anything.
   */
  template <int dim>
  PartOfBox<dim>
  find_part(const std::function<bool(const dealii::Point<dim> &)> &contains,
            const dealii::BoundingBox<dim>                        &box);
} // namespace impm

#endif
