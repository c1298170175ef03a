#ifndef impm_scene_seeding_h
#define impm_scene_seeding_h

#include <impm/grid/background_grid.h>
#include <impm/input/sections/bodies.h>

#include <vector>

namespace impm
{
  /** A point of a body before it becomes a particle. */
  template <int dim>
  struct Seed
  {
    typename dealii::Triangulation<dim>::active_cell_iterator cell;
    dealii::Point<dim>                                        position;
    dealii::Point<dim>                                        unit_position;
    double                 volume; ///< of the whole circle if axisymmetric
    dealii::Tensor<1, dim> domain; ///< extents of the box that it stands for
  };

  /**
   * The points of a body in the cells of this rank: those of a regular
   * pattern in every cell that lie in its shape, or what of their boxes does
   * (see SurfaceSeeding), or those of its file. Throws InputError, on every
   * rank alike, when there are none, unless it `may_be_empty`, or when one, or
   * part of what it stands for, also lies in the shape of another body.
   * Collective.
   */
  template <int dim>
  std::vector<Seed<dim>>
  seed_body(const Bodies<dim>         &bodies,
            const BodySpec<dim>       &body,
            GeometryKind               geometry,
            const BackgroundGrid<dim> &grid,
            bool                       may_be_empty = false);
} // namespace impm

#endif
