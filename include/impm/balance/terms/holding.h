#ifndef impm_balance_terms_holding_h
#define impm_balance_terms_holding_h

#include <impm/balance/terms/isolated_cells.h>
#include <impm/balance/terms/term.h>

namespace impm
{
  /**
   * Springs that hold the nodes of isolated pieces of material, which could fly
   * where there is no inertia.
   */
  template <int dim>
  class Holding : public Term
  {
  public:
    /** `factor` in units of Young's modulus. Collective. */
    Holding(const MaterialPoints<dim>  &points,
            const Footprints<dim>      &footprints,
            const PopulatedCells<dim>  &populated,
            const Discretization<dim>  &discretization,
            const StepConstraints<dim> &constraints,
            double                      factor);

    void
    add_force(const Vector &u, Vector &force) const override;

    double
    energy(const Vector &u) const override;

    void
    apply(const Vector &direction, Vector &image) const override;

    void
    add_diagonal(Vector &diagonal) const override;

    unsigned int n_cells = 0; ///< that are held, of all ranks

  private:
    Vector stiffness; ///< (N/m)
  };
} // namespace impm

#endif
