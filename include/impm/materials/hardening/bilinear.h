#ifndef impm_materials_hardening_bilinear_h
#define impm_materials_hardening_bilinear_h

#include <impm/base/exceptions.h>
#include <impm/materials/elastic_constants.h>
#include <impm/materials/hardening/linear.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace impm
{
  /**
   * A yield stress that is piecewise linear in the equivalent plastic strain
   * (Sulsky & Kaul 2004, eq. 2.1.19): it grows up to a limit strain, falls
   * behind it, and stays where it reaches zero.
   */
  class BilinearHardening
  {
  public:
    /**
     * Behind the limit strain (0: none) it falls with the softening modulus
     * (Pa, >= 0).
     */
    BilinearHardening(const LinearHardening &linear,
                      const double           limit_strain = 0,
                      const double           softening    = 0)
    {
      segments.push_back({0., linear, 0.});
      if (!(limit_strain > 0))
        return;
      const double highest = linear.yield_stress(limit_strain);
      segments.push_back(
        {limit_strain, {highest, -softening}, work(limit_strain)});
      if (!(softening > 0))
        return;
      const double end = limit_strain + highest / softening;
      segments.push_back({end, {0., 0.}, work(end)});
    }

    static void
    declare_parameters(dealii::ParameterHandler    &prm,
                       const ParameterFile::Chosen &chosen)
    {
      LinearHardening::declare_parameters(prm, chosen);
      prm.declare_entry("Limit strain",
                        "0",
                        dealii::Patterns::Double(0.),
                        "Equivalent plastic strain behind which the material "
                        "softens; 0: none.");
      const std::string limit = chosen("Limit strain", "0");
      if (limit == "any" || std::atof(limit.c_str()) != 0)
        prm.declare_entry("Softening modulus",
                          "0",
                          dealii::Patterns::Double(0.),
                          "How fast the yield stress falls behind the limit "
                          "strain (Pa), less than three shear moduli; it stays "
                          "where it reaches zero.");
    }

    /** Beside the parameters of ElasticConstants. */
    static BilinearHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      const auto   linear = LinearHardening::from_parameters(prm);
      const double limit  = prm.get_double("Limit strain");
      if (!(limit > 0))
        return {linear};
      const double softening = prm.get_double("Softening modulus");
      const double resistance =
        3 * ElasticConstants::from_parameters(prm).shear;
      if (!(softening < resistance))
        throw InputError("Softening modulus",
                         "found '" + prm.get("Softening modulus") +
                           "', allowed is less than three shear moduli = " +
                           std::to_string(resistance) +
                           " Pa, or the stress would fall by itself");
      return {linear, limit, softening};
    }

    /** Yield stress (Pa). */
    double
    yield_stress(const double plastic_strain) const
    {
      const Segment &s = segment(plastic_strain);
      return s.line.yield_stress(plastic_strain - s.begin);
    }

    /** Its integral since the start: plastic work (J/m^3). */
    double
    work(const double plastic_strain) const
    {
      const Segment &s = segment(plastic_strain);
      return s.work + s.line.work(plastic_strain - s.begin);
    }

    struct Flow
    {
      double plastic_strain; ///< at the end
      double slope;          ///< of the yield stress there (Pa)
    };

    /**
     * Where the von Mises stress `trial` falls on the yield stress when it
     * goes down by `resistance` (3 G) times the flow: backward Euler. The
     * trial stress is above the yield stress.
     */
    Flow
    flow(const double trial,
         const double plastic_strain,
         const double resistance) const
    {
      for (const Segment *s = &segment(plastic_strain);; ++s)
        {
          const double from = std::max(plastic_strain, s->begin);
          // trial - resistance (x - plastic_strain) = limit + slope (x - from)
          const double slope  = s->line.modulus;
          const double excess = trial - resistance * (from - plastic_strain) -
                                s->line.initial - slope * (from - s->begin);
          const double end = from + excess / (resistance + slope);
          if (s == &segments.back() || !(end > (s + 1)->begin))
            return {end, slope};
        }
    }

  private:
    struct Segment
    {
      double          begin; ///< plastic strain
      LinearHardening line;  ///< from there on
      double          work;  ///< up to there
    };

    const Segment &
    segment(const double plastic_strain) const
    {
      unsigned int s = segments.size() - 1;
      while (s > 0 && plastic_strain < segments[s].begin)
        --s;
      return segments[s];
    }

    std::vector<Segment> segments;
  };
} // namespace impm

#endif
