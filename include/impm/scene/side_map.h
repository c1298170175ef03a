#ifndef impm_scene_side_map_h
#define impm_scene_side_map_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>

#include <array>
#include <functional>
#include <vector>

namespace impm
{
  /**
   * Tells fast on which side of a surface most places lie: equal parts of a box
   * that no facet comes near are as a whole inside or outside.
   */
  template <int dim>
  class SideMap
  {
  public:
    enum class Side : unsigned char
    {
      inside,
      outside,
      unknown
    };

    SideMap() = default;

    /** From boxes around all facets, and a slower way to tell, which is asked
     * once or a few times. Has about ten parts for each facet. */
    SideMap(const dealii::BoundingBox<dim>                        &box,
            const std::vector<dealii::BoundingBox<dim>>           &facets,
            const std::function<bool(const dealii::Point<dim> &)> &is_inside);

    /** Of a place in the box, or else near it. */
    Side
    side_of(const dealii::Point<dim> &place) const
    {
      return sides[part_at(place)];
    }

  private:
    /** Along one direction. */
    unsigned int
    position_of(double coordinate, unsigned int d) const;

    unsigned int
    part_at(const dealii::Point<dim> &place) const;

    dealii::Point<dim>            lower;
    std::array<double, dim>       extents; ///< of a part
    std::array<unsigned int, dim> numbers; ///< of parts in each direction
    std::vector<Side>             sides;   ///< x varies fastest
  };
} // namespace impm

#endif
