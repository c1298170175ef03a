#include <impm/materials/failure.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "expect_blame.h"
#include "law_fixture.h"
#include "material_fixture.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const std::string plane = block_scene("plane strain");

  constexpr double share = 1e-4;

  FailureStrain
  limit(const double strain)
  {
    FailureStrain failure;
    failure.d1 = strain;
    return failure;
  }

  /** Uniaxial tension to a logarithmic strain, beyond yield, in one step. */
  Tensor<2, 3>
  drawn(const double alpha_before, const double alpha)
  {
    const double E = unit_elasticity.young, H = 0.1, sigma_y = 0.01;
    const auto   height = [&](const double a) {
      return a > 0 ? a + (sigma_y + H * a) / E : 0.;
    };
    const auto across = [&](const double a) {
      return a > 0 ? -0.5 * a - 0.3 * (sigma_y + H * a) / E : 0.;
    };
    const double along = std::exp(height(alpha) - height(alpha_before)),
                 side  = std::exp(across(alpha) - across(alpha_before));
    return diagonal(side, along, side);
  }

  const Entries linear = {{"Yield stress", "0.01"},
                          {"Hardening modulus", "0.1"}};

  double
  damage(const LawPoint &point)
  {
    return point.history[point.layout.offset("damage")];
  }
} // namespace


TEST(Failure, StrainByHand)
{
  // OFHC copper: 0.54 + 4.89 exp(-3.03 / 3) = 2.32099...
  FailureStrain copper;
  copper.d1                    = 0.54;
  copper.d2                    = 4.89;
  copper.d3                    = -3.03;
  copper.d4                    = 0.014;
  copper.d5                    = 1.12;
  copper.reference_temperature = 293;
  copper.melting_temperature   = 1356;
  const double cold            = 0.54 + 4.89 * std::exp(-1.01);
  EXPECT_NEAR(cold, 2.3210, 1e-4);
  EXPECT_NEAR(copper(1. / 3, 1., 293.), cold, 1e-14);
  EXPECT_NEAR(copper(1. / 3, 0., 0.), cold, 1e-14);
  EXPECT_NEAR(copper(1. / 3, 1e4, 293.),
              cold * (1 + 0.014 * std::log(1e4)),
              1e-14);
  EXPECT_NEAR(copper(1. / 3, 1., 293. + 1063. / 4), cold * 1.28, 1e-13);
  EXPECT_NEAR(copper(1. / 3, 1., 1e5), cold * 2.12, 1e-13);
  copper.d1 = -10; // more tension than the constants are made for
  EXPECT_EQ(copper(3., 1., 293.), FailureStrain::smallest);
}


TEST(Failure, LimitInUniaxialTension)
{
  const auto named = failing_law(linear, limit(0.1), share);
  LawPoint   point(named);
  double     alpha = 0;
  for (const double next : {0.04, 0.08, 0.12, 0.16, 0.2})
    {
      ASSERT_TRUE(point.evaluate(drawn(alpha, next)));
      const bool   failed = alpha > 0.1;
      const double stress = (0.01 + 0.1 * next) * (failed ? share : 1.);
      EXPECT_NEAR(point.response.kirchhoff_stress[1][1],
                  stress,
                  1e-14 * (failed ? share : 1.));
      EXPECT_NEAR(point.response.kirchhoff_stress[0][0], 0., 1e-14);
      point.commit();
      alpha = next;
      EXPECT_NEAR(point.plastic_strain(), alpha, 1e-14);
      EXPECT_NEAR(damage(point), std::min(10 * alpha, 1.), 1e-13);
      EXPECT_EQ(point.history[point.layout.offset("failed")], alpha > 0.1);
      EXPECT_EQ(point.law.remaining_stiffness(point.history.data()),
                alpha > 0.1 ? share : 1.);
    }
}


// D of a path is the integral of its parts: rate and triaxiality of each step.
TEST(Failure, DamageAddsUp)
{
  FailureStrain failure;
  failure.d1             = 0.1;
  failure.d2             = 0.5;
  failure.d3             = -1.5;
  failure.d4             = 0.02;
  failure.reference_rate = 1e-3;
  const auto named       = failing_law(linear, failure, share);
  LawPoint   point(named, 0.5);
  double     expected = 0, alpha = 0;
  for (const double next : {0.02, 0.05, 0.06})
    {
      ASSERT_TRUE(point.evaluate(drawn(alpha, next)));
      point.commit();
      expected += (next - alpha) / failure(1. / 3, (next - alpha) / 0.5, 0.);
      EXPECT_NEAR(damage(point), expected, 1e-13);
      alpha = next;
    }
}


