#ifndef impm_balance_terms_loads_h
#define impm_balance_terms_loads_h

#include <impm/footprints/footprints.h>
#include <impm/grid/populated_cells.h>
#include <impm/scene/scene.h>

namespace impm
{
  /**
   * Forces from outside, which do not depend on the increment: body force,
   * tractions on points (Sulsky & Kaul 2004, eq. 2.2.7, the points of a layer
   * being the quadrature points of the surface) and, with a Lagrangian grid, on
   * faces of the domain that have material behind them. Tractions are forces
   * per area as it was made, whose direction does not follow the material.
   */
  template <int dim>
  struct Loads
  {
    /** For the step from one time to another. Collective. */
    Loads(const Scene<dim>          &scene,
          const BackgroundGrid<dim> &grid,
          const MaterialPoints<dim> &points,
          const Footprints<dim>     &footprints,
          const PopulatedCells<dim> &populated,
          const Discretization<dim> &discretization,
          double                     from,
          double                     to);

    /** Minus the forces at the start and at the end of the step (N), with
     * nothing at hanging nodes. */
    Vector at_start, at_end;
  };
} // namespace impm

#endif
