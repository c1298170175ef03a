#include <impm/contact/layer.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  namespace
  {
    /** t - log(1 + t), to all digits. */
    double
    less_logarithm(const double t)
    {
      if (t > 1e-2)
        return t - std::log1p(t);
      double sum = 0;
      for (unsigned int n = 9; n > 1; --n)
        sum = 1. / n - t * sum;
      return t * t * sum;
    }
  } // namespace

  Layer
  layer_at(const double k, const double gap)
  {
    const double closed = std::max(0., -gap);
    return {k * closed, closed > 0 ? k : 0., 0.5 * k * closed * closed};
  }

  Layer
  layer_over(const double k,
             const double start,
             const double end,
             const double weight)
  {
    const bool   part = start < 0 && end > 0, meet = start > 0 && end < 0;
    const double t     = part || meet ? -end / start : 0.;
    const double apart = 1 / (1 + t);
    if (part && weight < 1)
      {
        const double let_go = (1 - weight) / weight * k;
        return {let_go * start * t * apart,
                let_go * apart * apart,
                let_go * start * start * less_logarithm(t)};
      }
    if (meet && weight == 0.5)
      return {-k * end * t * apart,
              k * (1 - apart * apart),
              k * start * start * (0.5 * t * t - less_logarithm(t))};
    return layer_at(k, end);
  }
} // namespace impm
