#ifndef impm_materials_log_strain_elastic_h
#define impm_materials_log_strain_elastic_h

#include <deal.II/base/parameter_handler.h>

#include <impm/materials/elastic_constants.h>
#include <impm/materials/log_strain.h>
#include <impm/materials/pointwise_law.h>

#include <array>
#include <memory>

namespace impm
{
  /**
   * H. Hencky's elasticity: quadratic in the principal logarithmic strains,
   *
   *   psi = K / 2 (tr eps)^2 + G |dev eps|^2   per initial volume,
   *   tau = K tr eps 1 + 2 G dev eps.
   */
  class HenckyElasticity : public ElasticConstants
  {
  public:
    using ElasticConstants::ElasticConstants;

    static HenckyElasticity
    from_parameters(dealii::ParameterHandler &prm);

    /** psi (J/m^3) of principal strains. */
    double
    energy(const std::array<double, 3> &strain) const;

    /** tau_a and what goes with them, of principal strains. */
    LogStrain::PrincipalStress
    stress(const std::array<double, 3> &strain) const;

  private:
    explicit HenckyElasticity(const ElasticConstants &constants)
      : ElasticConstants(constants)
    {}
  };


  /** Hencky's elasticity from the total deformation; keeps no history. */
  class LogStrainElastic final : public PointwiseLaw<LogStrainElastic>
  {
  public:
    LogStrainElastic(const MaterialSpec     &spec,
                     const HenckyElasticity &elasticity);

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<const Material>
    create(dealii::ParameterHandler &prm,
           const MaterialSpec       &spec,
           PointLayout              &history);

    bool
    evaluate_point(const Step &step,
                   bool        with_tangent,
                   Response   &response) const;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

  private:
    const HenckyElasticity elasticity;
  };


  inline double
  HenckyElasticity::energy(const std::array<double, 3> &strain) const
  {
    const double volumetric = strain[0] + strain[1] + strain[2];
    double       squares    = 0.;
    for (const double e : strain)
      squares += (e - volumetric / 3.) * (e - volumetric / 3.);
    return 0.5 * bulk * volumetric * volumetric + shear * squares;
  }

  inline LogStrain::PrincipalStress
  HenckyElasticity::stress(const std::array<double, 3> &strain) const
  {
    LogStrain::PrincipalStress result;
    const double               volumetric = strain[0] + strain[1] + strain[2];
    for (unsigned int a = 0; a < 3; ++a)
      {
        result.stress[a] =
          bulk * volumetric + 2. * shear * (strain[a] - volumetric / 3.);
        result.moduli[a].fill(lame());
        result.moduli[a][a] += 2. * shear;
      }
    result.secant.fill(2. * shear);
    return result;
  }
} // namespace impm

#endif
