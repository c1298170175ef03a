#ifndef impm_balance_terms_isolated_cells_h
#define impm_balance_terms_isolated_cells_h

#include <impm/grid/populated_cells.h>
#include <impm/grid/step_constraints.h>

namespace impm
{
  /**
   * Pieces of material that share no face with any other and that nothing
   * holds in some direction: without inertia they could fly. Springs hold
   * their nodes.
   */
  template <int dim>
  struct IsolatedCells
  {
    /** For a `factor` in units of Young's modulus. Collective. */
    IsolatedCells(const MaterialPoints<dim>  &points,
                  const Footprints<dim>      &footprints,
                  const PopulatedCells<dim>  &populated,
                  const Discretization<dim>  &discretization,
                  const StepConstraints<dim> &constraints,
                  double                      factor);

    unsigned int n = 0;     ///< of all ranks
    Vector       stiffness; ///< of the springs (N/m)
  };
} // namespace impm

#endif
