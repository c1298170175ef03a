#ifndef impm_materials_rate_law_h
#define impm_materials_rate_law_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/hardening/find_flow.h>
#include <impm/materials/material.h>

#include <cmath>
#include <type_traits>

namespace impm
{
  /** In place of a hardening: laws that are elastic. */
  struct NoYield
  {
    struct Parameters
    {};

    NoYield(const MaterialSpec &, PointLayout &, const Parameters &)
    {}

    double
    yield_stress(const double *) const
    {
      return 0;
    }

    double
    work(const double *) const
    {
      return 0;
    }
  };

  /**
   * What laws in rate form share (Sulsky & Kaul 2004, eq. 2.1.8 to 2.1.18):
   * the Cauchy stress is what a point remembers, its rate is C : d with the
   * constants of isotropic elasticity, and where there is a yield stress it
   * returns to it along its deviator (backward Euler with associated flow).
   *
   * History: "cauchy_stress" (Pa) and that of the hardening (see
   * CurveHardening).
   */
  template <typename Hardening>
  class RateLaw : public Material
  {
  public:
    RateLaw(const MaterialSpec                   &spec,
            PointLayout                          &history,
            const ElasticConstants               &constants,
            const typename Hardening::Parameters &parameters = {})
      : Material(spec, constants.young, constants.longitudinal_modulus())
      , constants(constants)
      , stress_field(history, "cauchy_stress")
      , hardening(spec, history, parameters)
    {}

    bool
    softens(const double *start, const double *end) const override
    {
      return hardening.work(end) > hardening.work(start) &&
             has_fallen(hardening.yield_stress(start),
                        hardening.yield_stress(end));
    }

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override
    {
      return {dealii::determinant(deformation_gradient) *
                elastic_energy(stress_field.load(history)),
              hardening.work(history)};
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
      double plastic_work = 0;                ///< since the start (J/m^3)
      double scale        = 1; ///< of the deviator, down to the yield stress
      double steepness    = 0; ///< d scale / d deviator = steepness deviator

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
      if constexpr (!std::is_same_v<Hardening, NoYield>)
        {
          result.deviator     = dealii::deviator(trial);
          const double q      = std::sqrt(1.5) * result.deviator.norm();
          const double relief = 3 * constants.shear;
          const auto   limit  = hardening.limit(step);
          const double flow   = find_flow(q, limit, relief);
          if (flow != 0) // or there is none, NaN
            {
              const double part = limit.yield_stress(flow) / q;
              result.scale      = part > 1 ? 1 : part;
              result.steepness  = 1.5 * relief / (q * q) *
                                 (flow / q - 1 / (relief + limit.slope(flow)));
              result.stress -= (1 - result.scale) * result.deviator;
            }
          result.plastic_work = limit.work(flow);
          hardening.store(limit, flow, result.plastic_work, step.trial_history);
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

    const ElasticConstants constants;
    const HistoryTensor    stress_field;

  private:
    const Hardening hardening;
  };
} // namespace impm

#endif
