#ifndef impm_scene_shared_cells_h
#define impm_scene_shared_cells_h

#include <impm/points/material_points.h>

#include <string>

namespace impm
{
  /**
   * A sentence on cells in which points of different materials lie, since all
   * of them get the one strain of the cell; empty if there are none. Those of a
   * Lagrangian grid are whole. Collective.
   */
  template <int dim>
  std::string
  find_shared_cells(const MaterialPoints<dim> &points);
} // namespace impm

#endif
