#ifndef impm_balance_terms_isolated_cells_h
#define impm_balance_terms_isolated_cells_h

#include <impm/grid/populated_cells.h>
#include <impm/grid/step_constraints.h>

#include <map>
#include <vector>

namespace impm
{
  /**
   * Pieces of material that share no face with any other and that nothing
   * holds in some direction: without inertia they could fly. Springs hold
   * their nodes in these directions.
   */
  template <int dim>
  class IsolatedCells
  {
  public:
    /** For a `factor` in units of Young's modulus. Collective. */
    IsolatedCells(const MaterialPoints<dim>  &points,
                  const Footprints<dim>      &footprints,
                  const PopulatedCells<dim>  &populated,
                  const Discretization<dim>  &discretization,
                  const StepConstraints<dim> &constraints,
                  double                      factor);

    /**
     * What the forces of the springs add up to (N), of each piece the resultant
     * and, over its radius of gyration, the moment about axes about which it
     * may turn: what loads would move it by. Collective.
     */
    double
    resultants(const Vector &forces) const;

    unsigned int n = 0;     ///< of all ranks
    Vector       stiffness; ///< of the springs (N/m)

  private:
    /** Axes along which something holds a piece, as bits, by its number. */
    std::vector<unsigned int> held;
    /** Owned nodes with springs, and the numbers of their pieces. */
    std::map<unsigned int, unsigned int> piece_of_node;
    const Discretization<dim>           &discretization;
  };
} // namespace impm

#endif
