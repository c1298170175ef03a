#ifndef impm_materials_hardening_voce_h
#define impm_materials_hardening_voce_h

#include <impm/base/exceptions.h>
#include <impm/materials/hardening/linear.h>

#include <cmath>

namespace impm
{
  /**
   * A yield stress that grows linearly with the equivalent plastic strain and
   * by a part that saturates (E. Voce, J. Inst. Metals 74 (1948) 537; with both
   * parts J. C. Simo, CMAME 66 (1988) 199):
   *
   *   sigma_y + H alpha + (sigma_s - sigma_y) (1 - exp(-delta alpha)).
   */
  struct VoceHardening
  {
    static constexpr const char *name = "Voce";

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
    {
      LinearHardening::declare_parameters(prm, chosen);
      prm.declare_entry("Saturation stress",
                        "0",
                        dealii::Patterns::Double(0.),
                        "Yield stress (Pa) that the part which saturates goes "
                        "to, above 'Yield stress'; 0: there is none.");
      prm.declare_entry("Saturation rate",
                        "0",
                        dealii::Patterns::Double(0.),
                        "How fast it does: exponent over the equivalent "
                        "plastic strain.");
    }

    static VoceHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      const auto   linear     = LinearHardening::from_parameters(prm);
      const double saturation = prm.get_double("Saturation stress");
      if (saturation > 0 && saturation < linear.initial)
        throw InputError("Saturation stress", "is below 'Yield stress'");
      return {linear,
              saturation > 0 ? saturation - linear.initial : 0.,
              prm.get_double("Saturation rate")};
    }

    /** Yield stress (Pa). */
    template <typename Number>
    Number
    yield_stress(const Number &plastic_strain) const
    {
      return linear.yield_stress(plastic_strain) +
             range * saturated(plastic_strain);
    }

    /** Its slope (Pa). */
    template <typename Number>
    Number
    slope(const Number &plastic_strain) const
    {
      return linear.modulus + range * rate * (1. - saturated(plastic_strain));
    }

    /** Its integral since the start: plastic work (J/m^3). */
    template <typename Number>
    Number
    work(const Number &plastic_strain) const
    {
      const Number on_the_line = linear.work(plastic_strain);
      return rate == 0 ?
               on_the_line :
               Number(on_the_line + range * (plastic_strain -
                                             saturated(plastic_strain) / rate));
    }

    LinearHardening linear;
    double          range = 0; ///< of what saturates (Pa)
    double          rate  = 0; ///< its exponent

  private:
    /** The share that has done so. */
    template <typename Number>
    Number
    saturated(const Number &plastic_strain) const
    {
      return 1. - each([](const double x) { return std::exp(x); },
                       Number(-rate * plastic_strain));
    }
  };
} // namespace impm

#endif
