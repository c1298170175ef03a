#include <impm/materials/neo_hookean.h>
#include <impm/materials/ogden.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "expect_blame.h"
#include "law_scene.h"
#include "material_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // Ogden's terms for Treloar's rubber, in MPa (1972, see ogden.h).
  const std::vector<Ogden::Term> treloar = {{0.63, 1.3},
                                            {0.0012, 5.},
                                            {-0.01, -2.}};

  Material::Response
  respond(const Ogden::Parameters &parameters, const Tensor<2, 3> &F)
  {
    const Ogden        law({1.}, no_history, parameters);
    Material::Response response;
    EXPECT_TRUE(law.evaluate_one({F, F, 0., nullptr, nullptr}, true, response));
    // the same formula, but not the same rounding
    EXPECT_NEAR(law.energy(F, nullptr).stored,
                response.potential,
                1e-15 * (response.tangent.norm() + response.potential));
    return response;
  }

  // Of the tangent and of the stress from differences, relative.
  double
  derivative_error(const Ogden::Parameters &parameters,
                   const Tensor<2, 3>      &F,
                   const double             h)
  {
    const auto at = [&](const Tensor<2, 3> &disturbed) {
      return respond(parameters, disturbed);
    };
    const auto here = at(F);
    return std::max(tangent_error(at, F, h), potential_error(at, F, h)) /
           (here.tangent.norm() + here.kirchhoff_stress.norm());
  }

  double
  power_sum(const double lambda, const double first, const double second)
  {
    double sum = 0;
    for (const auto &[modulus, exponent] : treloar)
      sum += modulus * (std::pow(lambda, first * exponent) -
                        std::pow(lambda, second * exponent));
    return sum;
  }
} // namespace


TEST(Ogden, SquaresAreNeoHookean)
{
  const auto              constants = ElasticConstants::from_moduli(3., 11.);
  const NeoHookean<true>  neo_hookean({1.}, no_history, constants);
  const Ogden::Parameters squares{{{3., 2.}}, 11.};
  EXPECT_DOUBLE_EQ(squares.constants().shear, 3.);
  EXPECT_DOUBLE_EQ(Ogden({1.}, no_history, squares).stiffness(),
                   neo_hookean.stiffness());

  auto shear                    = diagonal(1., 1., 1.);
  shear[0][1]                   = 0.8;
  std::vector<Tensor<2, 3>> all = {shear, diagonal(4., 0.5, 0.5)};
  std::mt19937              generator(1);
  for (unsigned int n = 0; n < 20; ++n)
    all.push_back(random_gradient(generator, n % 2 == 0) *
                  random_gradient(generator, n % 2 == 0));
  for (const auto &F : all)
    {
      Material::Response expected;
      ASSERT_TRUE(
        neo_hookean.evaluate_one({F, F, 0., nullptr, nullptr}, true, expected));
      const auto   found = respond(squares, F);
      const double size  = expected.tangent.norm();
      EXPECT_LT((found.kirchhoff_stress - expected.kirchhoff_stress).norm(),
                1e-14 * size);
      EXPECT_NEAR(found.potential, expected.potential, 1e-14 * size);
      EXPECT_LT((found.tangent - expected.tangent).norm(), 1e-14 * size);
    }

  // in closed form, gamma = 0.8: dev b = (2 g^2, -g^2, -g^2) / 3 and shear g
  const auto tau = respond(squares, shear).kirchhoff_stress;
  EXPECT_NEAR(tau[0][0], 3. * 2. / 3. * 0.64, 1e-14);
  EXPECT_NEAR(tau[1][1], -3. / 3. * 0.64, 1e-14);
  EXPECT_NEAR(tau[0][1], 3. * 0.8, 1e-14);
}


