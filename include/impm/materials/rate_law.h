#ifndef impm_materials_rate_law_h
#define impm_materials_rate_law_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/hardening/bilinear.h>
#include <impm/materials/material.h>

#include <cmath>
#include <optional>

namespace impm
{
  /**
   * What laws in rate form share (Sulsky & Kaul 2004, eq. 2.1.8 to 2.1.19):
   * the Cauchy stress is what a point remembers, its rate is C : d with the
   * constants of isotropic elasticity, and where there is a yield stress it
   * returns to it along its deviator (backward Euler with associated flow).
   *
   * History: "cauchy_stress" (Pa) and, if plastic, "equivalent_plastic_strain".
   */
  class RateLaw : public Material
  {
  public:
    using Hardening = std::optional<BilinearHardening>;

    RateLaw(const MaterialSpec     &spec,
            PointLayout            &history,
            const ElasticConstants &constants,
            const Hardening        &hardening = {})
      : Material(spec, constants.young, constants.longitudinal_modulus())
      , constants(constants)
      , stress_field(history, "cauchy_stress")
      , hardening(hardening)
      , plastic_offset(hardening ? history.add("equivalent_plastic_strain",
                                               PointLayout::Kind::scalar) :
                                   0)
    {}

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override
    {
      return {dealii::determinant(deformation_gradient) *
                elastic_energy(stress_field.load(history)),
              hardening ? plastic_work(history[plastic_offset]) : 0.};
    }

    bool
    depends_on_shape() const override
    {
      return false;
    }

  protected:
    /** The stress at the end of a step, and how it follows the trial stress. */
    struct Return
    {
      dealii::SymmetricTensor<2, 3> stress;
      dealii::SymmetricTensor<2, 3> deviator; ///< of the trial stress
      double                        plastic_strain = 0;
      double scale     = 1; ///< of the deviator, down to the yield stress
      double steepness = 0; ///< d scale / d deviator = steepness deviator

      dealii::SymmetricTensor<2, 3>
      change(const dealii::SymmetricTensor<2, 3> &change_of_trial) const
      {
        return change_of_trial +
               (scale - 1) * dealii::deviator(change_of_trial) +
               (steepness * (deviator * change_of_trial)) * deviator;
      }
    };

    /** Also stores the history at the end. */
    Return
    return_stress(const dealii::SymmetricTensor<2, 3> &trial,
                  const Step                          &step) const
    {
      Return result;
      result.stress = trial;
      if (hardening)
        {
          const double before   = step.history[plastic_offset];
          result.deviator       = dealii::deviator(trial);
          result.plastic_strain = before;
          const double q        = std::sqrt(1.5) * result.deviator.norm();
          if (q > hardening->yield_stress(before))
            {
              const double resistance = 3 * constants.shear;
              const auto   end        = hardening->flow(q, before, resistance);
              const double flow       = end.plastic_strain - before;
              result.plastic_strain   = end.plastic_strain;
              result.scale = hardening->yield_stress(end.plastic_strain) / q;
              result.steepness = 1.5 * resistance / (q * q) *
                                 (flow / q - 1 / (resistance + end.slope));
              result.stress -= (1 - result.scale) * result.deviator;
            }
          step.trial_history[plastic_offset] = result.plastic_strain;
        }
      stress_field.store(result.stress, step.trial_history);
      return result;
    }

    /** C : strain. */
    dealii::SymmetricTensor<2, 3>
    elastic_stress(const dealii::SymmetricTensor<2, 3> &strain) const
    {
      return 2 * constants.shear * strain +
             constants.lame() * dealii::trace(strain) *
               dealii::unit_symmetric_tensor<3>();
    }

    /** sigma : C^-1 : sigma / 2 (J/m^3). */
    double
    elastic_energy(const dealii::SymmetricTensor<2, 3> &stress) const
    {
      const double trace    = dealii::trace(stress);
      const auto   deviator = dealii::deviator(stress);
      return trace * trace / (18 * constants.bulk) +
             deviator * deviator / (4 * constants.shear);
    }

    /** Plastic work (J/m^3). */
    double
    plastic_work(const double plastic_strain) const
    {
      return hardening ? hardening->work(plastic_strain) : 0.;
    }

    const ElasticConstants constants;
    const HistoryTensor    stress_field;

  private:
    const Hardening    hardening;
    const unsigned int plastic_offset;
  };
} // namespace impm

#endif
