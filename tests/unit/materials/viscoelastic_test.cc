#include <impm/materials/log_strain_viscoelastic.h>

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
  const Tensor<2, 3> one = unit_symmetric_tensor<3>();

  NamedLaw
  viscoelastic(const LogStrainViscoelastic::Parameters &parameters)
  {
    return make_law<LogStrainViscoelastic>("",
                                           GeometryKind::three_d,
                                           parameters);
  }

  NamedLaw
  hencky(const double shear, const double bulk)
  {
    return make_law<LogStrainElastic>(
      "", GeometryKind::three_d, ElasticConstants::from_moduli(shear, bulk));
  }

  const double G = 1., K = 3.;

  const auto long_run = ElasticConstants::from_moduli(G, K);

  void
  step(LawPoint &point, const Tensor<2, 3> &increment, const double dt)
  {
    point.dt = dt;
    ASSERT_TRUE(point.evaluate(increment));
    point.commit();
  }

  // 2 G_i dev eps at the stretches e^s, e^-s, 1 has s itself in it.
  Tensor<2, 3>
  sheared(const double s)
  {
    return diagonal(std::exp(s), std::exp(-s), 1.);
  }

  // (tau_11 - tau_22) / 4 s there
  double
  secant_modulus(const LawPoint &point, const double s)
  {
    const auto &tau = point.response.kirchhoff_stress;
    return (tau[0][0] - tau[1][1]) / (4 * s);
  }
} // namespace


// A strain all at once, then held: implicit Euler's powers, which tend to
// exponentials with order one.
TEST(Viscoelastic, StressRelaxesAtAFixedStrain)
{
  const double s = 0.7, G_1 = 2., G_2 = 0.5, T_1 = 0.4, T_2 = 5.;
  const auto   named = viscoelastic({long_run, {{G_1, T_1}, {G_2, T_2}}, 0.});
  std::vector<double> errors;
  for (const unsigned int n_steps : {20u, 40u, 80u})
    {
      const double dt = 1. / n_steps;
      LawPoint     point(named);
      step(point, sheared(s), 0.);
      EXPECT_NEAR(secant_modulus(point, s), G + G_1 + G_2, 1e-13);
      double largest = 0;
      for (unsigned int n = 1; n <= n_steps; ++n)
        {
          step(point, one, dt);
          const double found = secant_modulus(point, s);
          EXPECT_NEAR(found,
                      G + G_1 * std::pow(1 + dt / T_1, -1. * n) +
                        G_2 * std::pow(1 + dt / T_2, -1. * n),
                      1e-12);
          const double t = n * dt;
          largest        = std::max(largest,
                             std::abs(found - G - G_1 * std::exp(-t / T_1) -
                                      G_2 * std::exp(-t / T_2)));
        }
      errors.push_back(largest);
    }
  EXPECT_NEAR(errors[0] / errors[1], 2., 0.1);
  EXPECT_NEAR(errors[1] / errors[2], 2., 0.05);
}


TEST(Viscoelastic, SuddenAndSlowStrainsAreElastic)
{
  const double G_1 = 2., G_2 = 0.5, T = 1e-3;
  const auto   named = viscoelastic({long_run, {{G_1, T}, {G_2, T}}, 0.});
  EXPECT_DOUBLE_EQ(named.law->stiffness(),
                   ElasticConstants::from_moduli(G + G_1 + G_2, K).young);
  std::mt19937 generator(1);
  for (const auto &[dt, shear] :
       {std::pair<double, double>(1e-18 * T, G + G_1 + G_2), {1e18 * T, G}})
    for (unsigned int n = 0; n < 10; ++n)
      {
        const auto F     = random_gradient(generator, n % 2 == 0);
        const auto other = hencky(shear, K);
        LawPoint   point(named), elastic(other);
        step(point, F, dt);
        step(elastic, F, dt);
        EXPECT_LT((point.response.kirchhoff_stress -
                   elastic.response.kirchhoff_stress)
                    .norm(),
                  1e-13);
        EXPECT_LT((point.response.tangent - elastic.response.tangent).norm(),
                  1e-12);
        EXPECT_NEAR(point.response.potential,
                    elastic.response.potential,
                    1e-13);
      }
}