TEST(Ogden, SquaresAndTheirInversesAreMooneyRivlin)
{
  const double C10 = 2., C01 = 0.7, bulk = 30.;
  const auto   parameters = MooneyRivlin::from_constants(C10, C01, bulk);
  EXPECT_DOUBLE_EQ(parameters.constants().shear, 2 * (C10 + C01));
  std::mt19937 generator(2);
  for (unsigned int n = 0; n < 20; ++n)
    {
      const auto                  F = random_gradient(generator, n % 2 == 0);
      const double                J = determinant(F);
      const SymmetricTensor<2, 3> b =
        std::pow(J, -2. / 3.) * symmetrize(F * transpose(F));
      const auto                  inverse = invert(b);
      const SymmetricTensor<2, 3> tau =
        2. * C10 * deviator(b) - 2. * C01 * deviator(inverse) +
        bulk * std::log(J) * unit_symmetric_tensor<3>();
      const auto found = respond(parameters, F);
      EXPECT_LT((found.kirchhoff_stress - tau).norm(), 1e-13);
      EXPECT_NEAR(found.potential,
                  C10 * (trace(b) - 3) + C01 * (trace(inverse) - 3) +
                    bulk / 2 * std::pow(std::log(J), 2),
                  1e-13);
    }
}


// What an incompressible sheet carries has the difference of two principal
// stresses, with the third one zero.
TEST(Ogden, TreloarsRubberInClosedForm)
{
  const Ogden::Parameters parameters{treloar, 1000.};
  EXPECT_NEAR(parameters.constants().shear, 0.4225, 1e-15);
  // turned axes keep 1e-16 of the largest b, which is 1e5 times the smallest
  const double round_off = 1e-10;
  for (const double lambda : {0.2, 0.7, 1. + 1e-6, 1.5, 3., 5., 7.6})
    for (const auto &q : {in_plane, in_space, some_other})
      {
        const auto differ = [&](const Tensor<2, 3> &F) {
          const auto tau =
            turned(respond(parameters, q * F).kirchhoff_stress, transpose(q));
          EXPECT_LT(std::abs(tau[0][1]) + std::abs(tau[0][2]),
                    round_off * (1 + tau.norm()));
          return tau[0][0] - tau[2][2];
        };
        const double side     = 1 / std::sqrt(lambda);
        const double uniaxial = power_sum(lambda, 1., -0.5),
                     biaxial  = power_sum(lambda, 1., -2.),
                     shear    = power_sum(lambda, 1., -1.);
        EXPECT_NEAR(differ(diagonal(lambda, side, side)),
                    uniaxial,
                    round_off * (1 + std::abs(uniaxial)));
        EXPECT_NEAR(differ(diagonal(lambda, lambda, std::pow(side, 4))),
                    biaxial,
                    round_off * (1 + std::abs(biaxial)));
        EXPECT_NEAR(differ(diagonal(lambda, 1., 1 / lambda)),
                    shear,
                    round_off * (1 + std::abs(shear)));
      }
}


TEST(Ogden, TangentsOfMeetingStretches)
{
  const Ogden::Parameters parameters{treloar, 2.};
  for (const double gap : {0., 1e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2})
    for (const double third : {0.9, 1.1, 1.2})
      for (const auto &q : {in_plane, in_space})
        for (const auto &stretch : {diagonal(1.2, 1.2 * (1. + gap), third),
                                    diagonal(third, 1.2, 1.2 * (1. + gap))})
          EXPECT_LT(derivative_error(parameters, q * stretch, 1e-3), 1e-12)
            << gap;
}


TEST(Ogden, TangentsOfRandomDeformations)
{
  std::mt19937 generator(3);
  for (const double bulk : {0.1, 2., 1000.})
    for (unsigned int n = 0; n < 20; ++n)
      {
        const auto F = random_gradient(generator, n % 2 == 0) *
                       random_gradient(generator, n % 2 == 0);
        EXPECT_LT(derivative_error({treloar, bulk}, F, 1e-3), 1e-11) << F;
      }
}


TEST(Ogden, TangentsOfLargeStretches)
{
  for (const auto &stretch : {diagonal(10., 0.1, 1.),
                              diagonal(0.1, 10., 0.1),
                              diagonal(10., 10., 0.1),
                              diagonal(10., 10., 10.),
                              diagonal(0.1, 0.1, 0.1)})
    for (const auto &q : {in_plane, in_space})
      EXPECT_LT(derivative_error({treloar, 2.}, q * stretch * some_other, 3e-3),
                1e-10)
        << stretch;
}


