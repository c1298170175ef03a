#ifndef impm_contact_faced_surface_h
#define impm_contact_faced_surface_h

#include <deal.II/base/point.h>

#include <deal.II/numerics/rtree.h>

#include <boost/geometry/index/rtree.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace impm
{
  /** A point on the surface of a body, as others see it. */
  template <int dim>
  struct SurfacePatch
  {
    dealii::Point<dim>     place;   ///< (m)
    dealii::Tensor<1, dim> normal;  ///< outward, of length one
    double                 spacing; ///< to the next of its surface (m)
    unsigned int           body;
  };

  /**
   * Surfaces as planes through the middle of what is near: points of a surface
   * weighed by how near they are, and such that their middle is the place that
   * is looked at wherever the surface goes on to all sides: planes are exact,
   * curved surfaces right to third order in the spacing.
   */
  template <int dim>
  class FacedSurface
  {
  public:
    explicit FacedSurface(std::vector<SurfacePatch<dim>> patches);

    struct Facing
    {
      double                 gap;    ///< (m), negative inside of the other
      dealii::Tensor<1, dim> normal; ///< of the other
    };

    /** What of a body a place on another surface, with a normal, faces within
     * `reach` (m), if anything. */
    std::optional<Facing>
    find(const dealii::Point<dim>     &place,
         const dealii::Tensor<1, dim> &normal,
         unsigned int                  body,
         double                        reach) const;

  private:
    const std::vector<SurfacePatch<dim>> patches;
    using Tree = decltype(dealii::pack_rtree_of_indices(
      std::declval<const std::vector<dealii::Point<dim>> &>()));
    std::vector<dealii::Point<dim>> places;
    Tree                            tree;
  };
} // namespace impm

#endif
