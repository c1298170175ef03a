#ifndef impm_materials_hardening_bilinear_h
#define impm_materials_hardening_bilinear_h

#include <impm/materials/hardening/linear.h>
#include <impm/materials/hardening/piecewise_linear.h>

#include <vector>

namespace impm
{
  /**
   * A yield stress that grows up to a limit strain, falls behind it, and stays
   * where it reaches zero (Sulsky & Kaul 2004, eq. 2.1.19).
   */
  class BilinearHardening : public PiecewiseLinearHardening
  {
  public:
    static constexpr const char *name = "bilinear";

    /**
     * Behind the limit strain (> 0) it falls with the softening modulus (Pa,
     * >= 0).
     */
    BilinearHardening(const LinearHardening &linear,
                      const double           limit_strain,
                      const double           softening)
      : PiecewiseLinearHardening(points(linear, limit_strain, softening))
    {}

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
    {
      LinearHardening::declare_parameters(prm, chosen);
      prm.declare_entry("Limit strain",
                        "1",
                        dealii::Patterns::Double(1e-300),
                        "Equivalent plastic strain behind which the material "
                        "softens, positive.");
      prm.declare_entry("Softening modulus",
                        "0",
                        dealii::Patterns::Double(0.),
                        "How fast the yield stress falls behind the limit "
                        "strain (Pa), less than three shear moduli; it stays "
                        "where it reaches zero.");
    }

    /** Beside the parameters of ElasticConstants. */
    static BilinearHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      const double softening = prm.get_double("Softening modulus");
      require_slow_softening(prm,
                             ElasticConstants::from_parameters(prm),
                             -softening,
                             "Softening modulus");
      return {LinearHardening::from_parameters(prm),
              prm.get_double("Limit strain"),
              softening};
    }

  private:
    static std::vector<Point>
    points(const LinearHardening &linear,
           const double           limit_strain,
           const double           softening)
    {
      const double       highest = linear.yield_stress(limit_strain);
      std::vector<Point> result  = {{0., linear.initial},
                                    {limit_strain, highest}};
      if (softening > 0)
        result.emplace_back(limit_strain + highest / softening, 0.);
      return result;
    }
  };
} // namespace impm

#endif
