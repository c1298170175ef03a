#ifndef impm_materials_log_strain_elastic_h
#define impm_materials_log_strain_elastic_h

#include <deal.II/physics/elasticity/kinematics.h>
#include <deal.II/physics/transformations.h>

#include <impm/materials/elastic_constants.h>
#include <impm/materials/log_strain.h>
#include <impm/materials/material.h>

#include <array>
#include <cmath>
#include <limits>

namespace impm
{
  /**
   * H. Hencky's elasticity: quadratic in the principal logarithmic strains,
   *
   *   psi = K / 2 (tr eps)^2 + G |dev eps|^2   per initial volume,
   *   tau = K tr eps 1 + 2 G dev eps.
   */
  struct HenckyElasticity : public ElasticConstants
  {
    /** psi (J/m^3) of principal strains. */
    template <typename Number>
    Number
    energy(const std::array<Number, 3> &strain) const
    {
      const Number volumetric = strain[0] + strain[1] + strain[2];
      Number       squares    = 0.;
      for (const Number &e : strain)
        squares += (e - volumetric / 3.) * (e - volumetric / 3.);
      return 0.5 * bulk * volumetric * volumetric + shear * squares;
    }

    /** The same of a left Cauchy-Green tensor; NaN if it is none. */
    double
    energy(const dealii::SymmetricTensor<2, 3> &left_cauchy_green) const
    {
      LogStrain::PrincipalStrains<double> principal;
      return LogStrain::decompose(left_cauchy_green, principal) ?
               energy(principal.strain) :
               std::numeric_limits<double>::quiet_NaN();
    }

    /** Principal strains of principal stresses (Pa). */
    std::array<double, 3>
    strain(const std::array<double, 3> &stress) const
    {
      const double          mean = (stress[0] + stress[1] + stress[2]) / 3.;
      std::array<double, 3> result;
      for (unsigned int a = 0; a < 3; ++a)
        result[a] = mean / (3. * bulk) + (stress[a] - mean) / (2. * shear);
      return result;
    }

    /** tau_a and what goes with them, of principal strains. */
    template <typename Number>
    LogStrain::PrincipalStress<Number>
    stress(const std::array<Number, 3> &strain) const
    {
      LogStrain::PrincipalStress<Number> result;
      const Number volumetric = strain[0] + strain[1] + strain[2];
      for (unsigned int a = 0; a < 3; ++a)
        {
          result.stress[a] =
            bulk * volumetric + 2. * shear * (strain[a] - volumetric / 3.);
          result.moduli[a].fill(lame());
          result.moduli[a][a] += 2. * shear;
        }
      result.secant.fill(2. * shear);
      return result;
    }
  };

  /**
   * A law of the total deformation: `respond` takes its principal strains,
   * gives what goes with them (LogStrain::PrincipalStress) and returns psi.
   * False when there is no stress.
   */
  template <typename Number, typename Respond>
  bool
  evaluate_elastic(const Material::BasicStep<Number> &step,
                   const bool                         with_tangent,
                   Material::BasicResponse<Number>   &response,
                   const Respond                     &respond)
  {
    // b does not tell a body from its mirror image, J does
    LogStrain::PrincipalStrains<Number> principal;
    if (!all_of(dealii::determinant(step.total) > 0.) ||
        !LogStrain::decompose(
          dealii::Physics::Elasticity::Kinematics::b(step.total), principal))
      return false;

    LogStrain::PrincipalStress<Number> stress;
    response.potential        = respond(principal.strain, stress);
    response.kirchhoff_stress = LogStrain::compose(stress.stress, principal);
    if (with_tangent)
      LogStrain::lie_tangent(principal, stress, response.tangent);
    return all_of(is_finite(response.potential));
  }

  /**
   * What a step makes of an elastic left Cauchy-Green tensor that is kept in
   * the history, if all of it is elastic, and its principal strains. False when
   * there is no stress.
   */
  template <typename Number>
  bool
  find_trial(const Material::BasicStep<Number>     &step,
             const HistoryTensor                   &elastic,
             dealii::SymmetricTensor<2, 3, Number> &trial,
             LogStrain::PrincipalStrains<Number>   &principal)
  {
    if (!all_of(dealii::determinant(step.increment) > 0.) ||
        !all_of(dealii::determinant(step.total) > 0.))
      return false;
    trial = dealii::Physics::Transformations::Contravariant::push_forward(
      elastic.load(step.history), step.increment);
    return LogStrain::decompose(trial, principal);
  }

  /** Hencky's elasticity from the total deformation; keeps no history. */
  class LogStrainElastic final : public LawInLanes<LogStrainElastic>
  {
  public:
    LogStrainElastic(const MaterialSpec &spec,
                     PointLayout &,
                     const ElasticConstants &elasticity)
      : LawInLanes(spec, elasticity.young, elasticity.longitudinal_modulus())
      , elasticity{elasticity}
    {}

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 const bool               with_tangent,
                 BasicResponse<Number>   &response) const
    {
      return evaluate_elastic(step,
                              with_tangent,
                              response,
                              [&](const auto &strain, auto &stress) {
                                stress = elasticity.stress(strain);
                                return elasticity.energy(strain);
                              });
    }

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double *) const override
    {
      return {elasticity.energy(dealii::Physics::Elasticity::Kinematics::b(
                deformation_gradient)),
              0.};
    }

  private:
    const HenckyElasticity elasticity;
  };
} // namespace impm

#endif
