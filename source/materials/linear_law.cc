#include <impm/materials/linear_law.h>

#include <cmath>

namespace impm
{
  bool
  LinearLaw::evaluate_point(const Step &step,
                            const bool  with_tangent,
                            Response   &response) const
  {
    const double J      = dealii::determinant(step.total);
    const double change = dealii::determinant(step.increment);
    if (!(J > 0) || !(change > 0))
      return false;
    const double volume = J / change; // at t_n

    const auto unit = dealii::unit_symmetric_tensor<3>();
    const dealii::SymmetricTensor<2, 3> strain =
      dealii::symmetrize(step.increment) - unit;
    const auto end =
      return_stress(load_stress(step.history) + elastic_stress(strain),
                    step.history);
    store(end, step.trial_history);

    response.kirchhoff_stress = volume * end.stress;
    response.potential =
      volume * (elastic_energy(end.stress) + plastic_work(end.plastic_strain));
    if (with_tangent)
      {
        const double shear = 2 * constants.shear * end.scale;
        response.tangent   = (volume * (constants.bulk - shear / 3)) *
                             dealii::outer_product(unit, unit) +
                           (volume * shear) * dealii::identity_tensor<3>() +
                           (volume * 2 * constants.shear * end.steepness) *
                             dealii::outer_product(end.deviator, end.deviator);
      }
    return std::isfinite(response.potential);
  }
} // namespace impm