// Under a constant Kirchhoff stress Kelvin and Voigt's body creeps by implicit
// Euler's steps s_n = s (1 - (1 + G dt / eta)^-n).
TEST(Viscoelastic, ParallelDashpotCreeps)
{
  const double eta = 0.8, dt = 0.05, end = 0.6;
  const auto   named = viscoelastic({long_run, {}, eta});
  LawPoint     point(named);
  double       last = 0, work = 0;
  for (unsigned int n = 1; n <= 40; ++n)
    {
      const double s = end * (1 - std::pow(1 + G * dt / eta, -1. * n));
      step(point, sheared(s - last), dt);
      const auto &tau = point.response.kirchhoff_stress;
      EXPECT_NEAR(tau[0][0] - tau[1][1], 4 * G * end, 1e-12);
      EXPECT_NEAR(trace(tau), 0., 1e-12);
      // 2 eta |de|^2 / dt with |de|^2 = 2 (s - last)^2
      work += 4 * eta * (s - last) * (s - last) / dt;
      const auto energy = named.law->energy(point.F, point.history.data());
      EXPECT_NEAR(energy.dissipated, work, 1e-12);
      EXPECT_NEAR(energy.stored, 2 * G * s * s, 1e-12);
      last = s;
    }
}


// Where nothing is elastic in the long run, steady shear is that of a fluid:
// tau = 2 eta d with the viscosities G_i T_i and that of the other dashpot.
TEST(Viscoelastic, SteadyShearIsNewtonian)
{
  const double G_1 = 2., T_1 = 0.4, rate = 1e-3, dt = 0.1, eta = 0.3;
  const auto   named =
    viscoelastic({ElasticConstants::from_moduli(1e-15, K), {{G_1, T_1}}, eta});
  LawPoint point(named);
  for (unsigned int n = 0; n < 400; ++n)
    step(point, sheared(rate * dt), dt);
  EXPECT_NEAR(secant_modulus(point, rate), G_1 * T_1 + eta, 1e-10);
}


TEST(Viscoelastic, Objectivity)
{
  std::mt19937 generator(2);
  const auto   named = viscoelastic({long_run, {{2., 0.4}, {0.5, 5.}}, 0.2});
  for (const bool planar : {true, false})
    for (const auto &q : {in_plane, in_space})
      {
        LawPoint   point(named), spun(named);
        const auto first  = random_gradient(generator, planar),
                   second = random_gradient(generator, planar);

        // the second body turns by q during the first step
        step(point, first, 0.3);
        step(spun, q * first, 0.3);
        for (const double dt : {0.3, 0., 0.})
          {
            EXPECT_LT((spun.response.kirchhoff_stress -
                       turned(point.response.kirchhoff_stress, q))
                        .norm(),
                      1e-13);
            EXPECT_NEAR(spun.response.potential,
                        point.response.potential,
                        1e-13);
            const auto energy =
                         named.law->energy(point.F, point.history.data()),
                       other = named.law->energy(spun.F, spun.history.data());
            EXPECT_NEAR(other.stored, energy.stored, 1e-13);
            EXPECT_NEAR(other.dissipated, energy.dissipated, 1e-13);
            step(point, dt > 0 ? second : one, dt);
            step(spun, dt > 0 ? q * second * transpose(q) : one, dt);
          }

        // one that turns at once carries its stress along
        const auto before = point.response.kirchhoff_stress;
        step(point, some_other, 0.);
        EXPECT_LT(
          (point.response.kirchhoff_stress - turned(before, some_other)).norm(),
          1e-13);
      }
}


TEST(Viscoelastic, DissipationIsNeverNegative)
{
  std::mt19937 generator(3);
  const auto   named = viscoelastic({long_run, {{2., 0.4}, {0.5, 5.}}, 0.2});
  for (const double dt : {1e-6, 0.01, 1., 1e6})
    {
      LawPoint point(named);
      double   last = 0;
      for (unsigned int n = 0; n < 50; ++n)
        {
          step(point, random_gradient(generator, n % 2 == 0, 0.1), dt);
          const double now =
            named.law->energy(point.F, point.history.data()).dissipated;
          EXPECT_GE(now, last);
          last = now;
        }
    }
}


