#ifndef impm_materials_hardening_swift_h
#define impm_materials_hardening_swift_h

#include <impm/input/parameter_file.h>
#include <impm/materials/hardening/entries.h>

#include <cmath>

namespace impm
{
  /**
   * A power of the equivalent plastic strain behind a strain of the past (H. W.
   * Swift, J. Mech. Phys. Solids 1 (1952) 1-18):
   *
   *   sigma_y (1 + alpha / alpha_0)^n.
   */
  struct SwiftHardening
  {
    static constexpr const char *name = "Swift";

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      declare_yield_stress(prm);
      declare_hardening_exponent(prm);
      prm.declare_entry("Reference strain",
                        "1",
                        dealii::Patterns::Double(1e-300),
                        "Equivalent plastic strain that makes a yield stress "
                        "2^n times the initial one, positive.");
    }

    static SwiftHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      return {prm.get_double("Yield stress"),
              prm.get_double("Reference strain"),
              prm.get_double("Hardening exponent")};
    }

    /** Yield stress (Pa). */
    template <typename Number>
    Number
    yield_stress(const Number &plastic_strain) const
    {
      return initial * power(Number(1. + plastic_strain / reference), exponent);
    }

    /** Its slope (Pa). */
    template <typename Number>
    Number
    slope(const Number &plastic_strain) const
    {
      return initial * exponent / reference *
             power(Number(1. + plastic_strain / reference), exponent - 1.);
    }

    /** Its integral since the start: plastic work (J/m^3). */
    template <typename Number>
    Number
    work(const Number &plastic_strain) const
    {
      // small strains do not cancel
      const auto gained = [n = exponent + 1.](const double strain) {
        return std::expm1(n * std::log1p(strain));
      };
      return initial * reference / (exponent + 1.) *
             each(gained, Number(plastic_strain / reference));
    }

    double initial;   ///< yield stress (Pa, > 0)
    double reference; ///< strain alpha_0, > 0
    double exponent;  ///< n, 0 < n <= 1
  };
} // namespace impm

#endif
