#ifndef impm_materials_linear_law_h
#define impm_materials_linear_law_h

#include <impm/materials/pointwise_law.h>
#include <impm/materials/rate_law.h>

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
  class LinearLaw final : public PointwiseLaw<LinearLaw, RateLaw>
  {
  public:
    using PointwiseLaw::PointwiseLaw;

    bool
    evaluate_point(const Step &step,
                   bool        with_tangent,
                   Response   &response) const;

    Form
    form() const override
    {
      return Form::linearized;
    }
  };
} // namespace impm

#endif
