#ifndef impm_materials_hardening_curve_hardening_h
#define impm_materials_hardening_curve_hardening_h

#include <impm/base/lanes.h>
#include <impm/materials/material.h>

namespace impm
{
  /**
   * Hardening by the equivalent plastic strain alpha alone. A curve has the
   * yield stress (Pa), its slope (Pa) and its integral (J/m^3) of alpha.
   *
   * This is what laws see of hardening: limit() of a step, whose functions take
   * the flow of the step, by how much alpha grows in it; store(); and of a
   * history yield_stress() and work().
   *
   * History: "equivalent_plastic_strain" alpha (-).
   */
  template <typename Curve>
  class CurveHardening
  {
  public:
    static constexpr const char *name = Curve::name;

    using Parameters = Curve;

    CurveHardening(const MaterialSpec &,
                   PointLayout &history,
                   const Curve &curve)
      : curve(curve)
      , plastic_offset(
          history.add("equivalent_plastic_strain", PointLayout::Kind::scalar))
    {}

    /** What limits the stress while a point flows in a step. */
    template <typename Number>
    struct Limit
    {
      /** Yield stress (Pa). */
      Number
      yield_stress(const Number &flow) const
      {
        return curve.yield_stress(Number(before + flow));
      }

      /** Its slope (Pa). */
      Number
      slope(const Number &flow) const
      {
        return curve.slope(Number(before + flow));
      }

      /** Its integral, and the plastic work of the past (J/m^3). */
      Number
      work(const Number &flow) const
      {
        return curve.work(Number(before + flow));
      }

      const Curve &curve;
      const Number before; ///< alpha at the start
    };

    template <typename Number>
    Limit<Number>
    limit(const Material::BasicStep<Number> &step) const
    {
      return {curve, read(step.history, plastic_offset)};
    }

    /** What a point remembers at the end of a step. */
    template <typename Number>
    void
    store(const Limit<Number> &limit,
          const Number        &flow,
          const Number & /*work*/,
          const Places<Number, double> &trial_history) const
    {
      write(limit.before + flow, trial_history, plastic_offset);
    }

    /** Of a point that has flowed so far (Pa). */
    double
    yield_stress(const double *history) const
    {
      return curve.yield_stress(history[plastic_offset]);
    }

    /** Plastic work since the start (J/m^3). */
    double
    work(const double *history) const
    {
      return curve.work(history[plastic_offset]);
    }

  private:
    const Curve        curve;
    const unsigned int plastic_offset;
  };
} // namespace impm

#endif
