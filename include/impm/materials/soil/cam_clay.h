#ifndef impm_materials_soil_cam_clay_h
#define impm_materials_soil_cam_clay_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/materials/hardening/find_flow.h>
#include <impm/materials/log_strain_elastic.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace impm
{
  /**
   * K. H. Roscoe and J. B. Burland's modified Cam-clay at finite strains (R. I.
   * Borja & C. Tamagnini, CMAME 155 (1998) 73-95), in principal logarithmic
   * strains (log_strain.h). With the elastic volume v (its logarithm), the
   * elastic distortion s = sqrt(2/3) |dev eps_e|, the pressure P = -tr tau / 3
   * and q = sqrt(3/2) |dev tau|,
   *
   *   psi = P_0 kappa exp(-v / kappa) + 3/2 mu s^2,
   *   P = P_0 exp(-v / kappa),   q = 3 mu s,
   *   f = q^2 / M^2 + P (P - P_c) <= 0,   flow associated,
   *   P_c = P_c,n exp(-d v_p / (lambda - kappa)).
   *
   * Where nothing is deformed the pressure is P_0, not 0; what it can do while
   * it expands counts as stored. The flow of a finite step hardens at its end,
   * so that its tangent is symmetric for small steps only.
   *
   * History: "elastic_left_cauchy_green" b_e (-), "equivalent_plastic_strain",
   * the sum of sqrt(2/3) |dev d eps_p| (-), "plastic_work" (J/m^3) and
   * "preconsolidation_pressure" P_c (Pa).
   */
  class CamClay final : public PointwiseLaw<CamClay>
  {
  public:
    struct Parameters
    {
      static void
      declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
      {
        const auto add = [&prm](const std::string &name,
                                const std::string &value,
                                const std::string &documentation) {
          prm.declare_entry(name,
                            value,
                            dealii::Patterns::Double(1e-300),
                            documentation);
        };
        add("Reference pressure",
            "1e5",
            "P_0 (Pa), positive: where nothing is deformed yet.");
        add("Preconsolidation pressure",
            "1e5",
            "P_c (Pa) at the start, from the reference pressure on: where "
            "yielding starts without shear.");
        add("Swelling index",
            "0.01",
            "kappa, positive: change of the logarithm of the volume over that "
            "of the pressure while it is elastic.");
        add("Compression index",
            "0.1",
            "lambda, greater than the swelling index: the same ratio while the "
            "clay yields without shear.");
        add("Shear modulus", "1e7", "mu (Pa), positive, of elasticity.");
        add("Critical state slope",
            "1",
            "M, positive: q over P where shear goes on without a change of "
            "volume. In triaxial compression 6 sin phi / (3 - sin phi).");
      }

      /** Throws InputError when they contradict each other. */
      static Parameters
      from_parameters(dealii::ParameterHandler &prm)
      {
        const Parameters result = {prm.get_double("Reference pressure"),
                                   prm.get_double("Preconsolidation pressure"),
                                   prm.get_double("Swelling index"),
                                   prm.get_double("Compression index"),
                                   prm.get_double("Shear modulus"),
                                   prm.get_double("Critical state slope")};
        if (!(result.compression > result.swelling))
          throw InputError("Compression index",
                           "found '" + prm.get("Compression index") +
                             "', allowed is more than 'Swelling index' = " +
                             prm.get("Swelling index"));
        if (!(result.preconsolidation >= result.reference))
          throw InputError("Preconsolidation pressure",
                           "found '" + prm.get("Preconsolidation pressure") +
                             "', allowed is from 'Reference pressure' = " +
                             prm.get("Reference pressure") +
                             " on, which the clay has to bear at the start");
        return result;
      }

      /** Of small strains at the start. */
      ElasticConstants
      constants() const
      {
        return ElasticConstants::from_moduli(shear, reference / swelling);
      }

      double reference, preconsolidation; ///< P_0, P_c (Pa)
      double swelling, compression;       ///< kappa, lambda (-)
      double shear;                       ///< mu (Pa)
      double slope;                       ///< M (-)
    };

    CamClay(const MaterialSpec &spec,
            PointLayout        &history,
            const Parameters   &parameters)
      : PointwiseLaw(spec,
                     parameters.constants().young,
                     parameters.constants().longitudinal_modulus())
      , parameters(parameters)
      , elastic(history, "elastic_left_cauchy_green")
      , plastic_strain(
          history.add("equivalent_plastic_strain", PointLayout::Kind::scalar))
      , plastic_work(history.add("plastic_work", PointLayout::Kind::scalar))
      , preconsolidation(
          history.add("preconsolidation_pressure", PointLayout::Kind::scalar))
    {}

    void
    initialize_history(double *history) const override
    {
      elastic.store(dealii::unit_symmetric_tensor<3>(), history);
      history[preconsolidation] = parameters.preconsolidation;
    }

    bool
    evaluate_one(const Step &step,
                 const bool  with_tangent,
                 Response   &response) const override
    {
      dealii::SymmetricTensor<2, 3, double> trial;
      LogStrain::PrincipalStrains<double>   principal;
      if (!find_trial(step, elastic, trial, principal))
        return false;

      const auto [volume, distortion] = invariants(principal.strain);
      const double limit              = step.history[preconsolidation];
      State        end   = at(limit, volume, distortion, 0., volume);
      const bool   flows = end.excess(parameters) > 0;
      if (flows && !find_flow(limit, volume, distortion, end))
        return false;

      // Along the deviator of the trial strains, which only shrinks.
      const double              shear = parameters.shear / end.stretch;
      LogStrain::Triple<double> deviator, stress, stretches_squared;
      for (unsigned int a = 0; a < 3; ++a)
        {
          deviator[a] = principal.strain[a] - volume / 3.;
          stress[a]   = 2. * shear * deviator[a] - end.pressure;
          stretches_squared[a] =
            std::exp(2. * (end.volume / 3. + deviator[a] / end.stretch));
        }
      const double work = end.q * (distortion - end.distortion) -
                          end.pressure * (volume - end.volume);
      elastic.store(flows ? LogStrain::compose(stretches_squared, principal) :
                            trial,
                    step.trial_history);
      step.trial_history[plastic_strain] =
        step.history[plastic_strain] + (distortion - end.distortion);
      step.trial_history[plastic_work]     = step.history[plastic_work] + work;
      step.trial_history[preconsolidation] = end.limit;

      response.kirchhoff_stress = LogStrain::compose(stress, principal);
      response.potential        = energy(end.volume, end.distortion) + work;
      if (with_tangent)
        LogStrain::lie_tangent(principal,
                               moduli(end, flows, stress, deviator, distortion),
                               response.tangent);
      return is_finite(response.potential) && is_finite(end.limit) &&
             end.pressure > 0;
    }

    bool
    softens(const double *start, const double *end) const override
    {
      return has_fallen(start[preconsolidation], end[preconsolidation]);
    }

    Energy
    energy(const dealii::Tensor<2, 3> &, const double *history) const override
    {
      LogStrain::PrincipalStrains<double> principal;
      if (!LogStrain::decompose(elastic.load(history), principal))
        return {std::numeric_limits<double>::quiet_NaN(), 0.};
      const auto [volume, distortion] = invariants(principal.strain);
      return {energy(volume, distortion), history[plastic_work]};
    }

    bool
    has_symmetric_tangent() const override
    {
      return false;
    }

    bool
    depends_on_shape() const override
    {
      return false;
    }

  private:
    static constexpr double epsilon = std::numeric_limits<double>::epsilon();

    /** At the end of a step. */
    struct State
    {
      double volume, distortion; ///< v, s: elastic
      double pressure, q;        ///< P, q (Pa)
      double limit;              ///< P_c (Pa)
      double flow;               ///< that of f (1/Pa)
      double stretch;            ///< trial distortion over the elastic one

      double
      excess(const Parameters &parameters) const
      {
        const double part = q / parameters.slope;
        return part * part + pressure * (pressure - limit);
      }
    };

    static std::pair<double, double>
    invariants(const LogStrain::Triple<double> &strain)
    {
      const double volume  = strain[0] + strain[1] + strain[2];
      double       squares = 0;
      for (const double e : strain)
        squares += (e - volume / 3.) * (e - volume / 3.);
      return {volume, std::sqrt(2. / 3. * squares)};
    }

    double
    energy(const double volume, const double distortion) const
    {
      const double kappa = parameters.swelling;
      return parameters.reference * kappa * std::exp(-volume / kappa) +
             1.5 * parameters.shear * distortion * distortion;
    }

    /** With an elastic volume, from a limit at the start, trial strains and a
     * flow. */
    State
    at(const double limit,
       const double trial_volume,
       const double trial_distortion,
       const double flow,
       const double volume) const
    {
      State state;
      state.volume = volume;
      state.flow   = flow;
      state.pressure =
        parameters.reference * std::exp(-volume / parameters.swelling);
      state.limit   = limit * std::exp((volume - trial_volume) / hardening());
      state.stretch = 1. + 6. * parameters.shear * flow /
                             (parameters.slope * parameters.slope);
      state.distortion = trial_distortion / state.stretch;
      state.q          = 3. * parameters.shear * state.distortion;
      return state;
    }

    /** lambda - kappa */
    double
    hardening() const
    {
      return parameters.compression - parameters.swelling;
    }

    /** A function of one number there. */
    struct Sample
    {
      double value, slope;
      double round_off; ///< of the value
    };

    /**
     * The root of a function that is not positive at one end and not negative
     * at the other: Newton's method within what is known to enclose it.
     */
    template <typename Function>
    static double
    root(double          not_positive,
         double          not_negative,
         double          x,
         const Function &function)
    {
      double last = std::numeric_limits<double>::infinity();
      for (unsigned int i = 0; i < 200; ++i)
        {
          const Sample here = function(x);
          if (!(std::abs(here.value) > here.round_off))
            break;
          (here.value < 0 ? not_positive : not_negative) = x;
          double       next         = x - here.value / here.slope;
          const double size         = std::abs(next - x);
          const auto [lower, upper] = std::minmax(not_positive, not_negative);
          if (!(next > lower && next < upper && size <= 0.5 * last))
            next = lower + 0.5 * (upper - lower);
          if (next == x)
            break;
          last = std::abs(next - x);
          x    = next;
        }
      return x;
    }

    /**
     * The elastic volume of a flow: v - v_trial = flow (2 P - P_c), monotone in
     * v, between the trial one and that where the clay is critical.
     */
    State
    after(const double limit,
          const double trial_volume,
          const double trial_distortion,
          const double flow) const
    {
      const double kappa = parameters.swelling, theta = hardening();
      const double critical =
        (std::log(2. * parameters.reference / limit) + trial_volume / theta) /
        (1. / kappa + 1. / theta);
      const double volume = root(
        std::min(trial_volume, critical),
        std::max(trial_volume, critical),
        trial_volume,
        [&](const double v) {
          const auto s = at(limit, trial_volume, trial_distortion, flow, v);
          return Sample{v - trial_volume - flow * (2. * s.pressure - s.limit),
                        1. + flow * (2. * s.pressure / kappa + s.limit / theta),
                        epsilon * (std::abs(trial_volume) +
                                   flow * (2. * s.pressure + s.limit))};
        });
      return at(limit, trial_volume, trial_distortion, flow, volume);
    }

    /** The flow after which the stress is at the limit; false if there is
     * none. */
    bool
    find_flow(const double limit,
              const double trial_volume,
              const double trial_distortion,
              State       &end) const
    {
      const auto evaluate = [&](const double flow) {
        end = after(limit, trial_volume, trial_distortion, flow);
        // how all of it follows the flow
        const double beyond = 2. * end.pressure - end.limit;
        const double volume =
          beyond / (1. + flow * (2. * end.pressure / parameters.swelling +
                                 end.limit / hardening()));
        const double squared = end.q / parameters.slope;
        const double slope =
          -2. * squared * squared * 6. * parameters.shear /
            (parameters.slope * parameters.slope * end.stretch) -
          volume * end.pressure *
            (beyond / parameters.swelling + end.limit / hardening());
        return Sample{end.excess(parameters),
                      slope,
                      epsilon * (squared * squared +
                                 end.pressure * (end.pressure + end.limit))};
      };
      // it is beyond the limit without flow, and within it after enough
      double enough = 1e-3 / std::max(end.pressure, end.limit);
      for (unsigned int i = 0; evaluate(enough).value > 0; ++i, enough *= 10)
        if (i == 60)
          return false;
      evaluate(root(enough, 0., enough, evaluate));
      return is_finite(end.flow) &&
             std::abs(end.excess(parameters)) <=
               1e-9 * end.limit * std::max(end.limit, end.pressure);
    }

    /** How the stresses follow the trial strains. */
    LogStrain::PrincipalStress<double>
    moduli(const State                     &end,
           const bool                       flows,
           const LogStrain::Triple<double> &stress,
           const LogStrain::Triple<double> &deviator,
           const double                     distortion) const
    {
      const double M = parameters.slope, mu = parameters.shear;
      const double bulk        = end.pressure / parameters.swelling;
      double       p_by_volume = bulk, p_by_shear = 0, q_by_volume = 0,
             q_by_shear = 3. * mu;
      if (flows)
        {
          // f by -P and by q; P_c by v
          const double f_p = end.limit - 2. * end.pressure;
          const double f_q = 2. * end.q / (M * M);
          const double k   = end.limit / hardening();
          const double a = 1. + end.flow * k, b = a + 2. * end.flow * bulk;
          const double along = f_p * bulk - end.pressure * k;
          const double resistance =
            along * f_p / b + 3. * mu * f_q * f_q / end.stretch;
          const double by_volume =
            (along * a / b + end.pressure * k) / resistance;
          const double by_shear = 3. * mu * f_q / end.stretch / resistance;
          p_by_volume           = bulk * (a - f_p * by_volume) / b;
          p_by_shear            = -bulk * f_p * by_shear / b;
          q_by_volume           = -3. * mu * f_q * by_volume / end.stretch;
          q_by_shear            = 3. * mu * (1. - f_q * by_shear) / end.stretch;
        }
      LogStrain::PrincipalStress<double> result;
      result.stress      = stress;
      const double shear = mu / end.stretch;
      result.secant.fill(2. * shear);
      // s by a strain, and tau by q, is 2/3 of the deviator over s
      const double size = distortion > 0 ? distortion : 1.;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          {
            const double n_a = 2. / 3. * deviator[a] / size,
                         n_b = 2. / 3. * deviator[b] / size;
            result.moduli[a][b] =
              p_by_volume + p_by_shear * n_b +
              n_a * (q_by_volume + (q_by_shear - 3. * shear) * n_b) +
              2. * shear * ((a == b ? 1. : 0.) - 1. / 3.);
          }
      return result;
    }

    const Parameters    parameters;
    const HistoryTensor elastic;
    const unsigned int  plastic_strain, plastic_work,
      preconsolidation; ///< offsets
  };
} // namespace impm

#endif