// What is stored and dissipated does not jump where a point fails, and grows by
// the work of the stress that is left from then on.
TEST(Failure, EnergyIsKept)
{
  const auto     named = failing_law(linear, limit(0.1), share);
  const NamedLaw whole = listed_law("log-strain von Mises", linear);
  LawPoint       point(named), other(whole);
  double         alpha = 0, before = 0, before_of_whole = 0;
  for (const double next : {0.08, 0.11, 0.15, 0.3})
    {
      ASSERT_TRUE(point.evaluate(drawn(alpha, next)));
      ASSERT_TRUE(other.evaluate(drawn(alpha, next)));
      point.commit();
      other.commit();
      const auto   energy   = point.law.energy(point.F, point.history.data());
      const auto   of_whole = other.law.energy(other.F, other.history.data());
      const double sum      = energy.stored + energy.dissipated,
                   sum_of_whole = of_whole.stored + of_whole.dissipated;
      EXPECT_NEAR(sum - before,
                  (alpha > 0.1 ? share : 1.) * (sum_of_whole - before_of_whole),
                  1e-15);
      EXPECT_NEAR(energy.stored,
                  (next > 0.1 ? share : 1.) * of_whole.stored,
                  1e-15);
      before          = sum;
      before_of_whole = sum_of_whole;
      alpha           = next;
    }
}


TEST(Failure, CompressionDamagesLess)
{
  FailureStrain failure;
  failure.d1       = 0.05;
  failure.d2       = 0.5;
  failure.d3       = -3;
  const auto named = failing_law(linear, failure, share);
  LawPoint   drawn_point(named), pressed_point(named);
  ASSERT_TRUE(drawn_point.evaluate(drawn(0., 0.05)));
  auto pressed = drawn(0., 0.05);
  for (unsigned int d = 0; d < 3; ++d)
    pressed[d][d] = 1 / pressed[d][d];
  ASSERT_TRUE(pressed_point.evaluate(pressed));
  drawn_point.commit();
  pressed_point.commit();
  EXPECT_NEAR(drawn_point.plastic_strain(),
              pressed_point.plastic_strain(),
              1e-13);
  EXPECT_NEAR(damage(drawn_point) / damage(pressed_point),
              (0.05 + 0.5 * std::exp(1.)) / (0.05 + 0.5 * std::exp(-1.)),
              1e-10);
}


TEST(Failure, WhatIsRefused)
{
  const Overrides plastic = {"Materials/rubber/Law=log-strain von Mises"};
  EXPECT_NO_THROW(scene_from<2>(
    plane, plastic + Overrides{"Materials/rubber/Failure=plastic strain"}));
  expect_blame(plane,
               {"Materials/rubber/Failure=plastic strain"},
               "Materials/rubber/Failure",
               {"'plastic strain'", "yields", "log-strain elastic"});
  const Overrides cook =
    plastic + Overrides{"Materials/rubber/Failure=Johnson-Cook",
                        "Materials/rubber/Specific heat=500"};
  EXPECT_NO_THROW(scene_from<2>(plane, cook));
  expect_blame(plane,
               cook + Overrides{"Materials/rubber/Melting temperature=100"},
               "Materials/rubber/Melting temperature",
               {"'100'", "Reference temperature"});
  expect_blame(plane,
               cook + Overrides{"Materials/rubber/Failure constants=1, 2"},
               "Materials/rubber/Failure constants",
               {"'1, 2'", "5"});
  for (const std::string constants :
       {"-1, 0, 0, 0, 0", "1, 2, 1e5, 0, 0", "1, -3, 0, 0, 0"})
    expect_blame(plane,
                 cook +
                   Overrides{"Materials/rubber/Failure constants=" + constants},
                 "Materials/rubber/Failure constants",
                 {"D1 + D2 exp(D3 / 3)"});
  // of the other kind, which only warns
  EXPECT_NO_THROW(
    scene_from<2>(plane,
                  cook + Overrides{"Materials/rubber/Failure strain=1"}));
}
