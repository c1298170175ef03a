#ifndef impm_footprints_footprint_builder_h
#define impm_footprints_footprint_builder_h

#include <impm/footprints/footprints.h>

#include <memory>

namespace impm
{
  /** What a point is to the grid: a place, a box, a Gauss point. */
  template <int dim>
  class FootprintBuilder
  {
  public:
    virtual ~FootprintBuilder() = default;

    /** Fills the footprints of this step. Collective. */
    virtual void
    build(const MaterialPoints<dim> &points,
          const BackgroundGrid<dim> &grid,
          Footprints<dim>           &footprints) = 0;

    /** Boxes of the last build that had to be cut, of this rank. */
    unsigned int n_limited_boxes = 0;
  };

  /** The builder of the grid's method: every one stands in here. */
  template <int dim>
  std::unique_ptr<FootprintBuilder<dim>>
  make_footprint_builder(const GridSpec<dim> &grid);
} // namespace impm

#endif
