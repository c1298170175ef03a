#ifndef impm_materials_log_strain_differences_h
#define impm_materials_log_strain_differences_h

#include <impm/base/lanes.h>

#include <array>
#include <cmath>

namespace impm
{
  /** x / sinh x, even, 1 at 0; what the series leaves out is below 3e-18. */
  template <typename Number>
  Number
  x_over_sinh(const Number &x)
  {
    const Number y        = x * x;
    const auto   is_small = y < 0.01;
    const Number series =
      1. +
      y * (-1. / 6 +
           y * (7. / 360 + y * (-31. / 15120 +
                                y * (127. / 604800 + y * (-73. / 3421440)))));
    if (all_of(is_small))
      return series;
    const auto sinh = [](const double one) { return std::sinh(one); };
    return select(is_small,
                  series,
                  Number(x / each(sinh, select(is_small, Number(1.), x))));
  }

  /**
   * Second divided differences of the logarithm at the squares of stretches
   * exp(eps_a): how strains of Lagrangian logarithms change when their axes
   * turn.
   */
  template <typename Number>
  class LogDifferences
  {
  public:
    /** With x_over_sinh of the differences 01, 02, 12 of the strains. */
    LogDifferences(const std::array<Number, 3> &strain,
                   const std::array<Number, 3> &ratios)
    {
      // Of degree zero in the stretches, whose mean is taken out.
      const Number mean = (strain[0] + strain[1] + strain[2]) / 3.;
      for (unsigned int a = 0; a < 3; ++a)
        {
          stretch[a] = each([](const double x) { return std::exp(x); },
                            Number(strain[a] - mean));
          square[a]  = stretch[a] * stretch[a];
        }
      const auto first = [&](const unsigned int a, const unsigned int b) {
        return Number(ratios[a + b - 1] / (stretch[a] * stretch[b]));
      };
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          if (a == b)
            second[a][a][a] = -0.5 / (square[a] * square[a]);
          else
            second[a][a][b] = second[a][b][a] = second[b][a][a] =
              difference(1. / square[a] - first(a, b),
                         square[a] - square[b],
                         {{square[a], square[a], square[b]}});
      // by the largest of the three differences of squares
      using std::abs;
      Number     rise = first(0, 1) - first(1, 2), run = square[0] - square[2];
      const auto take_if_larger = [&](const Number &other_rise,
                                      const Number &other_run) {
        const auto is_larger = abs(other_run) > abs(run);
        rise                 = select(is_larger, other_rise, rise);
        run                  = select(is_larger, other_run, run);
      };
      take_if_larger(first(0, 2) - first(1, 2), square[0] - square[1]);
      take_if_larger(first(0, 1) - first(0, 2), square[1] - square[2]);
      const Number of_all = difference(rise, run, square);
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          if (a != b)
            second[a][b][3 - a - b] = of_all;
    }

    /** 2 lambda_c^2 lambda_a lambda_b ln[lambda_a^2, lambda_c^2, lambda_b^2].
     */
    Number
    around(const unsigned int a,
           const unsigned int c,
           const unsigned int b) const
    {
      return 2. * square[c] * stretch[a] * stretch[b] * second[a][c][b];
    }

  private:
    /** rise / run or, where the squares meet, a series in what they are apart,
     * relative to their mean. */
    static Number
    difference(const Number                &rise,
               const Number                &run,
               const std::array<Number, 3> &squares)
    {
      using std::abs;
      const Number mean   = (squares[0] + squares[1] + squares[2]) / 3.;
      const auto   meet   = abs(run) < 0.05 * mean;
      Number       series = 0.;
      if (any_of(meet))
        {
          // ln at mean (1 + z): complete homogeneous symmetric polynomials h_n
          // of the three z, whose sum is zero, with the coefficients of the
          // logarithm. Left out is less than 1e-16 of it.
          std::array<Number, 3> z;
          for (unsigned int i = 0; i < 3; ++i)
            z[i] = (squares[i] - mean) / mean;
          const Number e2 = z[0] * z[1] + z[0] * z[2] + z[1] * z[2],
                       e3 = z[0] * z[1] * z[2];
          std::array<Number, 12> h;
          h[0]   = 1.;
          h[1]   = 0.;
          h[2]   = -e2;
          series = -0.5 * h[0] - 0.25 * h[2];
          for (unsigned int n = 3; n < 12; ++n)
            {
              h[n] = e3 * h[n - 3] - e2 * h[n - 2];
              series += (n % 2 == 0 ? -1. : 1.) / (n + 2) * h[n];
            }
          series /= mean * mean;
          if (all_of(meet))
            return series;
        }
      return select(meet, series, Number(rise / select(meet, Number(1.), run)));
    }

    std::array<Number, 3>                               stretch, square;
    std::array<std::array<std::array<Number, 3>, 3>, 3> second;
  };
} // namespace impm

#endif
