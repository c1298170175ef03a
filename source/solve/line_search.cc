#include <impm/solve/line_search.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  double
  backtrack(const bool                         is_on,
            const bool                         by_potential,
            const double                       slope,
            const NonlinearSystem::Evaluation &before,
            const std::function<NonlinearSystem::Evaluation(double)> &evaluate)
  {
    // Energies cancel to round-off near the solution: hence the slack.
    const double slack =
      1e-9 * std::abs(slope) + 1e-13 * std::abs(before.potential);
    const auto accept = [&](const auto &now, const double part) {
      if (!now.admissible)
        return false;
      if (!is_on)
        return true;
      if (by_potential)
        return now.potential <=
                 before.potential + 1e-4 * part * slope + slack ||
               now.residual <= 0.1 * before.residual;
      return now.residual <= (1 - 1e-4 * part) * before.residual;
    };
    const double shortest = 1. / 1024;
    for (double part = 1; part >= shortest;)
      {
        const auto now = evaluate(part);
        if (accept(now, part))
          return part;
        // The parabola through what is known has its least value there.
        double factor = 0.5;
        if (by_potential && now.admissible)
          factor = std::clamp(-slope * part /
                                (2 * (now.potential - before.potential -
                                      slope * part)),
                              0.1,
                              0.5);
        part *= factor;
      }
    return 0;
  }
} // namespace impm
