#ifndef impm_materials_log_strain_viscoelastic_h
#define impm_materials_log_strain_viscoelastic_h

#include <deal.II/physics/elasticity/kinematics.h>
#include <deal.II/physics/transformations.h>

#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/number_list.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  /**
   * Hencky's elasticity in the long run, and beside it any number of Maxwell's
   * branches, a spring and a dashpot in series that resist changes of shape
   * (S. Reese & S. Govindjee, Int. J. Solids Struct. 35 (1998) 3455-3482), and
   * a dashpot in parallel.
   *
   * A branch of shear modulus G_i and relaxation time T_i has an elastic left
   * Cauchy-Green tensor b_e of its own. The exponential map of its flow makes
   * a step of implicit Euler that of small strains, with the trial strains of
   * b_e moved along and frozen:
   *
   *   dev eps_e = dev eps_trial / (1 + dt / T_i),   tau_i = 2 G_i dev eps_e.
   *
   * That minimizes over eps_e the energy G_i |dev eps_e|^2 and the potential
   * G_i T_i / dt |dev (eps_trial - eps_e)|^2 of the dashpot. What is left is
   * G_i / (1 + dt / T_i) |dev eps_trial|^2, of which tau_i is the derivative by
   * eps_trial, as in LogStrainVonMises.
   *
   * The parallel dashpot of viscosity eta sees the logarithmic strain of the
   * step, de = ln(dF dF^T) / 2: tau_v = 2 eta dev de / dt, the derivative of
   * eta / dt |dev de|^2. In a step without a length tau_v is the old one,
   * moved along.
   *
   * History: "branch_i_left_cauchy_green" (-) from i = 1, "viscous_work" of all
   * dashpots per initial volume (J/m^3) and, with a viscosity,
   * "viscous_kirchhoff_stress" (Pa).
   */
  class LogStrainViscoelastic final : public LawInLanes<LogStrainViscoelastic>
  {
  public:
    struct Branch
    {
      double shear; ///< G_i (Pa, > 0)
      double time;  ///< T_i (s, > 0)
    };

    struct Parameters
    {
      static void
      declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
      {
        ElasticConstants::declare_parameters(prm, chosen);
        const dealii::Patterns::Double positive(1e-300);
        declare_number_list(prm,
                            "Branch shear moduli",
                            "",
                            positive,
                            "By which the shear modulus of a sudden strain is "
                            "larger than in the long run (Pa), each positive; "
                            "empty: nothing relaxes.");
        declare_number_list(prm,
                            "Relaxation times",
                            "",
                            positive,
                            "In which the stress of each branch falls to 1/e "
                            "(s), positive.");
        prm.declare_entry("Viscosity",
                          "0",
                          dealii::Patterns::Double(0.),
                          "Kirchhoff's shear stress over rate of shear (Pa s), "
                          "beside the rest; not negative.");
      }

      static Parameters
      from_parameters(dealii::ParameterHandler &prm)
      {
        require_same_length(prm, "Branch shear moduli", "Relaxation times");
        const auto moduli = number_list(prm, "Branch shear moduli"),
                   times  = number_list(prm, "Relaxation times");
        Parameters result{ElasticConstants::from_parameters(prm),
                          {},
                          prm.get_double("Viscosity")};
        for (unsigned int i = 0; i < moduli.size(); ++i)
          result.branches.push_back({moduli[i], times[i]});
        return result;
      }

      /** Of strains so sudden that nothing flows, but for the viscosity. */
      ElasticConstants
      sudden() const
      {
        double shear = elasticity.shear;
        for (const auto &branch : branches)
          shear += branch.shear;
        return ElasticConstants::from_moduli(shear, elasticity.bulk);
      }

      ElasticConstants    elasticity; ///< in the long run
      std::vector<Branch> branches;
      double              viscosity; ///< eta (Pa s)
    };

    LogStrainViscoelastic(const MaterialSpec &spec,
                          PointLayout        &history,
                          const Parameters   &parameters)
      : LawInLanes(spec,
                   parameters.sudden().young,
                   parameters.sudden().longitudinal_modulus())
      , parameters(parameters)
      , work_offset(history.add("viscous_work", PointLayout::Kind::scalar))
    {
      for (unsigned int i = 0; i < parameters.branches.size(); ++i)
        elastic.emplace_back(history,
                             "branch_" + std::to_string(i + 1) +
                               "_left_cauchy_green");
      if (parameters.viscosity > 0)
        viscous_stress.emplace(history, "viscous_kirchhoff_stress");
    }

    void
    initialize_history(double *history) const override
    {
      for (const auto &branch : elastic)
        branch.store(dealii::unit_symmetric_tensor<3>(), history);
    }

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 const bool               with_tangent,
                 BasicResponse<Number>   &response) const
    {
      using dealii::Physics::Elasticity::Kinematics::b;
      using dealii::Physics::Transformations::Contravariant::push_forward;
      if (!all_of(dealii::determinant(step.increment) > 0.) ||
          !all_of(dealii::determinant(step.total) > 0.))
        return false;

      response.kirchhoff_stress = dealii::SymmetricTensor<2, 3, Number>();
      response.potential        = 0.;
      if (with_tangent)
        response.tangent = dealii::SymmetricTensor<4, 3, Number>();
      Share<Number> share;
      if (!add(HenckyElasticity{parameters.elasticity},
               b(step.total),
               with_tangent,
               share,
               response))
        return false;

      Number work = read(step.history, work_offset);
      for (unsigned int i = 0; i < elastic.size(); ++i)
        {
          const auto  &branch = parameters.branches[i];
          const double kept   = branch.time / (branch.time + step.dt),
                       lost   = step.dt / (branch.time + step.dt);
          const auto trial =
            push_forward(elastic[i].load(step.history), step.increment);
          if (!add(of_shape(branch.shear * kept),
                   trial,
                   with_tangent,
                   share,
                   response))
            return false;
          elastic[i].store(step.dt > 0 ? relaxed(share.principal, kept) : trial,
                           step.trial_history);
          // 2 G dev eps_e : dev (eps_trial - eps_e)
          work += 2. * lost * share.potential;
        }

      if (viscous_stress && step.dt > 0)
        {
          if (!add(of_shape(parameters.viscosity / step.dt),
                   b(step.increment),
                   with_tangent,
                   share,
                   response))
            return false;
          viscous_stress->store(share.stress, step.trial_history);
          work += 2. * share.potential;
        }
      else if (viscous_stress)
        {
          const auto moved =
            push_forward(viscous_stress->load(step.history), step.increment);
          response.kirchhoff_stress += moved;
          viscous_stress->store(moved, step.trial_history);
        }
      write(work, step.trial_history, work_offset);
      return all_of(is_finite(response.potential));
    }

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override
    {
      double stored = HenckyElasticity{parameters.elasticity}.energy(
        dealii::Physics::Elasticity::Kinematics::b(deformation_gradient));
      for (unsigned int i = 0; i < elastic.size(); ++i)
        stored += of_shape(parameters.branches[i].shear)
                    .energy(elastic[i].load(history));
      return {stored, history[work_offset]};
    }

  private:
    /** What one part of the law adds. */
    template <typename Number>
    struct Share
    {
      LogStrain::PrincipalStrains<Number>   principal;
      dealii::SymmetricTensor<2, 3, Number> stress;    ///< tau (Pa)
      Number                                potential; ///< (J/m^3)
    };

    /** Of changes of shape only. */
    static HenckyElasticity
    of_shape(const double shear)
    {
      return {ElasticConstants{0., 0., shear}};
    }

    /** Adds a part to the response. All parts are springs, of the left
     * Cauchy-Green tensors that they see. Returns false if that is none. */
    template <typename Number>
    static bool
    add(const HenckyElasticity                      &spring,
        const dealii::SymmetricTensor<2, 3, Number> &left_cauchy_green,
        const bool                                   with_tangent,
        Share<Number>                               &share,
        BasicResponse<Number>                       &response)
    {
      if (!LogStrain::decompose(left_cauchy_green, share.principal))
        return false;
      const auto stress = spring.stress(share.principal.strain);
      share.stress      = LogStrain::compose(stress.stress, share.principal);
      share.potential   = spring.energy(share.principal.strain);
      response.kirchhoff_stress += share.stress;
      response.potential += share.potential;
      if (with_tangent)
        {
          dealii::SymmetricTensor<4, 3, Number> tangent;
          LogStrain::lie_tangent(share.principal, stress, tangent);
          response.tangent += tangent;
        }
      return true;
    }

    /** b_e of which a part of the change of shape is kept, and the volume. */
    template <typename Number>
    static dealii::SymmetricTensor<2, 3, Number>
    relaxed(const LogStrain::PrincipalStrains<Number> &trial, const double kept)
    {
      const Number mean =
        (trial.strain[0] + trial.strain[1] + trial.strain[2]) / 3.;
      LogStrain::Triple<Number> squares;
      for (unsigned int a = 0; a < 3; ++a)
        squares[a] =
          each([](const double x) { return std::exp(x); },
               Number(2. * (mean + kept * (trial.strain[a] - mean))));
      return LogStrain::compose(squares, trial);
    }

    const Parameters             parameters;
    const unsigned int           work_offset;
    std::vector<HistoryTensor>   elastic; ///< of each branch
    std::optional<HistoryTensor> viscous_stress;
  };
} // namespace impm

#endif
