#ifndef impm_grid_criteria_h
#define impm_grid_criteria_h

#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/adaptation.h>

#include <vector>

namespace impm
{
  /** What criteria look at. */
  template <int dim>
  struct GridState
  {
    const BackgroundGrid<dim> &grid;
    const MaterialPoints<dim> &points;
    const RigidBodies<dim>    &rigid;
    double                     time;
    bool has_stresses; ///< of a solution on this grid, not on one before
  };

  /**
   * Raises the levels that a criterion wants its cells to have, by active cell
   * index, of cells that this rank owns. Throws InputError for a field that the
   * points of the scene do not have. Where an expression is not a number,
   * levels stay: the run checks expressions itself. Collective.
   */
  template <int dim>
  void
  raise_levels(const CriterionSpec<dim> &criterion,
               const GridState<dim>     &state,
               std::vector<int>         &levels);
} // namespace impm

#endif
