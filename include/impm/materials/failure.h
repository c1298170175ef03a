#ifndef impm_materials_failure_h
#define impm_materials_failure_h

#include <impm/materials/material.h>

#include <memory>

namespace impm
{
  /**
   * The plastic strain at which a point fails if triaxiality eta (mean over von
   * Mises stress), rate and temperature stay as they are:
   *
   *   (D1 + D2 exp(D3 eta)) (1 + D4 ln(max(1, rate / rate_0))) (1 + D5 T*),
   *
   * T* as in JohnsonCookHardening (G. R. Johnson & W. H. Cook, Eng. Fract.
   * Mech. 21 (1985) 31-48). With D1 alone it is a limit of the plastic strain.
   */
  struct FailureStrain
  {
    /** At least `smallest`: what D1 to D5 make of it may be negative. */
    double
    operator()(double triaxiality, double rate, double temperature) const;

    static constexpr double smallest = 1e-6;

    double d1, d2 = 0, d3 = 0, d4 = 0, d5 = 0;
    double reference_rate        = 1;                          ///< 1/s
    double reference_temperature = 0, melting_temperature = 1; ///< K
  };

  /**
   * A law with a plastic strain that a point may fail by: damage D grows by the
   * strain of a step over the one at which it would fail, and where it has
   * reached 1 the point loses its stress, but for a share of it, from the next
   * step on. Until then the law knows nothing of it. In a step nothing changes
   * with the damage: it keeps its tangent, and its potential.
   *
   * What a point stored when it failed, and does not keep, counts as dissipated
   * from then on.
   *
   * History, behind that of the law: "damage" (-), "failed" (0 or 1: a number
   * of its own, so that such a point never merges with one that holds) and
   * "failure_energy" (J/m^3), what it does not keep.
   */
  class FailingLaw final : public LawInLanes<FailingLaw>
  {
  public:
    /** For a law with an equivalent plastic strain, and the share of its stress
     * that is left to points that have failed (above 0). */
    FailingLaw(std::unique_ptr<const Material> law,
               PointLayout                    &history,
               const FailureStrain            &failure_strain,
               double                          remaining_share);

    void
    initialize_history(double *history) const override
    {
      law->initialize_history(history);
    }

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 bool                     with_tangent,
                 BasicResponse<Number>   &response) const;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

    Form
    form() const override
    {
      return law->form();
    }

    bool
    has_symmetric_tangent() const override
    {
      return law->has_symmetric_tangent();
    }

    bool
    softens(const double *start, const double *end) const override
    {
      return law->softens(start, end);
    }

    bool
    is_solid() const override
    {
      return law->is_solid();
    }

    bool
    depends_on_shape() const override
    {
      return law->depends_on_shape();
    }

    bool
    has_potential() const override
    {
      return law->has_potential();
    }

    double
    remaining_stiffness(const double *history) const override;

  private:
    /** After the law has made its step: damage, and what follows from it. */
    template <typename Number>
    void
    take_damage(const BasicStep<Number>                     &step,
                const dealii::SymmetricTensor<2, 3, Number> &stress) const;

    const std::unique_ptr<const Material> law;
    const FailureStrain                   failure_strain;
    const double                          remaining_share;
    const unsigned int strain_offset, damage_offset, failed_offset,
      energy_offset;
  };
} // namespace impm

#endif
