#ifndef impm_materials_hardening_find_flow_h
#define impm_materials_hardening_find_flow_h

#include <impm/base/lanes.h>

#include <cmath>
#include <limits>

namespace impm
{
  /** Of a yield stress, by more than round-off. */
  inline bool
  has_fallen(const double before, const double now)
  {
    return now < (1 - 1e-12) * before;
  }

  /**
   * Backward Euler: how far a point flows whose von Mises stress `trial` (Pa)
   * goes down by `relief` (3 G) times the flow until it is at the limit,
   *
   *   trial - relief flow = limit.yield_stress(flow),
   *
   * to 1e-14 of it, or as closely as numbers can tell the flow where the limit
   * jumps. The limit falls by less than the relief, so that there is
   * one solution. It need not be smooth, convex or concave, and may have an
   * infinite slope at 0: what Newton's method finds has to lie where the
   * solution can be and to halve what is left, or else the magnitudes that the
   * flow can have are bisected. 0 where the trial stress is below the limit,
   * NaN where there is no solution.
   */
  template <typename Number, typename Limit>
  Number
  find_flow(const Number &trial, const Limit &limit, const double relief)
  {
    using std::abs;
    using std::sqrt;
    constexpr double tiny     = std::numeric_limits<double>::min();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double epsilon  = std::numeric_limits<double>::epsilon();

    const Number zero    = 0.;
    const Number excess  = trial - limit.yield_stress(zero);
    auto         is_done = excess <= 0.;
    if (all_of(is_done))
      return zero;
    Number flow =
      select(is_done, zero, Number(excess / (relief + limit.slope(zero))));
    // the solution is between them
    Number lower = 0., upper = trial / relief;
    Number last = infinity; // what Newton's method has left
    for (unsigned int i = 0; i < 200; ++i)
      {
        const Number end  = limit.yield_stress(flow);
        const Number rest = trial - relief * flow - end;
        const Number size = abs(rest);
        is_done = is_done || size <= 1e-14 * end + 4 * epsilon * trial;
        if (all_of(is_done))
          return flow;
        if (!all_of(is_done || is_finite(rest)))
          break;

        const auto falls_short = rest > 0.;
        lower                  = select(falls_short, flow, lower);
        upper                  = select(falls_short, upper, flow);
        is_done = is_done || upper - lower <= epsilon * upper || upper <= tiny;

        Number     next = flow + rest / (relief + limit.slope(flow));
        const auto converges =
          next > lower && next < upper && size <= 0.5 * last;
        last = select(converges, size, Number(infinity));
        if (!all_of(is_done || converges))
          {
            const Number least  = select(lower > tiny, lower, Number(tiny));
            const Number middle = select(upper > 2. * least,
                                         Number(sqrt(least) * sqrt(upper)),
                                         Number(lower + 0.5 * (upper - lower)));
            next                = select(converges, next, middle);
          }
        flow = select(is_done, flow, next);
      }
    return select(is_done,
                  flow,
                  Number(std::numeric_limits<double>::quiet_NaN()));
  }
} // namespace impm

#endif
