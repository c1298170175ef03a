#ifndef impm_materials_hardening_saturating_h
#define impm_materials_hardening_saturating_h

#include <impm/base/exceptions.h>
#include <impm/materials/hardening/linear.h>

#include <cmath>

namespace impm
{
  /**
   * A yield stress that grows linearly with the equivalent plastic strain and
   * by a part that saturates (Voce; Simo & Hughes):
   *
   *   sigma_y + H alpha + (sigma_s - sigma_y) (1 - exp(-delta alpha)).
   */
  struct SaturatingHardening
  {
    static void
    declare_parameters(dealii::ParameterHandler    &prm,
                       const ParameterFile::Chosen &chosen)
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

    static SaturatingHardening
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

    bool
    is_linear() const
    {
      return range * rate == 0;
    }

    /** Yield stress (Pa). */
    template <typename Number>
    Number
    yield_stress(const Number &plastic_strain) const
    {
      const Number on_the_line = linear.yield_stress(plastic_strain);
      return is_linear() ?
               on_the_line :
               Number(on_the_line + range * (1. - remainder(plastic_strain)));
    }

    /** Its slope (Pa). */
    template <typename Number>
    Number
    slope(const Number &plastic_strain) const
    {
      return is_linear() ? Number(linear.modulus) :
                           Number(linear.modulus +
                                  range * rate * remainder(plastic_strain));
    }

    /** Its integral since the start: plastic work (J/m^3). */
    template <typename Number>
    Number
    work(const Number &plastic_strain) const
    {
      const Number on_the_line = linear.work(plastic_strain);
      return is_linear() ?
               on_the_line :
               Number(on_the_line +
                      range * (plastic_strain -
                               (1. - remainder(plastic_strain)) / rate));
    }

    /**
     * How far a point flows whose trial stress is `excess` above its yield
     * stress at `before` and falls by `relief` times the flow: Newton's method,
     * which comes from below, since the yield stress is concave.
     */
    template <typename Number>
    Number
    flow(const Number &excess, const Number &before, const double relief) const
    {
      Number       flow  = excess / (relief + slope(before));
      const Number start = yield_stress(before);
      for (unsigned int i = 0; i < 20 && !is_linear(); ++i)
        {
          const Number end = before + flow;
          const Number rest =
            excess - relief * flow - yield_stress(end) + start;
          flow += rest / (relief + slope(end));
          using std::abs;
          if (all_of(abs(rest) <= 1e-14 * start))
            break;
        }
      return flow;
    }

    LinearHardening linear;
    double          range = 0; ///< of what saturates (Pa)
    double          rate  = 0; ///< its exponent

  private:
    template <typename Number>
    Number
    remainder(const Number &plastic_strain) const
    {
      return each([](const double x) { return std::exp(x); },
                  Number(-rate * plastic_strain));
    }
  };
} // namespace impm

#endif
