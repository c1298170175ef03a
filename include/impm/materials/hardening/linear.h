#ifndef impm_materials_hardening_linear_h
#define impm_materials_hardening_linear_h

#include <impm/input/parameter_file.h>
#include <impm/materials/hardening/entries.h>

namespace impm
{
  /**
   * A yield stress that is linear in the equivalent plastic strain:
   *
   *   sigma_y + H alpha.
   */
  struct LinearHardening
  {
    static constexpr const char *name = "linear";

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      declare_yield_stress(prm);
      prm.declare_entry("Hardening modulus",
                        "0",
                        dealii::Patterns::Double(0.),
                        "Slope (Pa) of the yield stress over the equivalent "
                        "plastic strain, not negative; 0: perfectly plastic.");
    }

    static LinearHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      return {prm.get_double("Yield stress"),
              prm.get_double("Hardening modulus")};
    }

    /** Yield stress (Pa). */
    template <typename Number>
    Number
    yield_stress(const Number &plastic_strain) const
    {
      return initial + modulus * plastic_strain;
    }

    /** Its slope (Pa). */
    template <typename Number>
    Number
    slope(const Number &) const
    {
      return modulus;
    }

    /** Its integral since the start: plastic work (J/m^3). */
    template <typename Number>
    Number
    work(const Number &plastic_strain) const
    {
      return (initial + 0.5 * modulus * plastic_strain) * plastic_strain;
    }

    double initial; ///< yield stress (Pa, > 0)
    double modulus; ///< its slope (Pa, >= 0)
  };
} // namespace impm

#endif
