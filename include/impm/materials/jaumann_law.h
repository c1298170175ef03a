#ifndef impm_materials_jaumann_law_h
#define impm_materials_jaumann_law_h

#include <impm/materials/midpoint_rate.h>
#include <impm/materials/rate_law.h>

#include <cmath>

namespace impm
{
  /**
   * The rate law with the Jaumann rate of the Cauchy stress in place of
   * d sigma / dt (Sulsky & Kaul 2004, sec. 2.2.4), by the midpoint rule of
   * Hughes & Winget:
   *
   *   sigma = Q (sigma_n + S/2) Q^T + S/2,   S = C : strain,   tau = J sigma,
   *
   * returned to the yield stress if there is one. They add S at the end of the
   * step, where its middle is meant, which is of first order only. Objective,
   * but hypoelastic: there is no energy that the stress derives from, stress
   * oscillates in a large simple shear, and the tangent is not symmetric.
   */
  template <typename Hardening>
  class JaumannLaw final
    : public PointwiseLaw<JaumannLaw<Hardening>, RateLaw<Hardening>>
  {
  public:
    using Base = PointwiseLaw<JaumannLaw, RateLaw<Hardening>>;
    using Base::Base;
    using typename Base::Form;
    using typename Base::Response;
    using typename Base::Step;

    bool
    evaluate_one(const Step &step,
                 const bool  with_tangent,
                 Response   &response) const override
    {
      const double J = dealii::determinant(step.total);
      MidpointRate rate;
      if (!(J > 0) || !rate.measure(step.increment))
        return false;

      // half of the strain before the rotation, half behind it
      const auto                 half = 0.5 * elastic_stress(rate.strain);
      const dealii::Tensor<2, 3> before =
        stress_field.load(step.history) + half;
      const auto to_end = before * dealii::transpose(rate.rotation);
      const auto end =
        return_stress(dealii::symmetrize(rate.rotation * to_end) + half, step);
      response.kirchhoff_stress = J * end.stress;
      response.potential        = 0;
      const auto change =
        [&](const dealii::SymmetricTensor<2, 3> &strain_change,
            const dealii::Tensor<2, 3>          &rotation_change,
            const bool                           stretches) {
          const auto half_change = 0.5 * elastic_stress(strain_change);
          const dealii::Tensor<2, 3> turned =
            rotation_change * to_end + 0.5 * rate.rotation *
                                         dealii::Tensor<2, 3>(half_change) *
                                         dealii::transpose(rate.rotation);
          dealii::SymmetricTensor<2, 3> result =
            J * end.change(2. * dealii::symmetrize(turned) + half_change);
          if (stretches)
            result += response.kirchhoff_stress;
          return result;
        };
      if (with_tangent)
        response.full_tangent = rate.tangent(step.increment, change);
      return std::isfinite(response.kirchhoff_stress.norm());
    }

    Form
    form() const override
    {
      return Form::full;
    }

  private:
    using Base::elastic_stress;
    using Base::return_stress;
    using Base::stress_field;
  };
} // namespace impm

#endif
