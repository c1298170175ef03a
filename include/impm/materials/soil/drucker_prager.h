#ifndef impm_materials_soil_drucker_prager_h
#define impm_materials_soil_drucker_prager_h

#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/soil/strength.h>

#include <cmath>
#include <string>
#include <utility>

namespace impm
{
  /**
   * D. C. Drucker and W. Prager's cone around Mohr and Coulomb's pyramid, with
   * p = tr tau / 3, s = sqrt(dev tau : dev tau / 2),
   *
   *   s + eta p <= xi c,   flow along s + eta_psi p,
   *
   * and a cut-off p <= T of the mean stress, whose flow is a change of volume
   * only. Without one T is the stress at the apex, c / tan phi. Match says
   * where the cone meets the pyramid:
   *
   *   outer         eta = 6 sin phi / (sqrt 3 (3 - sin phi)), compression
   *   inner         eta = 6 sin phi / (sqrt 3 (3 + sin phi)), extension
   *   plane strain  eta = 3 tan phi / sqrt(9 + 12 tan^2 phi), the load that a
   *                 body bears there if the flow is associated
   *
   * xi = eta / tan phi, and eta_psi is eta of the dilation angle. Backward
   * Euler in closed form. E. A. de Souza Neto, D. Peric & D. R. J. Owen,
   * Computational Methods for Plasticity (2008), sections 6.4.4 and 8.3.
   */
  struct DruckerPrager : public SoilStrength
  {
    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
    {
      SoilStrength::declare_parameters(prm, chosen);
      prm.declare_entry("Match",
                        "outer",
                        dealii::Patterns::Selection("outer|inner|plane strain"),
                        "Where the cone is as strong as Mohr and Coulomb: in "
                        "triaxial compression, in triaxial extension, or in "
                        "plane strain.");
    }

    static DruckerPrager
    from_parameters(dealii::ParameterHandler &prm)
    {
      return DruckerPrager(SoilStrength::from_parameters(prm),
                           prm.get("Match"));
    }

    DruckerPrager(const SoilStrength &strength, const std::string &match)
      : SoilStrength(strength)
      , slope(cone(friction, match).first)
      , share(cone(friction, match).second)
      , flow_slope(cone(dilation, match).first)
    {}

    /**
     * Brings what is that of elasticity to the limit, if it is beyond. With a
     * cohesion (Pa). Returns whether it could.
     */
    bool
    project(const HenckyElasticity &elasticity,
            const double            cohesion,
            SoilReturn             &end) const
    {
      auto        &response = end.response;
      const double K = elasticity.bulk, G = elasticity.shear;
      const double mean =
        (response.stress[0] + response.stress[1] + response.stress[2]) / 3.;
      LogStrain::Triple<double> deviator;
      double                    squares = 0;
      for (unsigned int a = 0; a < 3; ++a)
        {
          deviator[a] = response.stress[a] - mean;
          squares += 0.5 * deviator[a] * deviator[a];
        }
      const double shear   = std::sqrt(squares);
      const double tension = tensile_limit(cohesion);
      const double limit   = share * cohesion;
      const double excess  = shear + slope * mean - limit;
      if (excess <= 0 && mean <= tension)
        return true;

      // Where it ends, and how that follows strains: by the trace and by the
      // direction of the deviator.
      const double resistance     = G + K * slope * flow_slope;
      double       flow           = excess / resistance;
      double       end_mean       = mean - K * flow_slope * flow;
      double       end_shear      = limit - slope * end_mean;
      double       mean_by_volume = 0, mean_by_shear = 0, shear_by_volume = 0,
             shear_by_shear = 0;
      if (excess > 0 && end_mean <= tension)
        {
          mean_by_volume  = K - K * flow_slope * slope * K / resistance;
          mean_by_shear   = -K * flow_slope * G / resistance;
          shear_by_volume = -slope * mean_by_volume;
          shear_by_shear  = -slope * mean_by_shear;
        }
      else
        {
          end_mean             = tension;
          const double corner  = std::max(0., limit - slope * tension);
          const bool   on_cone = shear >= corner;
          end_shear            = on_cone ? corner : shear;
          shear_by_shear       = on_cone ? 0. : G;
        }

      end.flows          = true;
      const double size  = shear > 0 ? shear : 1.;
      const double scale = shear > 0 ? end_shear / shear : 0.;
      for (unsigned int a = 0; a < 3; ++a)
        {
          const double along = deviator[a] / size;
          response.stress[a] = end_mean + end_shear * along;
          for (unsigned int b = 0; b < 3; ++b)
            {
              const double across = deviator[b] / size;
              response.moduli[a][b] =
                mean_by_volume + mean_by_shear * across +
                along * (shear_by_volume + shear_by_shear * across) +
                scale * G * ((a == b ? 2. : 0.) - 2. / 3. - along * across);
            }
        }
      response.secant.fill(2. * G * scale);
      end.elastic_strain = elasticity.strain(response.stress);
      return true;
    }

  private:
    /** eta and xi of an angle. */
    static std::pair<double, double>
    cone(const double angle, const std::string &match)
    {
      const double sine = std::sin(angle), cosine = std::cos(angle);
      const double per_sine =
        match == "outer" ?
          6. / (std::sqrt(3.) * (3. - sine)) :
        match == "inner" ?
          6. / (std::sqrt(3.) * (3. + sine)) :
          3. / std::sqrt(9. * cosine * cosine + 12. * sine * sine);
      return {per_sine * sine, per_sine * cosine};
    }

    double slope;      ///< eta
    double share;      ///< xi
    double flow_slope; ///< eta of the dilation angle
  };
} // namespace impm

#endif
