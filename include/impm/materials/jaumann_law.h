#ifndef impm_materials_jaumann_law_h
#define impm_materials_jaumann_law_h

#include <impm/materials/pointwise_law.h>
#include <impm/materials/rate_law.h>

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
  class JaumannLaw final : public PointwiseLaw<JaumannLaw, RateLaw>
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
      return Form::full;
    }

    bool
    has_potential() const override
    {
      return false;
    }
  };
} // namespace impm

#endif
