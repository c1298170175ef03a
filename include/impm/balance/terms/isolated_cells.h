#ifndef impm_balance_terms_isolated_cells_h
#define impm_balance_terms_isolated_cells_h

#include <impm/grid/populated_cells.h>
#include <impm/grid/step_constraints.h>

#include <vector>

namespace impm
{
  /**
   * Pieces of material that share no face with any other and that nothing
   * holds in some direction: without inertia they could fly. Returns, by
   * active cell, owned or ghost, whether it belongs to one. Collective.
   */
  template <int dim>
  std::vector<char>
  find_isolated_cells(const PopulatedCells<dim>  &populated,
                      const Discretization<dim>  &discretization,
                      const StepConstraints<dim> &constraints,
                      bool                        axisymmetric);
} // namespace impm

#endif
