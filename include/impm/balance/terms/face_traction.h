#ifndef impm_balance_terms_face_traction_h
#define impm_balance_terms_face_traction_h

#include <impm/grid/populated_cells.h>
#include <impm/input/sections/boundary_conditions.h>

namespace impm
{
  /**
   * Adds `factor` times the nodal forces (N) of the tractions on those faces
   * of the domain that have material behind them, at an instant: forces per
   * area of the grid as it was made, whose direction does not follow the
   * material. Ghosts are not summed.
   */
  template <int dim>
  void
  add_face_tractions(const Faces<dim>          &faces,
                     GeometryKind               geometry,
                     const BackgroundGrid<dim> &grid,
                     const PopulatedCells<dim> &populated,
                     double                     instant,
                     double                     factor,
                     Vector                    &force);
} // namespace impm

#endif
