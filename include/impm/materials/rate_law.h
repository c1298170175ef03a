#ifndef impm_materials_rate_law_h
#define impm_materials_rate_law_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/hardening/bilinear.h>
#include <impm/materials/material.h>

#include <memory>
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
            const Hardening        &hardening = {});

    static void
    declare_elastic(dealii::ParameterHandler &prm);

    static void
    declare_von_mises(dealii::ParameterHandler &prm);

    template <typename Law>
    static std::unique_ptr<const Material>
    create_elastic(dealii::ParameterHandler &prm,
                   const MaterialSpec       &spec,
                   PointLayout              &history)
    {
      return std::make_unique<Law>(spec,
                                   history,
                                   ElasticConstants::from_parameters(prm));
    }

    template <typename Law>
    static std::unique_ptr<const Material>
    create_von_mises(dealii::ParameterHandler &prm,
                     const MaterialSpec       &spec,
                     PointLayout              &history)
    {
      return std::make_unique<Law>(spec,
                                   history,
                                   ElasticConstants::from_parameters(prm),
                                   read_hardening(prm));
    }

    void
    initialize_history(double *history) const override;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

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

    Return
    return_stress(const dealii::SymmetricTensor<2, 3> &trial,
                  const double                        *history) const;

    dealii::SymmetricTensor<2, 3>
    load_stress(const double *history) const
    {
      return storage.load_symmetric(history + stress_offset);
    }

    void
    store(const Return &end, double *history) const;

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
    elastic_energy(const dealii::SymmetricTensor<2, 3> &stress) const;

    /** Plastic work (J/m^3). */
    double
    plastic_work(const double plastic_strain) const
    {
      return hardening ? hardening->work(plastic_strain) : 0.;
    }

    const ElasticConstants constants;

  private:
    static BilinearHardening
    read_hardening(dealii::ParameterHandler &prm);

    const Hardening    hardening;
    const PointLayout  storage; ///< knows how tensors are stored
    const unsigned int stress_offset, plastic_offset;
  };
} // namespace impm

#endif
