#ifndef impm_materials_hardening_entries_h
#define impm_materials_hardening_entries_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/base/lanes.h>
#include <impm/materials/elastic_constants.h>

#include <cmath>
#include <string>

namespace impm
{
  // What several hardenings declare and compute.

  inline void
  declare_yield_stress(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Yield stress",
                      "1e6",
                      dealii::Patterns::Double(1e-300),
                      "Uniaxial stress (Pa; Kirchhoff's in laws of "
                      "logarithmic strains) at which the material starts to "
                      "yield, positive; to be given.");
  }

  inline void
  declare_hardening_exponent(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Hardening exponent",
                      "1",
                      dealii::Patterns::Double(1e-300, 1.),
                      "Of the equivalent plastic strain in the yield stress, "
                      "positive and at most 1.");
  }

  /**
   * Throws InputError for a yield stress that falls by three shear moduli or
   * more (by `slope`, Pa): elastic stress goes down by so much as the point
   * flows, there would be no end of it. Beside the parameters of
   * ElasticConstants.
   */
  inline void
  require_slow_softening(const dealii::ParameterHandler &prm,
                         const ElasticConstants         &elasticity,
                         const double                    slope,
                         const std::string              &entry)
  {
    if (!(slope > -3 * elasticity.shear))
      throw InputError(entry,
                       "found '" + prm.get(entry) +
                         "', allowed is a yield stress that falls by less "
                         "than three shear moduli = " +
                         std::to_string(3 * elasticity.shear) +
                         " Pa, or the stress would fall by itself");
  }

  /** x^exponent. */
  template <typename Number>
  Number
  power(const Number &x, const double exponent)
  {
    return each(
      [exponent](const double one) { return std::pow(one, exponent); }, x);
  }
} // namespace impm

#endif
