#include <deal.II/base/parameter_handler.h>

#include <impm/materials/neo_hookean.h>

#include <cmath>
#include <limits>

namespace impm
{
  namespace
  {
    /** volumetric 1 x 1 + shear times the symmetric identity. */
    dealii::SymmetricTensor<4, 3>
    isotropic_tensor(const double volumetric, const double shear)
    {
      const auto unit = dealii::unit_symmetric_tensor<3>();
      return volumetric * dealii::outer_product(unit, unit) +
             shear * dealii::identity_tensor<3>();
    }
  } // namespace


  NeoHookean::NeoHookean(const ElasticConstants &constants,
                         const double            density)
    : Material(density)
    , constants(constants)
  {}


  void
  NeoHookean::declare_history(PointLayout &)
  {}


  void
  NeoHookean::initialize_history(double *) const
  {}


  bool
  NeoHookean::measure(const dealii::Tensor<2, 3> &F, Strain &strain)
  {
    const double J = dealii::determinant(F);
    if (!(J > 0.))
      return false;

    // In terms of H = F - 1, so that small strains keep all of their digits.
    dealii::Tensor<2, 3> H = F;
    for (unsigned int d = 0; d < 3; ++d)
      H[d][d] -= 1.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        strain.b_minus_1[i][j] = H[i][j] + H[j][i] + H[i] * H[j];

    const double trace  = dealii::trace(H);
    const double second = H[0][0] * H[1][1] - H[0][1] * H[1][0] +
                          H[1][1] * H[2][2] - H[1][2] * H[2][1] +
                          H[2][2] * H[0][0] - H[2][0] * H[0][2];
    const double J_minus_1 = trace + second + dealii::determinant(H);
    strain.log_J =
      std::abs(J_minus_1) < 0.5 ? std::log1p(J_minus_1) : std::log(J);
    return true;
  }


  bool
  NeoHookean::evaluate(const Deformation &deformation,
                       const double *,
                       double *,
                       const bool with_tangent,
                       Response  &response) const
  {
    Strain strain;
    if (!measure(deformation.total, strain))
      return false;
    response.potential = potential(strain);
    respond(strain, with_tangent, response);
    return std::isfinite(response.potential);
  }


  Material::Energy
  NeoHookean::energy(const dealii::Tensor<2, 3> &deformation_gradient,
                     const double *) const
  {
    Energy result;
    Strain strain;
    result.stored = measure(deformation_gradient, strain) ?
                      potential(strain) :
                      std::numeric_limits<double>::quiet_NaN();
    return result;
  }


  double
  NeoHookean::stiffness() const
  {
    return constants.young;
  }


  double
  NeoHookean::wave_speed() const
  {
    return constants.wave_speed(density);
  }


  void
  CoupledNeoHookean::declare_parameters(dealii::ParameterHandler &prm)
  {
    ElasticConstants::declare_parameters(prm);
    declare_density(prm);
  }


  std::unique_ptr<Material>
  CoupledNeoHookean::create(dealii::ParameterHandler &prm)
  {
    return std::make_unique<CoupledNeoHookean>(
      ElasticConstants::from_parameters(prm), prm.get_double("Density"));
  }


  double
  CoupledNeoHookean::potential(const Strain &strain) const
  {
    return 0.5 * constants.shear *
             (dealii::trace(strain.b_minus_1) - 2. * strain.log_J) +
           0.5 * constants.lame() * strain.log_J * strain.log_J;
  }


  void
  CoupledNeoHookean::respond(const Strain &strain,
                             const bool    with_tangent,
                             Response     &response) const
  {
    const double pressure     = constants.lame() * strain.log_J;
    response.kirchhoff_stress = constants.shear * strain.b_minus_1 +
                                pressure * dealii::unit_symmetric_tensor<3>();
    if (with_tangent)
      response.tangent =
        isotropic_tensor(constants.lame(), 2. * (constants.shear - pressure));
  }


  void
  DecoupledNeoHookean::declare_parameters(dealii::ParameterHandler &prm)
  {
    ElasticConstants::declare_choice(prm);
    declare_density(prm);
  }


  std::unique_ptr<Material>
  DecoupledNeoHookean::create(dealii::ParameterHandler &prm)
  {
    return std::make_unique<DecoupledNeoHookean>(
      ElasticConstants::from_choice(prm), prm.get_double("Density"));
  }


  double
  DecoupledNeoHookean::potential(const Strain &strain) const
  {
    // J^(-2/3) - 1
    const double shrink = std::expm1(-2. / 3. * strain.log_J);
    const double trace  = dealii::trace(strain.b_minus_1);
    return 0.5 * constants.shear * (3. * shrink + trace + shrink * trace) +
           0.5 * constants.bulk * strain.log_J * strain.log_J;
  }


  void
  DecoupledNeoHookean::respond(const Strain &strain,
                               const bool    with_tangent,
                               Response     &response) const
  {
    const auto   unit     = dealii::unit_symmetric_tensor<3>();
    const double shear    = constants.shear * std::exp(-2. / 3. * strain.log_J);
    const double pressure = constants.bulk * strain.log_J;
    const auto   deviator = shear * dealii::deviator(strain.b_minus_1);

    response.kirchhoff_stress = deviator + pressure * unit;
    if (with_tangent)
      {
        // eq. 21 times J, where the mu of 2 mu [...] is G tr(b) / (3 J^(2/3))
        const double mu  = shear * (1. + dealii::trace(strain.b_minus_1) / 3.);
        response.tangent = isotropic_tensor(constants.bulk - 2. / 3. * mu,
                                            2. * (mu - pressure)) -
                           2. / 3. *
                             (dealii::outer_product(deviator, unit) +
                              dealii::outer_product(unit, deviator));
      }
  }
} // namespace impm
