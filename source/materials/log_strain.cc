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

    double &
    entry(SymmetricTensor<4, 3> &c, const unsigned int i, const unsigned int j)
    {
      return c.access_raw_entry(n_components * i + j);
    }

    // x coth(x), even, 1 at 0. The series spares the tanh where strains are
    // moderate; what it leaves out is below 3e-18 at the switch.
    double
    x_coth_x(const double x)
    {
      const double y = x * x;
      if (y < 0.01)
        return 1. +
               y * (1. / 3. + y * (-1. / 45. +
                                   y * (2. / 945. + y * (-1. / 4725. +
                                                         y * (2. / 93555.)))));
      return x / std::tanh(x);
    }

    bool
    positive_and_finite(const double x)
    {
      return x > 0. && std::isfinite(x);
    }

    // The case of the 2D geometries, xz = yz = 0.
    bool
    decompose_planar(const SymmetricTensor<2, 3> &b, PrincipalStrains &p)
    {
      const double mean            = 0.5 * (b[0][0] + b[1][1]);
      const double half_difference = 0.5 * (b[0][0] - b[1][1]);
      const double shear           = b[0][1];
      const double radius =
        std::sqrt(half_difference * half_difference + shear * shear);

      // mean - radius would lose the digits of small stretches
      const double larger  = mean + radius;
      const double smaller = (b[0][0] * b[1][1] - shear * shear) / larger;

      if (!positive_and_finite(smaller) || !positive_and_finite(b[2][2]))
        return false;

      // Below this the squares may underflow, and the axes do not matter.
      double c = 1., s = 0.;
      if (radius > 1e-30 * mean)
        {
          // half-angle formulas, each where it does not cancel
          const double major =
            std::sqrt(0.5 * (1. + std::abs(half_difference) / radius));
          const double minor = 0.5 * shear / (radius * major);
          c                  = half_difference >= 0. ? major : std::abs(minor);
          s = half_difference >= 0. ? minor : std::copysign(major, shear);
        }
      p.axis[0] = Tensor<1, 3>({c, s, 0.});
      p.axis[1] = Tensor<1, 3>({-s, c, 0.});
      p.axis[2] = Tensor<1, 3>({0., 0., 1.});

      p.strain = {{0.5 * std::log(larger),
                   0.5 * std::log(smaller),
                   0.5 * std::log(b[2][2])}};
      p.planar = true;
      return true;
    }

    // n m + m n in raw storage
    std::array<double, n_components>
    dyad(const Tensor<1, 3> &n, const Tensor<1, 3> &m)
    {
      return {{2. * n[0] * m[0],
               2. * n[1] * m[1],
               2. * n[2] * m[2],
               n[0] * m[1] + n[1] * m[0],
               n[0] * m[2] + n[2] * m[0],
               n[1] * m[2] + n[2] * m[1]}};
    }

    using Matrix = std::array<std::array<double, 3>, 3>;

    void
    planar_tangent(const PrincipalStrains      &p,
                   const Matrix                &axial,
                   const std::array<double, 3> &shear,
                   SymmetricTensor<4, 3>       &tangent)
    {
      const double c = p.axis[0][0], s = p.axis[0][1];

      // n_0 n_0, n_1 n_1 and n_0 n_1 + n_1 n_0 in these components
      constexpr std::array<unsigned int, 3> in_plane = {{xx, yy, xy}};
      const std::array<double, 3>           p_0      = {{c * c, s * s, c * s}};
      const std::array<double, 3>           p_1      = {{s * s, c * c, -c * s}};
      const std::array<double, 3>           p_01     = {
                      {-2. * c * s, 2. * c * s, c * c - s * s}};

      tangent = 0.;
      for (unsigned int j = 0; j < 3; ++j)
        {
          const double of_0 = axial[0][0] * p_0[j] + axial[0][1] * p_1[j];
          const double of_1 = axial[1][0] * p_0[j] + axial[1][1] * p_1[j];
          const double turn = shear[0] * p_01[j];
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

    void
    spatial_tangent(const PrincipalStrains      &p,
                    const Matrix                &axial,
                    const std::array<double, 3> &shear,
                    SymmetricTensor<4, 3>       &tangent)
    {
      // the dyads of equal axes are twice n_a n_a
      using Dyads       = std::array<std::array<double, n_components>, 3>;
      const auto &n     = p.axis;
      const Dyads equal = {
        {dyad(n[0], n[0]), dyad(n[1], n[1]), dyad(n[2], n[2])}};
      const Dyads mixed = {
        {dyad(n[0], n[1]), dyad(n[0], n[2]), dyad(n[1], n[2])}};

      for (unsigned int i = 0; i < n_components; ++i)
        {
          std::array<double, 3> of_equal, of_mixed;
          for (unsigned int b = 0; b < 3; ++b)
            {
              of_equal[b] =
                0.25 * (equal[0][i] * axial[0][b] + equal[1][i] * axial[1][b] +
                        equal[2][i] * axial[2][b]);
              of_mixed[b] = shear[b] * mixed[b][i];
            }
          for (unsigned int j = 0; j < n_components; ++j)
            {
              double sum = 0.;
              for (unsigned int b = 0; b < 3; ++b)
                sum += of_equal[b] * equal[b][j] + of_mixed[b] * mixed[b][j];
              entry(tangent, i, j) = sum;
            }
        }
    }
  } // namespace

  bool
  decompose(const SymmetricTensor<2, 3> &b, PrincipalStrains &p)
  {
    if (b[0][2] == 0. && b[1][2] == 0.)
      return decompose_planar(b, p);
    if (!std::isfinite(b.norm()))
      return false;
    const auto eigen =
      dealii::eigenvectors(b, dealii::SymmetricTensorEigenvectorMethod::jacobi);
    for (unsigned int a = 0; a < 3; ++a)
      {
        if (!positive_and_finite(eigen[a].first))
          return false;
        p.strain[a] = 0.5 * std::log(eigen[a].first);
        p.axis[a]   = eigen[a].second;
      }
    p.planar = false;
    return true;
  }

  SymmetricTensor<2, 3>
  compose(const std::array<double, 3> &values,
          const PrincipalStrains      &principal)
  {
    SymmetricTensor<2, 3> t;
    if (principal.planar)
      {
        const double c = principal.axis[0][0], s = principal.axis[0][1];
        t[0][0] = values[0] * c * c + values[1] * s * s;
        t[1][1] = values[0] * s * s + values[1] * c * c;
        t[0][1] = (values[0] - values[1]) * c * s;
        t[2][2] = values[2];
      }
    else
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          for (unsigned int a = 0; a < 3; ++a)
            t[i][j] += values[a] * principal.axis[a][i] * principal.axis[a][j];
    return t;
  }

  void
  lie_tangent(const PrincipalStrains &principal,
              const PrincipalStress  &response,
              SymmetricTensor<4, 3>  &tangent)
  {
    auto axial = response.moduli;
    for (unsigned int a = 0; a < 3; ++a)
      axial[a][a] -= 2. * response.stress[a];

    // half of g_ab: the factor of a squared dyad n_a n_b + n_b n_a
    const auto turning = [&](const unsigned int a, const unsigned int b) {
      return 0.5 * (response.secant[a + b - 1] *
                      x_coth_x(principal.strain[a] - principal.strain[b]) -
                    (response.stress[a] + response.stress[b]));
    };
    const std::array<double, 3> shear = {
      {turning(0, 1), turning(0, 2), turning(1, 2)}};

    if (principal.planar)
      planar_tangent(principal, axial, shear, tangent);
    else
      spatial_tangent(principal, axial, shear, tangent);
  }
} // namespace impm::LogStrain
