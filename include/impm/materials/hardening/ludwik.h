#ifndef impm_materials_hardening_ludwik_h
#define impm_materials_hardening_ludwik_h

#include <impm/input/parameter_file.h>
#include <impm/materials/hardening/entries.h>

namespace impm
{
  /**
   * A power of the equivalent plastic strain (P. Ludwik, Elemente der
   * technologischen Mechanik, Springer 1909):
   *
   *   sigma_y + K alpha^n,
   *
   * with an infinite slope at the start where n < 1.
   */
  struct LudwikHardening
  {
    static constexpr const char *name = "Ludwik";

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      declare_yield_stress(prm);
      declare_hardening_exponent(prm);
      prm.declare_entry("Strength coefficient",
                        "0",
                        dealii::Patterns::Double(0.),
                        "What the yield stress has gained (Pa) at an "
                        "equivalent plastic strain of 1, not negative.");
    }

    static LudwikHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      return {prm.get_double("Yield stress"),
              prm.get_double("Strength coefficient"),
              prm.get_double("Hardening exponent")};
    }

    /** Yield stress (Pa). */
    template <typename Number>
    Number
    yield_stress(const Number &plastic_strain) const
    {
      return initial + strength * power(plastic_strain, exponent);
    }

    /** Its slope (Pa). */
    template <typename Number>
    Number
    slope(const Number &plastic_strain) const
    {
      return strength == 0 ? Number(0.) :
                             Number(strength * exponent *
                                    power(plastic_strain, exponent - 1.));
    }

    /** Its integral since the start: plastic work (J/m^3). */
    template <typename Number>
    Number
    work(const Number &plastic_strain) const
    {
      return (initial +
              strength / (exponent + 1.) * power(plastic_strain, exponent)) *
             plastic_strain;
    }

    double initial;  ///< yield stress (Pa, > 0)
    double strength; ///< K (Pa, >= 0)
    double exponent; ///< n, 0 < n <= 1
  };
} // namespace impm

#endif
