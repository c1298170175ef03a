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


  LogStrainElastic::LogStrainElastic(const HenckyElasticity &elasticity,
                                     const double            density)
    : Material(density)
    , elasticity(elasticity)
  {}


  void
  LogStrainElastic::declare_parameters(dealii::ParameterHandler &prm)
  {
    HenckyElasticity::declare_parameters(prm);
    declare_density(prm);
  }


  std::unique_ptr<Material>
  LogStrainElastic::create(dealii::ParameterHandler &prm)
  {
    return std::make_unique<LogStrainElastic>(
      HenckyElasticity::from_parameters(prm), prm.get_double("Density"));
  }


  void
  LogStrainElastic::declare_history(PointLayout &)
  {}


  void
  LogStrainElastic::initialize_history(double *) const
  {}


  bool
  LogStrainElastic::evaluate(const Deformation &deformation,
                             const double *,
                             double *,
                             const bool with_tangent,
                             Response  &response) const
  {
    // b does not tell a body from its mirror image, J does
    LogStrain::PrincipalStrains principal;
    if (!(dealii::determinant(deformation.total) > 0.) ||
        !LogStrain::decompose(dealii::Physics::Elasticity::Kinematics::b(
                                deformation.total),
                              principal))
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


  double
  LogStrainElastic::stiffness() const
  {
    return elasticity.young;
  }


  double
  LogStrainElastic::wave_speed() const
  {
    return elasticity.wave_speed(density);
  }
} // namespace impm
