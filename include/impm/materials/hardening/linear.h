#ifndef impm_materials_hardening_linear_h
#define impm_materials_hardening_linear_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/input/parameter_file.h>

namespace impm
{
  /** A yield stress that is linear in the equivalent plastic strain. */
  struct LinearHardening
  {
    static void
    declare_parameters(dealii::ParameterHandler &prm,
                       const ParameterFile::Chosen &)
    {
      prm.declare_entry("Yield stress",
                        "1e6",
                        dealii::Patterns::Double(1e-300),
                        "Uniaxial stress (Pa; Kirchhoff's in laws of "
                        "logarithmic strains) at which the material starts to "
                        "yield, positive.");
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
