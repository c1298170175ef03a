#include <impm/materials/log_strain.h>

#include <cmath>

namespace impm::LogStrain
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  namespace
  {
    // Places of the components in the raw storage of symmetric tensors.
    constexpr unsigned int xx = 0, yy = 1, zz = 2, xy = 3, xz = 4, yz = 5,
                           n_components = 6;

    template <typename Number>
    Number &
    entry(SymmetricTensor<4, 3, Number> &c,
          const unsigned int             i,
          const unsigned int             j)
    {
      return c.access_raw_entry(n_components * i + j);
    }

    // x coth(x), even, 1 at 0. The series spares the tanh where strains are
    // moderate; what it leaves out is below 3e-18 at the switch.
    template <typename Number>
    Number
    x_coth_x(const Number &x)
    {
      const Number y        = x * x;
      const auto   is_small = y < 0.01;
      const Number series =
        1. + y * (1. / 3. +
                  y * (-1. / 45. + y * (2. / 945. + y * (-1. / 4725. +
                                                         y * (2. / 93555.)))));
      if (all_of(is_small))
        return series;
      const auto tanh = [](const double one) { return std::tanh(one); };
      return select(is_small, series, x / each(tanh, x));
    }

    template <typename Number>
    bool
    are_positive_and_finite(const Number &x)
    {
      return all_of(x > 0.) && all_of(is_finite(x));
    }

    template <typename Number>
    Number
    half_log(const Number &x)
    {
      return 0.5 * each([](const double one) { return std::log(one); }, x);
    }

    // The case of the 2D geometries, xz = yz = 0.
    template <typename Number>
    bool
    decompose_planar(const SymmetricTensor<2, 3, Number> &b,
                     PrincipalStrains<Number>            &p)
    {
      using std::abs;
      using std::copysign;
      using std::sqrt;
      const Number mean            = 0.5 * (b[0][0] + b[1][1]);
      const Number half_difference = 0.5 * (b[0][0] - b[1][1]);
      const Number shear           = b[0][1];
      const Number radius =
        sqrt(half_difference * half_difference + shear * shear);

      // mean - radius would lose the digits of small stretches
      const Number larger  = mean + radius;
      const Number smaller = (b[0][0] * b[1][1] - shear * shear) / larger;

      if (!are_positive_and_finite(smaller) ||
          !are_positive_and_finite<Number>(b[2][2]))
        return false;

      // Below this the squares may underflow, and the axes do not matter.
      const auto   has_axes = radius > 1e-30 * mean;
      const Number divisor  = select(has_axes, radius, Number(1.));
      // half-angle formulas, each where it does not cancel
      const Number major = sqrt(0.5 * (1. + abs(half_difference) / divisor));
      const Number minor = 0.5 * shear / (divisor * major);
      const auto   along = half_difference >= 0.;
      const Number c =
        select(has_axes, select(along, major, Number(abs(minor))), Number(1.));
      const Number s =
        select(has_axes,
               select(along, minor, Number(copysign(major, shear))),
               Number(0.));
      const Number zero = 0., one = 1.;
      p.axis[0] = Tensor<1, 3, Number>({c, s, zero});
      p.axis[1] = Tensor<1, 3, Number>({-s, c, zero});
      p.axis[2] = Tensor<1, 3, Number>({zero, zero, one});

      p.strain = {
        {half_log(larger), half_log(smaller), half_log<Number>(b[2][2])}};
      p.planar = true;
      return true;
    }

    /**
     * Jacobi's method, which finds small values beside large ones: turns axes
     * p and q until no product of values is small against a shear between
     * them. Returns false if that takes too long, as with numbers that are not
     * finite.
     */
    template <typename Number>
    bool
    diagonalize(const SymmetricTensor<2, 3, Number> &tensor,
                Triple<Number>                      &values,
                Triple<Tensor<1, 3, Number>>        &axes)
    {
      using std::abs;
      using std::sqrt;
      // Shear and values by their places: xy is that of axes 0 and 1.
      Triple<Number> shear = {{tensor[1][2], tensor[0][2], tensor[0][1]}};
      for (unsigned int a = 0; a < 3; ++a)
        {
          values[a]  = tensor[a][a];
          axes[a]    = Tensor<1, 3, Number>();
          axes[a][a] = 1.;
        }
      const double negligible = 1e-34; // square of what round-off hides
      for (unsigned int sweep = 0; sweep < 20; ++sweep)
        {
          bool is_done = true;
          for (unsigned int r = 0; r < 3; ++r)
            {
              const unsigned int p = (r + 1) % 3, q = (r + 2) % 3;
              const Number       twist = shear[r];
              const auto         turns =
                twist * twist > negligible * abs(values[p] * values[q]);
              if (!any_of(turns))
                continue;
              is_done            = false;
              const Number safe  = select(turns, twist, Number(1.));
              const Number slant = 0.5 * (values[q] - values[p]) / safe;
              const Number size  = 1. / (abs(slant) + sqrt(slant * slant + 1.));
              const Number t     = select(turns,
                                      select(slant < 0., Number(-size), size),
                                      Number(0.));
              const Number c = 1. / sqrt(t * t + 1.), s = t * c;
              values[p] -= t * twist;
              values[q] += t * twist;
              shear[r] = select(turns, Number(0.), twist);
              // c = 1 - s half, which leaves what hardly turns alone
              const Number half   = s / (1. + c);
              const auto   rotate = [&](auto &at_p, auto &at_q) {
                const auto old = at_p;
                at_p           = at_p - s * (at_q + half * at_p);
                at_q           = at_q + s * (old - half * at_q);
              };
              rotate(shear[q], shear[p]);
              rotate(axes[p], axes[q]);
            }
          if (is_done)
            return true;
        }
      return false;
    }

    // n m + m n in raw storage
    template <typename Number>
    std::array<Number, n_components>
    dyad(const Tensor<1, 3, Number> &n, const Tensor<1, 3, Number> &m)
    {
      return {{2. * n[0] * m[0],
               2. * n[1] * m[1],
               2. * n[2] * m[2],
               n[0] * m[1] + n[1] * m[0],
               n[0] * m[2] + n[2] * m[0],
               n[1] * m[2] + n[2] * m[1]}};
    }

    template <typename Number>
    void
    planar_tangent(const PrincipalStrains<Number> &p,
                   const Triple<Triple<Number>>   &axial,
                   const Triple<Number>           &shear,
                   SymmetricTensor<4, 3, Number>  &tangent)
    {
      const Number c = p.axis[0][0], s = p.axis[0][1];

      // n_0 n_0, n_1 n_1 and n_0 n_1 + n_1 n_0 in these components
      constexpr std::array<unsigned int, 3> in_plane = {{xx, yy, xy}};
      const Triple<Number>                  p_0      = {{c * c, s * s, c * s}};
      const Triple<Number>                  p_1      = {{s * s, c * c, -c * s}};
      const Triple<Number> p_01 = {{-2. * c * s, 2. * c * s, c * c - s * s}};

      tangent = SymmetricTensor<4, 3, Number>();
      for (unsigned int j = 0; j < 3; ++j)
        {
          const Number of_0 = axial[0][0] * p_0[j] + axial[0][1] * p_1[j];
          const Number of_1 = axial[1][0] * p_0[j] + axial[1][1] * p_1[j];
          const Number turn = shear[0] * p_01[j];
          for (unsigned int i = 0; i < 3; ++i)
            entry(tangent, in_plane[i], in_plane[j]) =
              p_0[i] * of_0 + p_1[i] * of_1 + p_01[i] * turn;

          entry(tangent, in_plane[j], zz) =
            axial[0][2] * p_0[j] + axial[1][2] * p_1[j];
          entry(tangent, zz, in_plane[j]) =
            axial[2][0] * p_0[j] + axial[2][1] * p_1[j];
        }
      entry(tangent, zz, zz) = axial[2][2];
      entry(tangent, xz, xz) = shear[1] * p_0[0] + shear[2] * p_1[0];
      entry(tangent, yz, yz) = shear[1] * p_0[1] + shear[2] * p_1[1];
      entry(tangent, xz, yz) = entry(tangent, yz, xz) =
        shear[1] * p_0[2] + shear[2] * p_1[2];
    }

    template <typename Number>
    void
    spatial_tangent(const PrincipalStrains<Number> &p,
                    const Triple<Triple<Number>>   &axial,
                    const Triple<Number>           &shear,
                    SymmetricTensor<4, 3, Number>  &tangent)
    {
      // the dyads of equal axes are twice n_a n_a
      using Dyads       = Triple<std::array<Number, n_components>>;
      const auto &n     = p.axis;
      const Dyads equal = {
        {dyad(n[0], n[0]), dyad(n[1], n[1]), dyad(n[2], n[2])}};
      const Dyads mixed = {
        {dyad(n[0], n[1]), dyad(n[0], n[2]), dyad(n[1], n[2])}};

      for (unsigned int i = 0; i < n_components; ++i)
        {
          Triple<Number> of_equal, of_mixed;
          for (unsigned int b = 0; b < 3; ++b)
            {
              of_equal[b] =
                0.25 * (equal[0][i] * axial[0][b] + equal[1][i] * axial[1][b] +
                        equal[2][i] * axial[2][b]);
              of_mixed[b] = shear[b] * mixed[b][i];
            }
          for (unsigned int j = 0; j < n_components; ++j)
            {
              Number sum = 0.;
              for (unsigned int b = 0; b < 3; ++b)
                sum += of_equal[b] * equal[b][j] + of_mixed[b] * mixed[b][j];
              entry(tangent, i, j) = sum;
            }
        }
    }
  } // namespace

  template <typename Number>
  bool
  decompose(const SymmetricTensor<2, 3, Number> &b, PrincipalStrains<Number> &p)
  {
    if (all_of(b[0][2] == Number(0.)) && all_of(b[1][2] == Number(0.)))
      return decompose_planar(b, p);
    Triple<Number> values;
    if (!diagonalize(b, values, p.axis))
      return false;
    for (unsigned int a = 0; a < 3; ++a)
      {
        if (!are_positive_and_finite(values[a]))
          return false;
        p.strain[a] = half_log(values[a]);
      }
    p.planar = false;
    return true;
  }

  template <typename Number>
  SymmetricTensor<2, 3, Number>
  compose(const Triple<Number>           &values,
          const PrincipalStrains<Number> &principal)
  {
    SymmetricTensor<2, 3, Number> t;
    if (principal.planar)
      {
        const Number c = principal.axis[0][0], s = principal.axis[0][1];
        t[0][0] = values[0] * c * c + values[1] * s * s;
        t[1][1] = values[0] * s * s + values[1] * c * c;
        t[0][1] = (values[0] - values[1]) * c * s;
        t[2][2] = values[2];
      }
    else
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          {
            Number sum = 0.;
            for (unsigned int a = 0; a < 3; ++a)
              sum += values[a] * principal.axis[a][i] * principal.axis[a][j];
            t[i][j] = sum;
          }
    return t;
  }

  template <typename Number>
  void
  lie_tangent(const PrincipalStrains<Number> &principal,
              const PrincipalStress<Number>  &response,
              SymmetricTensor<4, 3, Number>  &tangent)
  {
    auto axial = response.moduli;
    for (unsigned int a = 0; a < 3; ++a)
      axial[a][a] -= 2. * response.stress[a];

    // half of g_ab: the factor of a squared dyad n_a n_b + n_b n_a
    const auto turning = [&](const unsigned int a,
                             const unsigned int b) -> Number {
      const Number apart = principal.strain[a] - principal.strain[b];
      return 0.5 * (response.secant[a + b - 1] * x_coth_x(apart) -
                    (response.stress[a] + response.stress[b]));
    };
    const Triple<Number> shear = {
      {turning(0, 1), turning(0, 2), turning(1, 2)}};

    if (principal.planar)
      planar_tangent(principal, axial, shear, tangent);
    else
      spatial_tangent(principal, axial, shear, tangent);
  }

  template decltype(decompose<double>)   decompose<double>;
  template decltype(decompose<Lanes>)    decompose<Lanes>;
  template decltype(compose<double>)     compose<double>;
  template decltype(compose<Lanes>)      compose<Lanes>;
  template decltype(lie_tangent<double>) lie_tangent<double>;
  template decltype(lie_tangent<Lanes>)  lie_tangent<Lanes>;
} // namespace impm::LogStrain
