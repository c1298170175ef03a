#ifndef impm_tests_unit_material_fixture_h
#define impm_tests_unit_material_fixture_h

#include <impm/materials/material.h>

#include <algorithm>
#include <cmath>
#include <random>

// Deformations, and comparisons of a law with its own differences.
namespace impm
{
  /** Of laws that keep none. */
  inline PointLayout no_history(GeometryKind::three_d);

  inline dealii::Tensor<2, 3>
  diagonal(const double x, const double y, const double z)
  {
    dealii::Tensor<2, 3> t;
    t[0][0] = x;
    t[1][1] = y;
    t[2][2] = z;
    return t;
  }

  inline dealii::Tensor<2, 3>
  rotation_z(const double angle)
  {
    auto q  = diagonal(std::cos(angle), std::cos(angle), 1.);
    q[1][0] = std::sin(angle);
    q[0][1] = -std::sin(angle);
    return q;
  }

  inline dealii::Tensor<2, 3>
  rotation_x(const double angle)
  {
    auto q  = diagonal(1., std::cos(angle), std::cos(angle));
    q[2][1] = std::sin(angle);
    q[1][2] = -std::sin(angle);
    return q;
  }

  inline const dealii::Tensor<2, 3> in_plane = rotation_z(0.7);
  inline const dealii::Tensor<2, 3> in_space =
    rotation_z(0.7) * rotation_x(-1.1);
  inline const dealii::Tensor<2, 3> some_other =
    rotation_x(0.4) * rotation_z(2.1);

  inline dealii::Tensor<2, 3>
  random_gradient(std::mt19937 &generator,
                  const bool    planar,
                  const double  size = 0.25)
  {
    std::uniform_real_distribution<double> uniform(-size, size);
    dealii::Tensor<2, 3>                   F = diagonal(1., 1., 1.);
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        if (!planar || i == j || i + j == 1)
          F[i][j] += uniform(generator);
    return F;
  }

  inline dealii::SymmetricTensor<2, 3>
  turned(const dealii::SymmetricTensor<2, 3> &t, const dealii::Tensor<2, 3> &q)
  {
    return dealii::symmetrize(q * dealii::Tensor<2, 3>(t) *
                              dealii::transpose(q));
  }

  /** Central difference of sixth order at 0. */
  template <typename Function>
  auto
  derivative(const Function &f, const double h)
  {
    return (45. * (f(h) - f(-h)) - 9. * (f(2 * h) - f(-2 * h)) +
            (f(3 * h) - f(-3 * h))) /
           (60. * h);
  }

  /** (1 + h e_k x e_l) F */
  inline dealii::Tensor<2, 3>
  disturbed(const dealii::Tensor<2, 3> &F,
            const unsigned int          k,
            const unsigned int          l,
            const double                h)
  {
    auto gradient = diagonal(1., 1., 1.);
    gradient[k][l] += h;
    return gradient * F;
  }

  /**
   * Largest deviation of the tangent from differences of the stress, in all
   * directions (so that those out of the plane are compared as well).
   * `respond` gives the response to a deformation.
   */
  template <typename Respond>
  double
  tangent_error(const Respond              &respond,
                const dealii::Tensor<2, 3> &F,
                const double                h)
  {
    const Material::Response response = respond(F);
    const auto              &c        = response.tangent;
    const auto              &tau      = response.kirchhoff_stress;
    const auto               delta    = dealii::unit_symmetric_tensor<3>();
    double                   error    = 0;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int l = 0; l < 3; ++l)
        {
          const dealii::SymmetricTensor<2, 3> difference = derivative(
            [&](const double x) {
              return respond(disturbed(F, k, l, x)).kirchhoff_stress;
            },
            h);
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              error = std::max(error,
                               std::abs(difference[i][j] - c[i][j][k][l] -
                                        delta[i][k] * tau[j][l] -
                                        tau[i][l] * delta[j][k]));
        }
    return error;
  }

  /** Largest deviation of the stress from differences of the potential. */
  template <typename Respond>
  double
  potential_error(const Respond              &respond,
                  const dealii::Tensor<2, 3> &F,
                  const double                h)
  {
    const dealii::SymmetricTensor<2, 3> tau   = respond(F).kirchhoff_stress;
    double                              error = 0;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int l = 0; l < 3; ++l)
        error =
          std::max(error,
                   std::abs(tau[k][l] -
                            derivative(
                              [&](const double x) {
                                return respond(disturbed(F, k, l, x)).potential;
                              },
                              h)));
    return error;
  }
} // namespace impm

#endif
