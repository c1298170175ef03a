#ifndef impm_materials_log_strain_differences_h
#define impm_materials_log_strain_differences_h

#include <impm/base/lanes.h>

#include <algorithm>
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
    explicit LogDifferences(const std::array<Number, 3> &strain)
    {
      // Of degree zero in the stretches, whose mean is taken out.
      const Number mean = (strain[0] + strain[1] + strain[2]) / 3.;
      for (unsigned int a = 0; a < 3; ++a)
        {
          logarithm[a] = 2. * (strain[a] - mean);
          stretch[a]   = each([](const double x) { return std::exp(x); },
                            Number(strain[a] - mean));
        }
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = a; b < 3; ++b)
          for (unsigned int c = b; c < 3; ++c)
            second[a][b][c] = difference(a, b, c);
    }

    /** 2 lambda_c^2 lambda_a lambda_b ln[lambda_a^2, lambda_c^2, lambda_b^2].
     */
    Number
    around(const unsigned int a,
           const unsigned int c,
           const unsigned int b) const
    {
      std::array<unsigned int, 3> i{{a, b, c}};
      std::sort(i.begin(), i.end());
      return 2. * stretch[c] * stretch[c] * stretch[a] * stretch[b] *
             second[i[0]][i[1]][i[2]];
    }

  private:
    /** ln[l_a, l_b, l_c] at the squares l of stretches. */
    Number
    difference(const unsigned int a,
               const unsigned int b,
               const unsigned int c) const
    {
      std::array<Number, 3> x{{logarithm[a], logarithm[b], logarithm[c]}},
        l{{stretch[a] * stretch[a],
           stretch[b] * stretch[b],
           stretch[c] * stretch[c]}};
      const auto order = [&](const unsigned int i, const unsigned int j) {
        const auto   falls = x[i] > x[j];
        const Number x_i = x[i], l_i = l[i];
        x[i] = select(falls, x[j], x_i);
        x[j] = select(falls, x_i, x[j]);
        l[i] = select(falls, l[j], l_i);
        l[j] = select(falls, l_i, l[j]);
      };
      order(0, 1);
      order(1, 2);
      order(0, 1);

      // About the mean m, l = m (1 + z): the complete homogeneous symmetric
      // polynomials h_n of z, whose sum is zero, with the coefficients of the
      // logarithm; below 1e-16 of it is left out.
      const Number m  = (l[0] + l[1] + l[2]) / 3.;
      const Number z0 = (l[0] - m) / m, z1 = (l[1] - m) / m,
                   z2 = (l[2] - m) / m;
      const Number e2 = z0 * z1 + z0 * z2 + z1 * z2, e3 = z0 * z1 * z2;
      std::array<Number, 12> h;
      h[0]          = 1.;
      h[1]          = 0.;
      h[2]          = -e2;
      Number series = -0.5 * h[0] - 0.25 * h[2];
      for (unsigned int n = 3; n < 12; ++n)
        {
          h[n] = e3 * h[n - 3] - e2 * h[n - 2];
          series += (n % 2 == 0 ? -1. : 1.) / (n + 2) * h[n];
        }
      series /= m * m;
      const auto are_close = x[2] - x[0] < 0.05;
      if (all_of(are_close))
        return series;

      const auto first = [&](const unsigned int i, const unsigned int j) {
        using std::sqrt;
        return Number(x_over_sinh(Number(0.5 * (x[i] - x[j]))) /
                      sqrt(Number(l[i] * l[j])));
      };
      const Number apart = select(are_close, Number(1.), Number(l[2] - l[0]));
      return select(are_close,
                    series,
                    Number((first(2, 1) - first(1, 0)) / apart));
    }

    std::array<Number, 3>                               logarithm, stretch;
    std::array<std::array<std::array<Number, 3>, 3>, 3> second;
  };
} // namespace impm

#endif
