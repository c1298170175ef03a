#ifndef impm_scene_thin_parts_h
#define impm_scene_thin_parts_h

#include <impm/grid/background_grid.h>
#include <impm/input/sections/bodies.h>
#include <impm/points/material_points.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * Parts of bodies that their points know nothing of, a sentence for each body
   * that has some: places in a shape a cell or more away from any of its
   * points, since the part is thinner than they are apart there. Looks at every
   * cell without points as closely as at the finest ones, up to a hundred
   * thousand places in all. Bodies of a Lagrangian grid, from files or rigid
   * are not looked at. Collective.
   */
  template <int dim>
  std::vector<std::string>
  find_thin_parts(const Bodies<dim>         &bodies,
                  const BackgroundGrid<dim> &grid,
                  const MaterialPoints<dim> &points);
} // namespace impm

#endif
