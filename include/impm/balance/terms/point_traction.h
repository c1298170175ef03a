#ifndef impm_balance_terms_point_traction_h
#define impm_balance_terms_point_traction_h

#include <impm/points/material_points.h>

#include <string>
#include <vector>

namespace impm
{
  /** The field of the points with the area on which a traction acts (m^2). */
  template <int dim>
  std::string
  traction_field(const TractionSpec<dim> &traction)
  {
    return "traction_area_" + traction.name;
  }

  /**
   * Initial area (m^2) of a point of the traction's body, seen along the
   * normal of the layer; of the whole ring in axisymmetry, per metre of
   * thickness in the plane. Zero where the traction does not act.
   */
  template <int dim>
  double
  traction_area(const TractionSpec<dim> &traction, const Seed<dim> &seed)
  {
    return traction.where->value(seed.position) > 0 ?
             seed.volume / seed.domain[traction.normal] :
             0.;
  }

  /**
   * Number of points that carry each traction. Throws InputError for one
   * without a point. Collective.
   */
  template <int dim>
  std::vector<dealii::types::particle_index>
  count_points_under_tractions(const Tractions<dim>      &tractions,
                               const MaterialPoints<dim> &points);
} // namespace impm

#endif
