#ifndef impm_materials_linear_law_h
#define impm_materials_linear_law_h

#include <impm/materials/rate_law.h>

#include <cmath>

namespace impm
{
  /**
   * Sulsky & Kaul (2004), eq. 2.2.17 to 2.2.21: small strains about the state
   * at the start of the step,
   *
   *   sigma = sigma_n + C : d eps,   d eps = sym(dF - 1),
   *
   * returned to the yield stress if there is one. Forces are those of sigma on
   * the places and volumes of t_n, J_n sigma : grad_n, so that an elastic step
   * is a linear problem with a constant, symmetric matrix. Not objective: a
   * step that turns the material by an angle w stretches it by w^2 / 2 and
   * leaves its old stress where it was.
   *
   * Over a step sigma derives from W = J_n (psi(sigma) + plastic work).
   */
  template <typename Hardening>
  class LinearLaw final
    : public PointwiseLaw<LinearLaw<Hardening>, RateLaw<Hardening>>
  {
  public:
    using Base = PointwiseLaw<LinearLaw, RateLaw<Hardening>>;
    using Base::Base;
    using typename Base::Form;
    using typename Base::Response;
    using typename Base::Step;

    bool
    evaluate_one(const Step &step,
                 const bool  with_tangent,
                 Response   &response) const override
    {
      const double J      = dealii::determinant(step.total);
      const double change = dealii::determinant(step.increment);
      if (!(J > 0) || !(change > 0))
        return false;
      const double volume = J / change; // at t_n

      const dealii::SymmetricTensor<2, 3> strain =
        dealii::symmetrize(step.increment) - dealii::unit_symmetric_tensor<3>();
      const auto end =
        return_stress(stress_field.load(step.history) + elastic_stress(strain),
                      step);

      response.kirchhoff_stress = volume * end.stress;
      response.potential =
        volume * (elastic_energy(end.stress) + end.plastic_work);
      if (with_tangent)
        {
          const double shear = 2 * constants.shear * end.scale;
          response.tangent =
            isotropic_tensor(volume * (constants.bulk - shear / 3),
                             volume * shear) +
            (volume * 2 * constants.shear * end.steepness) *
              dealii::outer_product(end.deviator, end.deviator);
        }
      return std::isfinite(response.potential);
    }

    Form
    form() const override
    {
      return Form::linearized;
    }

  private:
    using Base::constants;
    using Base::elastic_energy;
    using Base::elastic_stress;
    using Base::return_stress;
    using Base::stress_field;
  };
} // namespace impm

#endif
