#include <impm/base/exceptions.h>
#include <impm/materials/rate_law.h>

#include <cmath>

namespace impm
{
  RateLaw::RateLaw(const MaterialSpec     &spec,
                   PointLayout            &history,
                   const ElasticConstants &constants,
                   const Hardening        &hardening)
    : Material(spec, constants.young, constants.longitudinal_modulus())
    , constants(constants)
    , hardening(hardening)
    , storage(history.geometry)
    , stress_offset(
        history.add("cauchy_stress", PointLayout::Kind::symmetric_tensor))
    , plastic_offset(hardening ? history.add("equivalent_plastic_strain",
                                             PointLayout::Kind::scalar) :
                                 0)
  {}


  void
  RateLaw::declare_elastic(dealii::ParameterHandler &prm)
  {
    ElasticConstants::declare_parameters(prm);
    declare_density(prm);
  }


  void
  RateLaw::declare_von_mises(dealii::ParameterHandler &prm)
  {
    declare_elastic(prm);
    BilinearHardening::declare_parameters(prm);
  }


  BilinearHardening
  RateLaw::read_hardening(dealii::ParameterHandler &prm)
  {
    const auto   hardening = BilinearHardening::from_parameters(prm);
    const double shear     = ElasticConstants::from_parameters(prm).shear;
    if (!(hardening.steepest_fall < 3 * shear))
      throw InputError("Softening modulus",
                       "found '" + prm.get("Softening modulus") +
                         "', allowed is less than three shear moduli = " +
                         std::to_string(3 * shear) +
                         " Pa, or the stress would fall by itself");
    return hardening;
  }


  void
  RateLaw::initialize_history(double *history) const
  {
    store(Return(), history);
  }


  void
  RateLaw::store(const Return &end, double *history) const
  {
    storage.store_symmetric(end.stress, history + stress_offset);
    if (hardening)
      history[plastic_offset] = end.plastic_strain;
  }


  RateLaw::Return
  RateLaw::return_stress(const dealii::SymmetricTensor<2, 3> &trial,
                         const double                        *history) const
  {
    Return result;
    result.stress = trial;
    if (!hardening)
      return result;
    const double before   = history[plastic_offset];
    result.deviator       = dealii::deviator(trial);
    result.plastic_strain = before;
    const double q        = std::sqrt(1.5) * result.deviator.norm();
    if (!(q > hardening->yield_stress(before)))
      return result;

    const double resistance = 3 * constants.shear;
    const auto   end        = hardening->flow(q, before, resistance);
    const double flow       = end.plastic_strain - before;
    result.plastic_strain   = end.plastic_strain;
    result.scale            = hardening->yield_stress(end.plastic_strain) / q;
    result.steepness =
      1.5 * resistance / (q * q) * (flow / q - 1 / (resistance + end.slope));
    result.stress -= (1 - result.scale) * result.deviator;
    return result;
  }


  double
  RateLaw::elastic_energy(const dealii::SymmetricTensor<2, 3> &stress) const
  {
    const double trace    = dealii::trace(stress);
    const auto   deviator = dealii::deviator(stress);
    return trace * trace / (18 * constants.bulk) +
           deviator * deviator / (4 * constants.shear);
  }


  Material::Energy
  RateLaw::energy(const dealii::Tensor<2, 3> &deformation_gradient,
                  const double               *history) const
  {
    Energy result;
    result.stored = dealii::determinant(deformation_gradient) *
                    elastic_energy(load_stress(history));
    if (hardening)
      result.dissipated = plastic_work(history[plastic_offset]);
    return result;
  }
} // namespace impm