// Stretches from 1e-3 to 1e3 against the formula, with the axes of the grid,
// since tensors of other axes do not hold such numbers side by side.
TEST(Ogden, HugeStretchesInClosedForm)
{
  const double bulk = 2.;
  for (const double x : {1e-3, 1., 1e3})
    for (const double y : {1e-3, 1., 1e3})
      for (const double z : {1e-3, 1., 1e3})
        {
          const auto            F        = diagonal(x, y, z);
          const auto            response = respond({treloar, bulk}, F);
          const double          log_J    = std::log(x * y * z);
          std::array<double, 3> tau{}, stretch = {{x, y, z}};
          double size = 0, energy = bulk / 2 * log_J * log_J, largest = energy;
          for (const auto &[modulus, exponent] : treloar)
            {
              std::array<double, 3> power;
              for (unsigned int a = 0; a < 3; ++a)
                power[a] = std::pow(stretch[a] / std::exp(log_J / 3), exponent);
              const double sum = power[0] + power[1] + power[2];
              for (unsigned int a = 0; a < 3; ++a)
                tau[a] += modulus * (power[a] - sum / 3);
              size += std::abs(modulus) * sum;
              energy += modulus / exponent * (sum - 3);
              largest += modulus / exponent * (sum + 3);
            }
          for (unsigned int a = 0; a < 3; ++a)
            EXPECT_NEAR(response.kirchhoff_stress[a][a],
                        tau[a] + bulk * log_J,
                        1e-13 * (size + bulk * std::abs(log_J)))
              << F;
          EXPECT_NEAR(response.potential, energy, 1e-13 * largest) << F;
          // finite, and stiff in every direction that a strain can have
          EXPECT_TRUE(std::isfinite(response.tangent.norm())) << F;
        }
}


TEST(Ogden, SmallStrainsAreLinear)
{
  const Ogden::Parameters parameters{treloar, 0.5};
  const auto              constants = parameters.constants();
  const auto              unit      = unit_symmetric_tensor<3>();
  const auto              at_rest   = respond(parameters, diagonal(1., 1., 1.));
  const auto              c = constants.lame() * outer_product(unit, unit) +
                 2. * constants.shear * identity_tensor<3>();
  EXPECT_EQ(at_rest.kirchhoff_stress.norm(), 0.);
  EXPECT_EQ(at_rest.potential, 0.);
  EXPECT_LT((at_rest.tangent - c).norm(), 1e-15 * c.norm());
  std::mt19937 generator(4);
  for (const double size : {1e-4, 1e-6})
    {
      const auto                  F = random_gradient(generator, false, size);
      const SymmetricTensor<2, 3> strain = symmetrize(F) - unit;
      EXPECT_LT((respond(parameters, F).kirchhoff_stress - c * strain).norm(),
                10 * size * c.norm() * size + 1e-15);
    }
}


TEST(Ogden, Objectivity)
{
  const Ogden::Parameters parameters{treloar, 2.};
  std::mt19937            generator(5);
  for (const bool planar : {true, false})
    {
      const auto F     = random_gradient(generator, planar);
      const auto still = respond(parameters, F);
      for (const auto &q : {in_plane, in_space, some_other})
        {
          const auto after = respond(parameters, q * F);
          EXPECT_LT(
            (after.kirchhoff_stress - turned(still.kirchhoff_stress, q)).norm(),
            1e-14);
          EXPECT_NEAR(after.potential, still.potential, 1e-15);
          EXPECT_LT((respond(parameters, F * q).kirchhoff_stress -
                     still.kirchhoff_stress)
                      .norm(),
                    1e-14);
        }
    }
}


