#ifndef impm_materials_hardening_johnson_cook_h
#define impm_materials_hardening_johnson_cook_h

#include <deal.II/base/quadrature_lib.h>

#include <impm/base/exceptions.h>
#include <impm/base/lanes.h>
#include <impm/materials/hardening/ludwik.h>
#include <impm/materials/material.h>

#include <cmath>
#include <limits>

namespace impm
{
  /**
   * Hardening by strain, rate and temperature (G. R. Johnson & W. H. Cook,
   * Proc. 7th Int. Symp. on Ballistics, The Hague 1983, 541-547):
   *
   *   (A + B alpha^n) (1 + C ln(max(1, rate / rate_0))) (1 - T*^m),
   *   T* = (T - T_r) / (T_m - T_r) within 0 and 1.
   *
   * The rate is that of the step, its flow by its length; in a step of no
   * length nothing flows. The temperature is that at its start,
   * whatever heats (see MaterialSpec), so that the limit is a function of the
   * flow alone; a material that has no temperature is at T_r.
   *
   * History: "equivalent_plastic_strain" alpha (-) and "plastic_work" (J/m^3),
   * which alpha does not tell here. As CurveHardening.
   */
  class JohnsonCookHardening
  {
  public:
    static constexpr const char *name = "Johnson-Cook";

    struct Parameters
    {
      static void
      declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
      {
        LudwikHardening::declare_parameters(prm, chosen);
        prm.declare_entry("Rate coefficient",
                          "0",
                          dealii::Patterns::Double(0.),
                          "C: by what share the yield stress grows when the "
                          "rate of the equivalent plastic strain becomes e "
                          "times as large, not negative; 0: no effect.");
        prm.declare_entry("Reference rate",
                          "1",
                          dealii::Patterns::Double(1e-300),
                          "Rate (1/s) up to which it has no effect, positive.");
        if (chosen("Specific heat", "").empty() &&
            chosen("Prescribed temperature", "").empty())
          return;
        prm.declare_entry("Melting temperature",
                          "1800",
                          dealii::Patterns::Double(0.),
                          "At which there is no yield stress (K), above the "
                          "reference temperature.");
        prm.declare_entry("Reference temperature",
                          "293.15",
                          dealii::Patterns::Double(0.),
                          "Up to which temperature has no effect (K).");
        prm.declare_entry("Thermal exponent",
                          "1",
                          dealii::Patterns::Double(1e-300),
                          "m: power of the temperature in the yield stress, "
                          "positive.");
      }

      /** Beside the entries of materials that give them a temperature. */
      static Parameters
      from_parameters(dealii::ParameterHandler &prm)
      {
        Parameters result{LudwikHardening::from_parameters(prm),
                          prm.get_double("Rate coefficient"),
                          prm.get_double("Reference rate")};
        if (prm.get("Specific heat").empty() &&
            prm.get("Prescribed temperature").empty())
          return result;
        result.reference_temperature = prm.get_double("Reference temperature");
        result.melting_temperature   = prm.get_double("Melting temperature");
        result.thermal_exponent      = prm.get_double("Thermal exponent");
        if (!(result.melting_temperature > result.reference_temperature))
          throw InputError("Melting temperature",
                           "found '" + prm.get("Melting temperature") +
                             "', allowed is more than 'Reference temperature'");
        return result;
      }

      LudwikHardening curve;            ///< A, B, n
      double          rate_coefficient; ///< C
      double          reference_rate;   ///< 1/s

      double reference_temperature = 0; ///< K
      double melting_temperature   = 0; ///< K, above that
      double thermal_exponent      = 0; ///< 0: temperature has no effect
    };

    JohnsonCookHardening(const MaterialSpec &spec,
                         PointLayout        &history,
                         const Parameters   &parameters)
      : spec(spec)
      , parameters(parameters)
      , plastic_offset(
          history.add("equivalent_plastic_strain", PointLayout::Kind::scalar))
      , work_offset(history.add("plastic_work", PointLayout::Kind::scalar))
    {}

    template <typename Number>
    class Limit
    {
    public:
      Limit(const Parameters &parameters,
            const Number     &before,
            const Number     &work_before,
            const Number     &softened,
            const double      slow_flow)
        : before(before)
        , parameters(parameters)
        , work_before(work_before)
        , softened(softened)
        , slow_flow(slow_flow)
      {}

      /** Yield stress (Pa). */
      Number
      yield_stress(const Number &flow) const
      {
        return softened * curve().yield_stress(Number(before + flow)) *
               by_rate(flow);
      }

