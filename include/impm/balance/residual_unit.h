#ifndef impm_balance_residual_unit_h
#define impm_balance_residual_unit_h

#include <impm/footprints/footprints.h>

namespace impm
{
  /**
   * Forces (N) at a strain of one, on every component of the nodes: positive
   * where there is material, but for hanging nodes. Ghosts are up to date.
   * Collective.
   */
  template <int dim>
  Vector
  forces_at_unit_strain(const MaterialPoints<dim> &points,
                        const Footprints<dim>     &footprints,
                        const Discretization<dim> &discretization);

  /** What the norm of residuals is measured in (N). Collective. */
  template <int dim>
  double
  residual_unit(ResidualScale                     scale,
                const Vector                     &unit_strain_forces,
                double                            dt,
                const std::vector<BodySpec<dim>> &bodies,
                const MaterialPoints<dim>        &points,
                const Footprints<dim>            &footprints,
                const Discretization<dim>        &discretization);
} // namespace impm

#endif
