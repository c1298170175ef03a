#ifndef impm_balance_terms_point_traction_h
#define impm_balance_terms_point_traction_h

#include <impm/footprints/footprints.h>

namespace impm
{
  /** The field of the points with the area on which a traction acts (m^2). */
  template <int dim>
  std::string
  traction_field(const TractionSpec<dim> &traction);

  /**
   * Initial area (m^2) of a point of the traction's body, seen along the
   * normal of the layer; of the whole ring in axisymmetry, per metre of
   * thickness in the plane. Zero where the traction does not act.
   */
  template <int dim>
  double
  traction_area(const TractionSpec<dim> &traction, const Seed<dim> &seed);

  /** Number of points that carry each traction. Collective. */
  template <int dim>
  std::vector<dealii::types::particle_index>
  count_points_under_tractions(const Tractions<dim>      &tractions,
                               const MaterialPoints<dim> &points);

  /** Throws InputError for a traction without a point. Collective. */
  template <int dim>
  void
  check_tractions(const Tractions<dim>      &tractions,
                  const MaterialPoints<dim> &points);

  /**
   * Adds `factor` times the nodal forces (N) of the tractions on points at an
   * instant (Sulsky & Kaul 2004, eq. 2.2.7, the points of a layer being the
   * quadrature points of the surface): dead loads. Ghosts are not summed.
   */
  template <int dim>
  void
  add_point_tractions(const Tractions<dim>      &tractions,
                      const MaterialPoints<dim> &points,
                      const Footprints<dim>     &footprints,
                      double                     instant,
                      double                     factor,
                      Vector                    &force);
} // namespace impm

#endif
