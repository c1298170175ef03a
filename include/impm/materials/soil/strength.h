#ifndef impm_materials_soil_strength_h
#define impm_materials_soil_strength_h

#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/input/parameter_file.h>
#include <impm/materials/log_strain.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace impm
{
  /** The constants of what holds together by friction and cohesion. */
  struct SoilStrength
  {
    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      using dealii::Patterns::Double;
      prm.declare_entry("Cohesion",
                        "0",
                        Double(0.),
                        "c (Pa), not negative: strength in shear without any "
                        "pressure.");
      prm.declare_entry("Friction angle",
                        "30",
                        Double(0., 89.),
                        "phi (degrees), from 0 to 89.");
      prm.declare_entry(
        "Dilation angle",
        "0",
        Double(0., 89.),
        "psi (degrees), from 0 to the friction angle: how the "
        "volume grows while the soil is sheared. With psi = phi "
        "the flow is associated and the tangent symmetric.");
      prm.declare_entry("Tension cut-off",
                        "",
                        dealii::Patterns::List(Double(0.), 0, 1),
                        "Tensile stress that the soil bears at most (Pa), up "
                        "to c / tan phi, which it is when empty.");
      prm.declare_entry("Cohesion hardening",
                        "0",
                        Double(),
                        "By how much the cohesion grows over the equivalent "
                        "plastic strain (Pa), first order in the step; where "
                        "negative, it falls until it is 0.");
    }

    /** Throws InputError when they contradict each other. */
    static SoilStrength
    from_parameters(dealii::ParameterHandler &prm)
    {
      constexpr double degree = dealii::numbers::PI / 180;
      SoilStrength     result;
      result.cohesion  = prm.get_double("Cohesion");
      result.friction  = prm.get_double("Friction angle") * degree;
      result.dilation  = prm.get_double("Dilation angle") * degree;
      result.hardening = prm.get_double("Cohesion hardening");
      if (!(result.cohesion > 0) && !(result.friction > 0))
        throw InputError("Cohesion",
                         "found '" + prm.get("Cohesion") +
                           "', allowed is more than 0 where 'Friction angle' "
                           "is 0, or there would be no strength at all");
      if (result.dilation > result.friction)
        throw InputError("Dilation angle",
                         "found '" + prm.get("Dilation angle") +
                           "', allowed is up to 'Friction angle' = " +
                           prm.get("Friction angle") +
                           ", or flow would create energy");
      const std::string cut_off = prm.get("Tension cut-off");
      if (!cut_off.empty())
        {
          const double apex = result.tensile_limit(result.cohesion);
          result.cut_off    = prm.get_double("Tension cut-off");
          if (result.cut_off > apex)
            throw InputError("Tension cut-off",
                             "found '" + cut_off +
                               "', allowed is up to 'Cohesion' over the "
                               "tangent of 'Friction angle', " +
                               std::to_string(apex) +
                               ", where the strength ends anyway, or nothing");
        }
      return result;
    }

    /** Cohesion (Pa) after an equivalent plastic strain. */
    double
    cohesion_after(const double plastic_strain) const
    {
      return std::max(0., cohesion + hardening * plastic_strain);
    }

    /** Largest tensile stress (Pa) with a cohesion; may be infinite. */
    double
    tensile_limit(const double cohesion) const
    {
      return friction > 0 ? std::min(cut_off, cohesion / std::tan(friction)) :
                            cut_off;
    }

    double cohesion  = 0; ///< c (Pa)
    double friction  = 0; ///< phi (radians)
    double dilation  = 0; ///< psi (radians), at most phi
    double hardening = 0; ///< dc over the equivalent plastic strain (Pa)

    /** (Pa); not less than the apex: there is none. */
    double cut_off = std::numeric_limits<double>::infinity();
  };

  /** The end of a step in principal strains. */
  struct SoilReturn
  {
    bool flows; ///< or all is elastic
    /** Moduli and secants are over the trial strains. */
    LogStrain::PrincipalStress<double> response;
    LogStrain::Triple<double>          elastic_strain; ///< at the end (-)
  };
} // namespace impm

#endif