// The work of the stress is what is stored and dissipated, to first order in
// the step.
TEST(Viscoelastic, WorkIsStoredOrDissipated)
{
  const auto named = viscoelastic({long_run, {{2., 0.4}, {0.5, 5.}}, 0.2});
  std::vector<double> errors;
  for (const unsigned int n_steps : {100u, 200u, 400u})
    {
      const double dt = 1. / n_steps, rate = 0.3 * dt;
      const auto   increment =
        diagonal(std::exp(rate), std::exp(-0.4 * rate), std::exp(-0.5 * rate));
      LawPoint point(named);
      double   work = 0, last = 0;
      for (unsigned int n = 0; n < n_steps; ++n)
        {
          step(point, increment, dt);
          const auto  &tau   = point.response.kirchhoff_stress;
          const double power = tau[0][0] - 0.4 * tau[1][1] - 0.5 * tau[2][2];
          // the dashpot in parallel has its stress from the start
          work += (n == 0 ? power : 0.5 * (last + power)) * rate;
          last = power;
        }
      const auto energy = named.law->energy(point.F, point.history.data());
      EXPECT_GT(energy.dissipated, 0.);
      errors.push_back(
        std::abs((energy.stored + energy.dissipated) / work - 1));
    }
  EXPECT_LT(errors[2], 1e-2);
  EXPECT_NEAR(errors[0] / errors[1], 2., 0.1);
  EXPECT_NEAR(errors[1] / errors[2], 2., 0.1);
}


TEST(Viscoelastic, GeometriesAgree)
{
  std::mt19937                            generator(4);
  const LogStrainViscoelastic::Parameters parameters{long_run,
                                                     {{2., 0.4}, {0.5, 5.}},
                                                     0.2};
  const auto                              make = [&](const GeometryKind kind) {
    return make_law<LogStrainViscoelastic>("", kind, parameters);
  };
  const auto plane = make(GeometryKind::plane_strain),
             space = make(GeometryKind::three_d);
  LawPoint flat(plane), solid(space);
  for (unsigned int n = 0; n < 5; ++n)
    {
      auto increment  = random_gradient(generator, true, 0.1);
      increment[2][2] = 1.;
      step(flat, increment, 0.3);
      step(solid, increment, 0.3);
      EXPECT_EQ(flat.response.kirchhoff_stress,
                solid.response.kirchhoff_stress);
    }
}


TEST(Viscoelastic, WhatIsRefused)
{
  const std::string rubber = "Materials/rubber/",
                    moduli = "Branch shear moduli", times = "Relaxation times";
  const auto blame = [&](Overrides                       overrides,
                         const std::string              &entry,
                         const std::vector<std::string> &words) {
    for (auto &override : overrides)
      override = rubber + override;
    expect_blame(law_scene("plane strain", {"Law = log-strain viscoelastic"}),
                 overrides,
                 entry.empty() ? "" : rubber + entry,
                 words);
  };
  blame({moduli + "=1, 2", times + "=3"}, times, {"'3'", "2 numbers"});
  blame({moduli + "=1"}, times, {"1 numbers"});
  for (const std::string bad : {"0", "-1", "x"})
    {
      blame({moduli + "=1", times + "=" + bad}, "", {times, "'" + bad});
      blame({moduli + "=" + bad, times + "=1"}, "", {moduli, "'" + bad});
    }
  blame({"Viscosity=-1"}, "", {"Viscosity", "'-1'"});
}


TEST(ViscoelasticMpi, DrawnBlocks)
{
  const Lines entries = {"Law = log-strain viscoelastic",
                         "Young's modulus = 0.5",
                         "Branch shear moduli = 0.2, 0.1",
                         "Relaxation times = 0.3, 4",
                         "Viscosity = 0.05"};
  draw_block<2>("plane strain", entries);
  draw_block<2>("plane stress", entries);
  draw_block<2>("axisymmetric", entries);
  draw_block<3>("3D", entries);
}
