#include <deal.II/physics/elasticity/kinematics.h>

#include <impm/materials/log_strain_elastic.h>

#include <cmath>
#include <limits>

namespace impm
{
  HenckyElasticity
  HenckyElasticity::from_parameters(dealii::ParameterHandler &prm)
  {
    return HenckyElasticity(ElasticConstants::from_parameters(prm));
  }


  LogStrainElastic::LogStrainElastic(const MaterialSpec     &spec,
                                     const HenckyElasticity &elasticity)
    : PointwiseLaw(spec, elasticity.young, elasticity.longitudinal_modulus())
    , elasticity(elasticity)
  {}


  void
  LogStrainElastic::declare_parameters(dealii::ParameterHandler &prm)
  {
    HenckyElasticity::declare_parameters(prm);
    declare_density(prm);
  }


  std::unique_ptr<const Material>
  LogStrainElastic::create(dealii::ParameterHandler &prm,
                           const MaterialSpec       &spec,
                           PointLayout &)
  {
    return std::make_unique<LogStrainElastic>(
      spec, HenckyElasticity::from_parameters(prm));
  }


  bool
  LogStrainElastic::evaluate_point(const Step &step,
                                   const bool  with_tangent,
                                   Response   &response) const
  {
    // b does not tell a body from its mirror image, J does
    LogStrain::PrincipalStrains principal;
    if (!(dealii::determinant(step.total) > 0.) ||
        !LogStrain::decompose(
          dealii::Physics::Elasticity::Kinematics::b(step.total), principal))
      return false;

    const auto stress         = elasticity.stress(principal.strain);
    response.kirchhoff_stress = LogStrain::compose(stress.stress, principal);
    response.potential        = elasticity.energy(principal.strain);
    if (with_tangent)
      LogStrain::lie_tangent(principal, stress, response.tangent);
    return std::isfinite(response.potential);
  }


  Material::Energy
  LogStrainElastic::energy(const dealii::Tensor<2, 3> &deformation_gradient,
                           const double *) const
  {
    Energy                      result;
    LogStrain::PrincipalStrains principal;
    result.stored =
      LogStrain::decompose(dealii::Physics::Elasticity::Kinematics::b(
                             deformation_gradient),
                           principal) ?
        elasticity.energy(principal.strain) :
        std::numeric_limits<double>::quiet_NaN();
    return result;
  }
} // namespace impm
