#ifndef impm_footprints_footprint_builder_h
#define impm_footprints_footprint_builder_h

#include <impm/footprints/footprints.h>
#include <impm/grid/background_grid.h>

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
          const Discretization<dim> &discretization,
          Footprints<dim>           &footprints) = 0;

    /** Boxes of the last build that had to be cut, of this rank. */
    unsigned int n_limited_boxes = 0;
  };

  /** The builder of a method: every one stands in here. */
  template <int dim>
  std::unique_ptr<FootprintBuilder<dim>>
  make_footprint_builder(const GridSpec<dim> &spec);
} // namespace impm

#endif
