#ifndef impm_materials_hardening_piecewise_linear_h
#define impm_materials_hardening_piecewise_linear_h

#include <impm/base/lanes.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace impm
{
  /**
   * A yield stress that is linear in the equivalent plastic strain between
   * given points and constant behind the last one. It may fall.
   */
  class PiecewiseLinearHardening
  {
  public:
    /** A strain and the yield stress there (Pa). */
    using Point = std::pair<double, double>;

    /** The first strain is 0, they increase. */
    explicit PiecewiseLinearHardening(const std::vector<Point> &points)
    {
      double work = 0;
      for (unsigned int i = 0; i < points.size(); ++i)
        {
          const auto [strain, stress] = points[i];
          Segment segment{strain, stress, 0., work};
          if (i + 1 < points.size())
            {
              const auto [end, stress_there] = points[i + 1];
              segment.slope = (stress_there - stress) / (end - strain);
              work += 0.5 * (stress + stress_there) * (end - strain);
            }
          segments.push_back(segment);
        }
    }

    /** Yield stress (Pa). */
    template <typename Number>
    Number
    yield_stress(const Number &plastic_strain) const
    {
      return of_segments(plastic_strain, [](const Segment &s, const double x) {
        return s.stress + s.slope * x;
      });
    }

    /** Its slope (Pa), where two lines meet that of the second. */
    template <typename Number>
    Number
    slope(const Number &plastic_strain) const
    {
      return of_segments(plastic_strain, [](const Segment &s, const double) {
        return s.slope;
      });
    }

    /** Its integral since the start: plastic work (J/m^3). */
    template <typename Number>
    Number
    work(const Number &plastic_strain) const
    {
      return of_segments(plastic_strain, [](const Segment &s, const double x) {
        return s.work + (s.stress + 0.5 * s.slope * x) * x;
      });
    }

    double
    least_slope() const
    {
      return std::min_element(segments.begin(),
                              segments.end(),
                              [](const auto &a, const auto &b) {
                                return a.slope < b.slope;
                              })
        ->slope;
    }

  private:
    struct Segment
    {
      double begin;  ///< plastic strain
      double stress; ///< there (Pa)
      double slope;  ///< from there on (Pa)
      double work;   ///< up to there (J/m^3)
    };

    /** `value` of the segment of a strain and of the strain in it. */
    template <typename Number, typename Value>
    Number
    of_segments(const Number &plastic_strain, const Value &value) const
    {
      return each(
        [&](const double strain) {
          unsigned int s = segments.size() - 1;
          while (s > 0 && strain < segments[s].begin)
            --s;
          return value(segments[s], strain - segments[s].begin);
        },
        plastic_strain);
    }

    std::vector<Segment> segments;
  };
} // namespace impm

#endif
