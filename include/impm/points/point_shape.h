#ifndef impm_points_point_shape_h
#define impm_points_point_shape_h

#include <deal.II/base/tensor.h>

#include <optional>

namespace impm
{
  /** The domain of a point: a box at the start, which F has deformed. */
  template <int dim>
  struct PointShape
  {
    double                 volume;              ///< at the start (m^3)
    dealii::Tensor<1, dim> place;               ///< of the centre of mass (m)
    dealii::Tensor<1, dim> domain;              ///< edges at the start (m)
    dealii::Tensor<2, 3>   deformation;         ///< F
    double                 present_measure = 0; ///< see present_measure()

    /** What has become of an edge of the start (m). */
    dealii::Tensor<1, dim>
    edge(unsigned int axis) const;

    /**
     * Second moments of the parallelogram about its centre, along the axes of
     * space, by its measure (m^2): a box of edges h has h^2 / 12.
     */
    dealii::Tensor<1, dim>
    second_moments() const;
  };

  /** Points of a cell that may be merged, and the room for one. */
  template <int dim>
  struct MergeRoom
  {
    dealii::Tensor<1, dim> cell;          ///< its edges (m)
    double                 points_across; ///< wished, of the cell
  };

  /**
   * The shape of one point for two that make one box along an axis of the
   * start, deformed by their mean F; it has their volume. None if they do not,
   * or if it were nearly long enough to be split. Both F must be similar.
   */
  template <int dim>
  std::optional<PointShape<dim>>
  merge_along(unsigned int           axis,
              const PointShape<dim> &first,
              const PointShape<dim> &second,
              const MergeRoom<dim>  &room);

  /**
   * The same for two whose F is free but for its determinant: a box along the
   * axes of space with their volume and measure and as far as possible with
   * their second moments, but short enough not to be split. Its F is a uniform
   * stretch. None if it were larger than what there is for a point. If they
   * shall be `compact`, none either if they do not lie side by side.
   */
  template <int dim>
  std::optional<PointShape<dim>>
  merge_to_box(const PointShape<dim> &first,
               const PointShape<dim> &second,
               const MergeRoom<dim>  &room,
               bool                   compact);
} // namespace impm

#endif
