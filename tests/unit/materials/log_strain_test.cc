#include <deal.II/base/parameter_handler.h>

#include <impm/materials/list.h>
#include <impm/materials/log_strain.h>
#include <impm/materials/log_strain_elastic.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "material_fixture.h"

namespace
{
  using namespace dealii;
  using namespace impm;

  const auto elasticity = ElasticConstants::from_young(1., 0.3);

  const LogStrainElastic law({1000.}, no_history, elasticity);

  Material::Response
  respond(const Tensor<2, 3> &total)
  {
    Material::Response response;
    EXPECT_TRUE(
      law.evaluate_one({total, total, 0., nullptr, nullptr}, true, response));
    return response;
  }

  bool
  is_refused(const Tensor<2, 3> &total)
  {
    Material::Response response;
    return !law.evaluate_one({total, total, 0., nullptr, nullptr},
                             true,
                             response);
  }
} // namespace


TEST(LogStrain, TangentOfRandomDeformations)
{
  std::mt19937 generator(1);
  for (unsigned int n = 0; n < 20; ++n)
    for (const bool planar : {true, false})
      {
        const auto F = random_gradient(generator, planar);
        EXPECT_LT(tangent_error(respond, F, 3e-3), 1e-12) << F;
        EXPECT_LT(potential_error(respond, F, 3e-3), 1e-12) << F;
      }
}


TEST(LogStrain, TangentOfLargeStretches)
{
  for (const auto &stretch : {diagonal(10., 0.1, 1.),
                              diagonal(0.1, 10., 0.1),
                              diagonal(10., 10., 0.1),
                              diagonal(10., 10., 10.),
                              diagonal(0.1, 0.1, 0.1)})
    for (const auto &q : {in_plane, in_space})
      {
        const auto F = q * stretch * some_other;
        EXPECT_LT(tangent_error(respond, F, 1e-4), 1e-7) << F;
        EXPECT_LT(potential_error(respond, F, 1e-4), 1e-7) << F;
      }
}


TEST(LogStrain, TangentOfEqualAndNearlyEqualStretches)
{
  for (const double gap : {0., 1e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2})
    for (const double third : {1., 1.2, 1.2 * (1. + 3. * gap)})
      for (const auto &q : {in_plane, in_space})
        {
          const auto F =
            q * diagonal(1.2, 1.2 * (1. + gap), third) * transpose(in_plane);
          EXPECT_LT(tangent_error(respond, F, 3e-3), 1e-12)
            << gap << ' ' << third;
        }
}


// No digit may be lost between equal and distinct stretches.
TEST(LogStrain, ShearModulusOfTheAxesAgainstExtendedPrecision)
{
  for (const double volume : {1., 1.3})
    for (double gap = 1.; gap > 1e-17; gap *= 0.31)
      {
        const double a = volume, b = volume + gap;
        const auto   F = diagonal(a, b, 1.);

        const long double x = std::log(static_cast<long double>(b)) -
                              std::log(static_cast<long double>(a));
        const auto tau      = respond(F).kirchhoff_stress;
        const auto expected = static_cast<double>(
          elasticity.shear * (x == 0.L ? 1.L : x / std::tanh(x)) -
          0.5L * (tau[0][0] + tau[1][1]));

        const auto c = respond(F).tangent;
        EXPECT_NEAR(c[0][1][0][1], expected, 1e-15) << gap;

        // The same axes in other directions: through the formulas of the
        // plane, and through the spatial ones.
        for (const auto &q : {in_plane, in_space})
          {
            const auto turned = respond(q * F).tangent;
            double     sum    = 0.;
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                for (unsigned int k = 0; k < 3; ++k)
                  for (unsigned int l = 0; l < 3; ++l)
                    sum += q[i][0] * q[j][1] * q[k][0] * q[l][1] *
                           turned[i][j][k][l];
            EXPECT_NEAR(sum, expected, 1e-14) << gap;
          }
      }
}


TEST(LogStrain, TangentWithoutDeformationIsTheElasticityTensor)
{
  const auto response = respond(unit_symmetric_tensor<3>());
  EXPECT_EQ(response.kirchhoff_stress.norm(), 0.);
  EXPECT_EQ(response.potential, 0.);

  const auto expected =
    elasticity.bulk *
      outer_product(unit_symmetric_tensor<3>(), unit_symmetric_tensor<3>()) +
    2. * elasticity.shear * deviator_tensor<3>();
  EXPECT_LT((response.tangent - expected).norm(), 1e-15);
}


