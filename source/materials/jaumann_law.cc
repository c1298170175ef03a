#include <impm/materials/jaumann_law.h>
#include <impm/materials/midpoint_rate.h>

#include <cmath>

namespace impm
{
  bool
  JaumannLaw::evaluate_point(const Step &step,
                             const bool  with_tangent,
                             Response   &response) const
  {
    const double J = dealii::determinant(step.total);
    MidpointRate rate;
    if (!(J > 0) || !(dealii::determinant(step.increment) > 0) ||
        !rate.measure(step.increment))
      return false;

    // half of the strain before the rotation, half behind it
    const auto                 half   = 0.5 * elastic_stress(rate.strain);
    const dealii::Tensor<2, 3> before = load_stress(step.history) + half;
    const auto to_end = before * dealii::transpose(rate.rotation);
    const auto end =
      return_stress(dealii::symmetrize(rate.rotation * to_end) + half,
                    step.history);
    store(end, step.trial_history);
    response.kirchhoff_stress = J * end.stress;
    response.potential        = 0;
    if (with_tangent)
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l)
          {
            dealii::Tensor<2, 3> L, rotation_change;
            L[k][l] = 1;
            dealii::SymmetricTensor<2, 3> strain_change;
            rate.differentiate(L,
                               step.increment,
                               strain_change,
                               rotation_change);
            const auto half_change = 0.5 * elastic_stress(strain_change);
            const dealii::Tensor<2, 3> turned =
              rotation_change * to_end + 0.5 * rate.rotation *
                                           dealii::Tensor<2, 3>(half_change) *
                                           dealii::transpose(rate.rotation);
            const dealii::SymmetricTensor<2, 3> change =
              J * end.change(2. * dealii::symmetrize(turned) + half_change);
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                response.full_tangent[i][j][k][l] =
                  change[i][j] +
                  (k == l ? response.kirchhoff_stress[i][j] : 0.);
          }
    return std::isfinite(response.kirchhoff_stress.norm());
  }
} // namespace impm