TEST(Ogden, WhatIsRefused)
{
  const std::string rubber = "Materials/rubber/";
  const auto        blame  = [&](const std::string              &law,
                         Overrides                       overrides,
                         const std::string              &entry,
                         const std::vector<std::string> &words) {
    for (auto &override : overrides)
      override = rubber + override;
    expect_blame(law_scene("plane strain", {"Law = " + law}),
                 overrides,
                 entry.empty() ? "" : rubber + entry,
                 words);
  };
  blame("Ogden",
        {"Ogden moduli=1, 2", "Ogden exponents=2"},
        "Ogden exponents",
        {"'2'", "2 numbers", "Ogden moduli"});
  for (const std::string exponents : {"2, -1", "2, 0"})
    blame("Ogden",
          {"Ogden moduli=1, 2", "Ogden exponents=" + exponents},
          "Ogden exponents",
          {exponents, "sign", "shear modulus"});
  blame("Ogden",
        {"Ogden moduli=", "Ogden exponents="},
        "Ogden moduli",
        {"nothing"});
  blame("Ogden", {"Ogden moduli=1, x"}, "", {"Ogden moduli", "'1, x'"});
  blame("Ogden", {"Bulk modulus=0"}, "", {"Bulk modulus", "'0'"});
  blame("Mooney-Rivlin", {"C10=0", "C01=0"}, "C10", {"shear"});
  blame("Mooney-Rivlin", {"C01=-1"}, "", {"C01", "'-1'"});
}


TEST(OgdenMpi, DrawnBlocks)
{
  const Lines ogden  = {"Law = Ogden",
                        "Ogden moduli = 0.63, 0.0012, -0.01",
                        "Ogden exponents = 1.3, 5, -2",
                        "Bulk modulus = 2"},
              mooney = {"Law = Mooney-Rivlin",
                        "C10 = 0.2",
                        "C01 = 0.05",
                        "Bulk modulus = 2"};
  for (const auto &entries : {ogden, mooney})
    {
      draw_block<2>("plane strain", entries);
      draw_block<2>("plane stress", entries);
      draw_block<2>("axisymmetric", entries);
      draw_block<3>("3D", entries);
    }
}


// A short block under a platen that does not slip, nearly incompressible: with
// F-bar as without the tangent is that of the residual, and with it the block
// is softer: without it locks.
TEST(OgdenMpi, MeanVolumeOfTreloarsRubber)
{
  const Lines rubber  = {"Law = Ogden",
                         "Ogden moduli = 0.63, 0.0012, -0.01",
                         "Ogden exponents = 1.3, 5, -2",
                         "Bulk modulus = 1000"};
  Overrides   pressed = {"Grid/Method=Lagrangian",
                         "Grid/Cells=4, 4",
                         "Boundary conditions/left/Type=slip",
                         "Boundary conditions/bottom/Type=fixed",
                         "Boundary conditions/top/Type=displacement",
                         "Boundary conditions/top/Value=0; -0.1*t"};
  for (const std::string kind : {"plane strain", "axisymmetric"})
    {
      SCOPED_TRACE(kind);
      std::vector<double> energies;
      for (const std::string f_bar : {"true", "false"})
        {
          Model<2>     model(law_scene(kind, rubber),
                         pressed +
                           Overrides{"Materials/rubber/F-bar=" + f_bar});
          impm::Vector u;
          const auto   result = model.solve(u);
          ASSERT_TRUE(result.converged) << result.failure;
          EXPECT_LT(result.iterations, 15u);
          auto &balance = model.balance();
          energies.push_back(balance.evaluate(u).potential);

          const auto   s       = model.random_direction(1);
          impm::Vector tangent = model.vector();
          balance.vmult(tangent, s);
          const auto residual_at = [&](const double h) {
            impm::Vector moved = u;
            moved.add(h, s);
            EXPECT_TRUE(balance.evaluate(moved, false).admissible);
            return balance.residual();
          };
          const double h          = 1e-4;
          impm::Vector difference = residual_at(h);
          difference -= residual_at(-h);
          difference *= 8.;
          difference -= residual_at(2 * h);
          difference += residual_at(-2 * h);
          difference *= 1. / (12 * h);
          difference -= tangent;
          EXPECT_LT(difference.linfty_norm(), 1e-7 * tangent.linfty_norm());
        }
      EXPECT_LT(energies[0], 0.99 * energies[1]);
    }
}
