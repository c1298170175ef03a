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

  /** When nodes that have moved with the material go back to the grid. */
  enum class GridReset
  {
    every_step,
    interval,  ///< after so many steps
    distortion ///< when a cell has been deformed so much
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

    GridReset    reset          = GridReset::every_step;
    unsigned int reset_interval = 1; ///< in steps
    /** Largest logarithm of a principal stretch since the reset. */
    double reset_distortion = 0;
    double reset_motion     = 0.5; ///< largest of a point, in cells

    /** Of the ranks, before cells are sent to others. */
    double largest_imbalance = 1.2;

    unsigned int n_layers = 1; ///< of nodes, for bodies that may part

    /** How often a cell may be split while the grid adapts. */
    unsigned int finest_level = 0;

    bool
    is_lagrangian() const
    {
      return method == GridMethod::lagrangian;
    }

    /** Whether nodes may go on from where a step has moved them. */
    bool
    keeps_motion() const
    {
      return is_lagrangian() || reset != GridReset::every_step;
    }
  };

  template <int dim>
  void
  add_grid(const Section &top, GridSpec<dim> &grid, GeometryKind geometry);
} // namespace impm

#endif
