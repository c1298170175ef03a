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


  template <bool decoupled>
  NeoHookean<decoupled>::NeoHookean(const MaterialSpec     &spec,
                                    const ElasticConstants &constants)
    : PointwiseLaw<NeoHookean>(spec,
                               constants.young,
                               constants.longitudinal_modulus())
    , constants(constants)
  {}


  template <bool decoupled>
  void
  NeoHookean<decoupled>::declare_parameters(dealii::ParameterHandler &prm)
  {
    if constexpr (decoupled)
      ElasticConstants::declare_choice(prm);
    else
      ElasticConstants::declare_parameters(prm);
    Material::declare_density(prm);
  }


  template <bool decoupled>
  std::unique_ptr<const Material>
  NeoHookean<decoupled>::create(dealii::ParameterHandler &prm,
                                const MaterialSpec       &spec,
                                PointLayout &)
  {
    return std::make_unique<NeoHookean>(spec,
                                        decoupled ?
                                          ElasticConstants::from_choice(prm) :
                                          ElasticConstants::from_parameters(
                                            prm));
  }


  template <bool decoupled>
  bool
  NeoHookean<decoupled>::measure(const dealii::Tensor<2, 3> &F, Strain &strain)
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


  template <bool decoupled>
  double
  NeoHookean<decoupled>::potential(const Strain &strain) const
  {
    const double trace = dealii::trace(strain.b_minus_1);
    if (!decoupled)
      return 0.5 * constants.shear * (trace - 2. * strain.log_J) +
             0.5 * constants.lame() * strain.log_J * strain.log_J;
    // J^(-2/3) - 1
    const double shrink = std::expm1(-2. / 3. * strain.log_J);
    return 0.5 * constants.shear * (3. * shrink + trace + shrink * trace) +
           0.5 * constants.bulk * strain.log_J * strain.log_J;
  }


  template <bool decoupled>
  bool
  NeoHookean<decoupled>::evaluate_point(const Material::Step &step,
                                        const bool            with_tangent,
                                        Material::Response   &response) const
  {
    Strain strain;
    if (!measure(step.total, strain))
      return false;
    response.potential = potential(strain);
    const auto   unit  = dealii::unit_symmetric_tensor<3>();
    const double pressure =
      (decoupled ? constants.bulk : constants.lame()) * strain.log_J;
    if constexpr (decoupled)
      {
        const double shear =
          constants.shear * std::exp(-2. / 3. * strain.log_J);
        const auto deviator       = shear * dealii::deviator(strain.b_minus_1);
        response.kirchhoff_stress = deviator + pressure * unit;
        if (with_tangent)
          {
            // eq. 21 times J, where the mu of 2 mu [...] is
            // G tr(b) / (3 J^(2/3))
            const double mu =
              shear * (1. + dealii::trace(strain.b_minus_1) / 3.);
            response.tangent = isotropic_tensor(constants.bulk - 2. / 3. * mu,
                                                2. * (mu - pressure)) -
                               2. / 3. *
                                 (dealii::outer_product(deviator, unit) +
                                  dealii::outer_product(unit, deviator));
          }
      }
    else
      {
        response.kirchhoff_stress =
          constants.shear * strain.b_minus_1 + pressure * unit;
        if (with_tangent)
          response.tangent =
            isotropic_tensor(constants.lame(),
                             2. * (constants.shear - pressure));
      }
    return std::isfinite(response.potential);
  }


  template <bool decoupled>
  Material::Energy
  NeoHookean<decoupled>::energy(const dealii::Tensor<2, 3> &F,
                                const double *) const
  {
    Material::Energy result;
    Strain           strain;
    result.stored = measure(F, strain) ?
                      potential(strain) :
                      std::numeric_limits<double>::quiet_NaN();
    return result;
  }

  template class NeoHookean<false>;
  template class NeoHookean<true>;
} // namespace impm