      /** Its slope (Pa). */
      Number
      slope(const Number &flow) const
      {
        const Number end  = before + flow;
        const Number cold = curve().slope(end) * by_rate(flow) +
                            select(is_fast(flow),
                                   Number(parameters.rate_coefficient *
                                          curve().yield_stress(end) / flow),
                                   Number(0.));
        // a melt has none, where that of the curve is infinite, too
        return select(softened > 0., Number(softened * cold), Number(0.));
      }

      /** Its integral, and the plastic work of the past (J/m^3): of the
       * potential of a step. */
      Number
      work(const Number &flow) const
      {
        Number     done    = slow_work(flow);
        const auto is_fast = this->is_fast(flow);
        if (parameters.rate_coefficient > 0 && any_of(is_fast))
          done = select(is_fast,
                        Number(done * by_rate(flow) -
                               parameters.rate_coefficient * remainder(flow)),
                        done);
        return work_before +
               select(flow == 0., Number(0.), Number(softened * done));
      }

      /**
       * What a flow at the rate of the step, and the past, have dissipated
       * (J/m^3). The integral above is what the step minimizes: on the way it
       * meets slower rates, which no point has had, C / (1 + C ln) too little
       * however short a step is.
       */
      Number
      dissipated(const Number &flow) const
      {
        return work_before +
               select(flow == 0.,
                      Number(0.),
                      Number(softened * slow_work(flow) * by_rate(flow)));
      }

      const Number before; ///< alpha at the start

    private:
      const LudwikHardening &
      curve() const
      {
        return parameters.curve;
      }

      auto
      is_fast(const Number &flow) const
      {
        return flow > slow_flow;
      }

      /** 1 + C ln(max(1, rate / rate_0)). */
      Number
      by_rate(const Number &flow) const
      {
        const Number ratio =
          select(is_fast(flow), Number(flow / slow_flow), Number(1.));
        return 1. + parameters.rate_coefficient *
                      each([](const double x) { return std::log(x); }, ratio);
      }

      /** The integral at the reference rate, cold. */
      Number
      slow_work(const Number &flow) const
      {
        return curve().work(Number(before + flow)) - curve().work(before);
      }

      /**
       * The integral of slow_work(x) / x from the slow flow on, which
       * integration by parts leaves of the logarithm: by Gauss's rule in
       * x^(1/8), in which powers of the flow are smooth over all magnitudes.
       */
      Number
      remainder(const Number &flow) const
      {
        static const dealii::QGauss<1> rule(16);
        const Number                   begin = std::pow(slow_flow, 0.125),
                     length                  = power(flow, 0.125) - begin;
        Number sum                           = 0.;
        for (unsigned int i = 0; i < rule.size(); ++i)
          {
            const Number root = begin + rule.point(i)[0] * length;
            const Number half = root * root * root * root;
            sum += rule.weight(i) * slow_work(Number(half * half)) / root;
          }
        return 8. * length * sum;
      }

      const Parameters &parameters;
      const Number      work_before;
      const Number      softened;  ///< 1 - T*^m
      const double      slow_flow; ///< of the reference rate in this step
    };

    template <typename Number>
    Limit<Number>
    limit(const Material::BasicStep<Number> &step) const
    {
      const Number work = read(step.history, work_offset);
      // In no time any flow is infinitely fast.
      const Number softened = step.dt > 0 ?
                                softening(work, step.history) :
                                Number(std::numeric_limits<double>::infinity());
      return {parameters,
              read(step.history, plastic_offset),
              work,
              softened,
              parameters.reference_rate * step.dt};
    }

    template <typename Number>
    void
    store(const Limit<Number> &limit,
          const Number        &flow,
          const Number & /*potential*/,
          const Places<Number, double> &trial_history) const
    {
      write(limit.before + flow, trial_history, plastic_offset);
      write(limit.dissipated(flow), trial_history, work_offset);
    }

    /** At the reference rate and the temperature of now (Pa). */
    double
    yield_stress(const double *history) const
    {
      return softening<double>(history[work_offset], history) *
             parameters.curve.yield_stress(history[plastic_offset]);
    }

    double
    work(const double *history) const
    {
      return history[work_offset];
    }

  private:
    /** 1 - T*^m after some plastic work. */
    template <typename Number>
    Number
    softening(const Number                       &work,
              const Places<Number, const double> &history) const
    {
      if (parameters.thermal_exponent == 0)
        return 1.;
      const Number above =
        (spec.temperature(work, history) - parameters.reference_temperature) /
        (parameters.melting_temperature - parameters.reference_temperature);
      const Number share = select(above < 0., Number(0.), above);
      return select(share < 1.,
                    Number(1. - power(share, parameters.thermal_exponent)),
                    Number(0.));
    }

    const MaterialSpec spec;
    const Parameters   parameters;
    const unsigned int plastic_offset, work_offset;
  };
} // namespace impm

#endif
