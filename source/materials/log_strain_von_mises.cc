#include <deal.II/base/patterns.h>

#include <deal.II/physics/transformations.h>

#include <impm/materials/log_strain_von_mises.h>

#include <cmath>
#include <limits>

namespace impm
{
  LogStrainVonMises::LogStrainVonMises(const MaterialSpec     &spec,
                                       PointLayout            &history,
                                       const HenckyElasticity &elasticity,
                                       const double            yield_stress,
                                       const double            hardening)
    : PointwiseLaw(spec, elasticity.young, elasticity.longitudinal_modulus())
    , elasticity(elasticity)
    , yield_stress(yield_stress)
    , hardening(hardening)
    , storage(history.geometry)
    , elastic_offset(history.add("elastic_left_cauchy_green",
                                 PointLayout::Kind::symmetric_tensor))
    , plastic_offset(
        history.add("equivalent_plastic_strain", PointLayout::Kind::scalar))
  {}


  void
  LogStrainVonMises::declare_parameters(dealii::ParameterHandler &prm)
  {
    LogStrainElastic::declare_parameters(prm);
    prm.declare_entry("Yield stress",
                      "1e6",
                      dealii::Patterns::Double(1e-300),
                      "Uniaxial stress (Pa, Kirchhoff) at which the material "
                      "starts to yield, positive.");
    prm.declare_entry("Hardening modulus",
                      "0",
                      dealii::Patterns::Double(0.),
                      "Slope (Pa) of the yield stress over the equivalent "
                      "plastic strain, not negative; 0: perfectly plastic.");
  }


  std::unique_ptr<const Material>
  LogStrainVonMises::create(dealii::ParameterHandler &prm,
                            const MaterialSpec       &spec,
                            PointLayout              &history)
  {
    return std::make_unique<LogStrainVonMises>(
      spec,
      history,
      HenckyElasticity::from_parameters(prm),
      prm.get_double("Yield stress"),
      prm.get_double("Hardening modulus"));
  }


  void
  LogStrainVonMises::initialize_history(double *history) const
  {
    storage.store_symmetric(dealii::unit_symmetric_tensor<3>(),
                            history + elastic_offset);
    history[plastic_offset] = 0.;
  }


  bool
  LogStrainVonMises::evaluate_point(const Step &step,
                                    const bool  with_tangent,
                                    Response   &response) const
  {
    if (!(dealii::determinant(step.increment) > 0.) ||
        !(dealii::determinant(step.total) > 0.))
      return false;

    const auto trial =
      dealii::Physics::Transformations::Contravariant::push_forward(
        storage.load_symmetric(step.history + elastic_offset), step.increment);
    LogStrain::PrincipalStrains principal;
    if (!LogStrain::decompose(trial, principal))
      return false;

    auto                  stress         = elasticity.stress(principal.strain);
    std::array<double, 3> elastic_strain = principal.strain;
    double                alpha          = step.history[plastic_offset];

    const double mean =
      (stress.stress[0] + stress.stress[1] + stress.stress[2]) / 3.;
    std::array<double, 3> deviator;
    double                squares = 0.;
    for (unsigned int a = 0; a < 3; ++a)
      {
        deviator[a] = stress.stress[a] - mean;
        squares += deviator[a] * deviator[a];
      }
    const double q = std::sqrt(1.5 * squares);

    const double excess = q - (yield_stress + hardening * alpha);
    if (excess > 0.)
      {
        const double shear      = elasticity.shear;
        const double resistance = 3. * shear + hardening;
        const double flow       = excess / resistance;
        alpha += flow;

        // The deviator shrinks onto the yield limit along its own direction.
        const double scale = (yield_stress + hardening * alpha) / q;
        const double mean_strain =
          (elastic_strain[0] + elastic_strain[1] + elastic_strain[2]) / 3.;
        std::array<double, 3> stretches_squared;
        for (unsigned int a = 0; a < 3; ++a)
          {
            elastic_strain[a] =
              mean_strain + scale * (elastic_strain[a] - mean_strain);
            stretches_squared[a] = std::exp(2. * elastic_strain[a]);
            stress.stress[a]     = mean + scale * deviator[a];
          }
        storage.store_symmetric(LogStrain::compose(stretches_squared,
                                                   principal),
                                step.trial_history + elastic_offset);

        // The scale itself changes with the trial strains, through q only.
        if (with_tangent)
          {
            const double softening =
              9. * shear * shear * (1. / resistance - flow / q);
            const double lame = elasticity.bulk - 2. / 3. * shear * scale;
            for (unsigned int a = 0; a < 3; ++a)
              {
                for (unsigned int b = 0; b < 3; ++b)
                  stress.moduli[a][b] =
                    lame - softening * (deviator[a] / q) * (deviator[b] / q);
                stress.moduli[a][a] += 2. * shear * scale;
              }
            stress.secant.fill(2. * shear * scale);
          }
      }
    else
      storage.store_symmetric(trial, step.trial_history + elastic_offset);
    step.trial_history[plastic_offset] = alpha;

    response.kirchhoff_stress = LogStrain::compose(stress.stress, principal);
    response.potential =
      elasticity.energy(elastic_strain) + plastic_work(alpha);
    if (with_tangent)
      LogStrain::lie_tangent(principal, stress, response.tangent);
    return std::isfinite(response.potential);
  }


  Material::Energy
  LogStrainVonMises::energy(const dealii::Tensor<2, 3> &,
                            const double *history) const
  {
    Energy                      result;
    LogStrain::PrincipalStrains principal;
    result.stored =
      LogStrain::decompose(storage.load_symmetric(history + elastic_offset),
                           principal) ?
        elasticity.energy(principal.strain) :
        std::numeric_limits<double>::quiet_NaN();
    result.dissipated = plastic_work(history[plastic_offset]);
    return result;
  }


  double
  LogStrainVonMises::plastic_work(const double alpha) const
  {
    return (yield_stress + 0.5 * hardening * alpha) * alpha;
  }
} // namespace impm
