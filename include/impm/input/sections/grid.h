#ifndef impm_input_sections_grid_h
#define impm_input_sections_grid_h

#include <deal.II/base/point.h>

#include <impm/input/sections/section.h>
#include <impm/points/point_layout.h>

#include <array>
#include <memory>

namespace impm
{
  /** What a material point is to the grid. */
  enum class GridMethod
  {
    mpm,       ///< a place
    gimp,      ///< a box
    lagrangian ///< a Gauss point of a grid that stays with the material
  };

  /** The background grid at the start: a box of equal cells. */
  template <int dim>
  struct GridSpec
  {
    dealii::Point<dim>            lower_corner, upper_corner;
    std::array<unsigned int, dim> cells;
    GridMethod                    method        = GridMethod::gimp;
    bool                          boxes_stretch = true; ///< GIMP: with F
    /** Lagrangian: where a place of the box really is, or null. */
    std::shared_ptr<dealii::FunctionParser<dim>> map;

    /** Cells whose centre makes `refine_where` positive are split so often. */
    unsigned int                                 refinement_levels = 0;
    std::shared_ptr<dealii::FunctionParser<dim>> refine_where;

    /** Of the ranks, before cells are sent to others. */
    double largest_imbalance = 1.2;

    /** How often a cell may be split while the grid adapts. */
    unsigned int finest_level = 0;

    bool
    is_lagrangian() const
    {
      return method == GridMethod::lagrangian;
    }
  };

  template <int dim>
  void
  add_grid(const Section &top, GridSpec<dim> &grid, GeometryKind geometry);
} // namespace impm

#endif