TEST(LogStrain, Objectivity)
{
  std::mt19937 generator(2);
  for (const bool planar : {true, false})
    {
      const auto F   = random_gradient(generator, planar);
      const auto tau = respond(F).kirchhoff_stress;
      for (const auto &q : {in_plane, in_space, some_other})
        {
          EXPECT_LT((respond(q * F).kirchhoff_stress - turned(tau, q)).norm(),
                    1e-14);
          EXPECT_LT((respond(F * q).kirchhoff_stress - tau).norm(), 1e-14);
        }
    }
}


// Lateral strain -nu ln(lambda) leaves tau = E ln(lambda) along the axis.
TEST(LogStrain, UniaxialTension)
{
  for (const double stretch : {0.1, 0.9, 1.5, 10.})
    {
      const double lateral  = std::pow(stretch, -0.3);
      const auto   response = respond(diagonal(lateral, stretch, lateral));
      EXPECT_NEAR(response.kirchhoff_stress[1][1], std::log(stretch), 3e-15);
      EXPECT_NEAR(response.kirchhoff_stress[0][0], 0., 3e-15);
      EXPECT_NEAR(response.kirchhoff_stress[2][2], 0., 3e-15);

      const double energy = 0.5 * std::pow(std::log(stretch), 2);
      EXPECT_NEAR(response.potential, energy, 1e-14);
      EXPECT_NEAR(
        law.energy(diagonal(lateral, stretch, lateral), nullptr).stored,
        energy,
        1e-14);
    }
}


TEST(LogStrain, RefusesWhatHasNoStress)
{
  EXPECT_TRUE(is_refused(diagonal(-1., 1., 1.)));
  EXPECT_TRUE(is_refused(diagonal(0., 1., 1.)));
  EXPECT_TRUE(is_refused(Tensor<2, 3>()));
  EXPECT_TRUE(is_refused(diagonal(1e200, 1e-200, 1.)));

  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        {
          Tensor<2, 3> F = unit_symmetric_tensor<3>();
          F[i][j]        = bad;
          EXPECT_TRUE(is_refused(F)) << i << j << bad;
        }
}


TEST(LogStrain, DecompositionRebuildsTheTensor)
{
  for (const double shear :
       {0., 1e-320, 2e-162, 1e-100, 1e-31, 1e-16, 1e-8, 0.4})
    for (const double sign : {-1., 1.})
      for (const double difference :
           {-0.3, -1e-16, 0., 1e-17, 2e-162, 1e-9, 0.5})
        for (const double out_of_plane : {0., 1e-300, 1e-17, 0.2})
          {
            SymmetricTensor<2, 3> b;
            b[0][0] = 1.;
            b[1][1] = 1. + difference;
            b[2][2] = 1.1;
            b[0][1] = sign * shear;
            b[0][2] = out_of_plane;
            b[1][2] = -0.5 * out_of_plane;

            LogStrain::PrincipalStrains<double> principal;
            ASSERT_TRUE(LogStrain::decompose(b, principal)) << b;

            std::array<double, 3> squares;
            for (unsigned int a = 0; a < 3; ++a)
              squares[a] = std::exp(2. * principal.strain[a]);
            EXPECT_LT((LogStrain::compose(squares, principal) - b).norm(),
                      3e-15)
              << b;
            for (unsigned int a = 0; a < 3; ++a)
              for (unsigned int c = 0; c < 3; ++c)
                EXPECT_NEAR(principal.axis[a] * principal.axis[c],
                            a == c ? 1. : 0.,
                            1e-15)
                  << b;
          }
}


TEST(LogStrain, EntriesOfTheElasticLaw)
{
  const auto &list = material_list();
  const auto  entry =
    std::find_if(list.begin(), list.end(), [](const MaterialEntry &e) {
      return e.name == "log-strain elastic";
    });
  ASSERT_NE(entry, list.end());

  ParameterHandler prm;
  entry->declare(prm, chosen_in(prm));
  for (const std::string bad : {"0.5", "-1", "0.7", "nan"})
    EXPECT_THROW(prm.set("Poisson's ratio", bad),
                 ParameterHandler::ExcValueDoesNotMatchPattern)
      << bad;
  for (const std::string name : {"Young's modulus", "Density"})
    for (const std::string bad : {"0", "-1"})
      EXPECT_THROW(prm.set(name, bad),
                   ParameterHandler::ExcValueDoesNotMatchPattern)
        << name;

  prm.set("Young's modulus", "20");
  prm.set("Poisson's ratio", "0.25");
  prm.set("Density", "6");
  PointLayout layout(GeometryKind::three_d);
  const auto  material = entry->create(prm, {6.}, layout);
  EXPECT_EQ(material->stiffness(), 20.);
  EXPECT_EQ(material->density, 6.);
  EXPECT_TRUE(material->has_potential());
  EXPECT_NEAR(material->wave_speed(), 2., 1e-15); // K + 4/3 G = 24
  EXPECT_EQ(layout.size(), 0u);
}
