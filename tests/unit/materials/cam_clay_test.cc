#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "law_fixture.h"
#include "material_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const Tensor<2, 3> one = unit_symmetric_tensor<3>();

  const double P_0 = 1., kappa = 0.02, lambda = 0.1, mu = 40., M = 1.2;

  NamedLaw
  clay(const double preconsolidation)
  {
    return make_law<CamClay>(
      "clay",
      GeometryKind::three_d,
      CamClay::Parameters{P_0, preconsolidation, kappa, lambda, mu, M});
  }

  double
  limit(const LawPoint &point)
  {
    return point.history[point.layout.offset("preconsolidation_pressure")];
  }

  double
  pressure(const LawPoint &point)
  {
    return -trace(point.response.kirchhoff_stress) / 3;
  }

  double
  q(const LawPoint &point)
  {
    return std::sqrt(1.5) * deviator(point.response.kirchhoff_stress).norm();
  }

  void
  step(LawPoint &point, const Tensor<2, 3> &increment)
  {
    ASSERT_TRUE(point.evaluate(increment));
    point.commit();
  }

  Tensor<2, 3>
  stretched(const double x, const double y, const double z)
  {
    return diagonal(std::exp(x), std::exp(y), std::exp(z));
  }

  // Of a committed point, whether it is on or within the limit.
  void
  expect_within(const LawPoint &point, const bool on_it)
  {
    const double P = pressure(point), P_c = limit(point);
    const double f = std::pow(q(point) / M, 2) + P * (P - P_c);
    EXPECT_LT(f, 1e-13 * P_c * std::max(P, P_c));
    if (on_it)
      {
        EXPECT_GT(f, -1e-13 * P_c * std::max(P, P_c));
      }
  }
} // namespace


TEST(CamClay, EntriesThatContradict)
{
  for (const auto &[entry, value] :
       std::vector<std::pair<std::string, std::string>>{
         {"Compression index", "0.01"}, {"Preconsolidation pressure", "0.9e5"}})
    try
      {
        ParameterHandler prm;
        CamClay::Parameters::declare_parameters(prm, {});
        prm.set(entry, value);
        CamClay::Parameters::from_parameters(prm);
        ADD_FAILURE() << entry;
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, entry);
      }
}


// Below the limit the stress derives from the stored energy.
TEST(CamClay, HyperelasticBelowTheLimit)
{
  std::mt19937 generator(4);
  const auto   named   = clay(1e4);
  const auto   respond = [&](const Tensor<2, 3> &F) {
    LawPoint point(named);
    EXPECT_TRUE(point.evaluate(F));
    EXPECT_EQ(point.trial_history[point.layout.offset("plastic_work")], 0.);
    point.response.potential =
      named.law->energy(F, point.trial_history.data()).stored;
    return point.response;
  };
  for (unsigned int n = 0; n < 10; ++n)
    {
      const auto F = random_gradient(generator, false, 0.02);
      EXPECT_LT(potential_error(respond, F, 1e-4),
                1e-8 * respond(F).kirchhoff_stress.norm());
    }
}


TEST(CamClay, StartsUnderItsPressure)
{
  const auto named = clay(2.);
  LawPoint   point(named);
  ASSERT_TRUE(point.evaluate(one));
  EXPECT_LT(
    (point.response.kirchhoff_stress + P_0 * unit_symmetric_tensor<3>()).norm(),
    1e-15);
}


// Pressed from all sides, let go and pressed again, in many steps or in one:
// the volume by the logarithm of the pressure, with kappa and lambda.
TEST(CamClay, IsotropicCompression)
{
  const double P_c = 2.;
  for (const unsigned int n_steps : {1u, 7u})
    {
      const auto named = clay(P_c);
      LawPoint   point(named);
      double     volume = 0;
      const auto press  = [&](const double strain) {
        for (unsigned int n = 0; n < n_steps; ++n)
          step(point,
               stretched(strain / 3 / n_steps,
                         strain / 3 / n_steps,
                         strain / 3 / n_steps));
        volume += strain;
        EXPECT_LT(q(point), 1e-14);
        return pressure(point);
      };
      EXPECT_NEAR(press(-0.01), P_0 * std::exp(0.01 / kappa), 1e-13);
      const double at_limit = -kappa * std::log(P_c / P_0);
      const double P        = press(-0.2);
      EXPECT_NEAR(P, P_c * std::exp(-(volume - at_limit) / lambda), 1e-10 * P);
      EXPECT_NEAR(limit(point), P, 1e-13 * P);
      EXPECT_NEAR(press(0.05), P * std::exp(-0.05 / kappa), 1e-12 * P);
      EXPECT_NEAR(limit(point), P, 1e-13 * P);
      const double again = press(-0.1);
      EXPECT_NEAR(again, P * std::exp(0.05 / lambda), 1e-10 * again);
    }
}


// Drained triaxial compression ends at the critical state, from both sides,
// where the volume stands still.
TEST(CamClay, DrainedShearEndsCritical)
{
  for (const double P_c : {1., 5.})
    {
      const auto   named = clay(P_c);
      LawPoint     point(named);
      const double lateral = P_0;
      double       before = 0, peak = 0, slowest = 0;
      for (unsigned int n = 0; n < 400; ++n)
        {
          double across = 0;
          for (unsigned int i = 0; i < 60; ++i)
            {
              ASSERT_TRUE(point.evaluate(stretched(across, -0.005, across)));
              const auto  &c   = point.response.tangent;
              const auto  &tau = point.response.kirchhoff_stress;
              const double slope =
                c[0][0][0][0] + c[0][0][2][2] + 2 * tau[0][0];
              const double change = (tau[0][0] + lateral) / slope;
              across -= change;
              if (std::abs(change) < 1e-15)
                break;
            }
          point.commit();
          slowest = 2 * across - 0.005;
          peak    = std::max(peak, q(point) / pressure(point));
          expect_within(point, n > 20);
          before = q(point);
        }
      EXPECT_NEAR(q(point), M * pressure(point), 1e-6);
      EXPECT_NEAR(before, 3 * M / (3 - M) * lateral, 1e-5);
      EXPECT_LT(std::abs(slowest), 1e-7);
      if (P_c == 1.)
        {
          EXPECT_LT(peak, M);
        }
      else
        {
          EXPECT_GT(peak, M * 1.1); // heavily overconsolidated: it peaks
        }
    }
}


// Undrained shear of normally consolidated clay: P = P_0 (1 + (eta / M)^2)
// to the power of minus (lambda - kappa) / lambda, A. N. Schofield and C. P.
// Wroth's path, which no step leaves.
TEST(CamClay, UndrainedPath)
{
  for (const unsigned int n_steps : {5u, 100u})
    {
      const auto named = clay(P_0);
      LawPoint   point(named);
      for (unsigned int n = 0; n < n_steps; ++n)
        {
          const double e = 0.1 / n_steps;
          step(point, stretched(e / 2, -e, e / 2));
          const double eta = q(point) / pressure(point);
          EXPECT_NEAR(pressure(point),
                      P_0 * std::pow(1 + eta * eta / (M * M),
                                     -(lambda - kappa) / lambda),
                      1e-12);
          expect_within(point, true);
        }
      EXPECT_NEAR(q(point) / pressure(point), M, 1e-2);
    }
}


// In turned frames, from lightly and heavily consolidated states, far out and
// close to the limit.
TEST(CamClay, TangentsAreDerivatives)
{
  std::mt19937 generator(1);
  for (const double P_c : {1., 1.5, 8.})
    for (const double size : {0.2, 0.05, 1e-2})
      for (unsigned int n = 0; n < 10; ++n)
        {
          const auto named = clay(P_c);
          LawPoint   point(named);
          const auto respond = [&](const Tensor<2, 3> &increment) {
            EXPECT_TRUE(point.evaluate(increment));
            return point.response;
          };
          const auto F = random_gradient(generator, false, size);
          respond(F);
          const double scale = point.response.tangent.norm();
          const double kink  = std::abs(
            point
              .trial_history[point.layout.offset("equivalent_plastic_strain")]);
          if (kink < 1e-3)
            continue;
          EXPECT_LT(tangent_error(respond, F, 1e-5 * std::min(1., size * 10)),
                    1e-7 * scale)
            << P_c << " " << size;
        }
}


// The asymmetry of the tangent is of the order of the step, as its flow is
// associated.
TEST(CamClay, SmallStepsHaveSymmetricTangents)
{
  std::vector<double> asymmetry;
  for (const double size : {1e-2, 1e-3, 1e-4})
    {
      const auto named = clay(1.);
      LawPoint   point(named);
      step(point, stretched(0.01, -0.04, 0.002));
      step(point, stretched(0.5 * size, -size, 0.2 * size));
      const auto &c = point.response.tangent;
      asymmetry.push_back(std::abs(c[0][0][1][1] - c[1][1][0][0]));
      EXPECT_GT(c[0][0][0][0], 0.);
    }
  EXPECT_NEAR(asymmetry[0] / asymmetry[1], 10., 5.);
  EXPECT_NEAR(asymmetry[1] / asymmetry[2], 10., 2.);
}


// Large steps either have a stress within the limit or none at all, and
// dissipate.
TEST(CamClay, LargeSteps)
{
  std::mt19937 generator(2);
  unsigned int n_fine = 0, n_all = 0;
  for (const double P_c : {1., 20.})
    {
      const auto named = clay(P_c);
      for (unsigned int n = 0; n < 200; ++n)
        {
          LawPoint point(named);
          for (unsigned int i = 0; i < 5; ++i)
            {
              const auto increment =
                random_gradient(generator, false, n % 2 ? 0.3 : 0.1);
              if (determinant(increment) <= 0)
                continue;
              ++n_all;
              const auto   offset = point.layout.offset("plastic_work");
              const double before = point.history[offset];
              if (!point.evaluate(increment))
                continue;
              ++n_fine;
              point.commit();
              expect_within(point, false);
              EXPECT_GE(point.history[offset], before);
            }
        }
    }
  EXPECT_EQ(n_fine, n_all);
}


TEST(CamClay, StressTurnsWithTheMaterial)
{
  std::mt19937 generator(3);
  const auto   named = clay(1.5);
  for (const auto &q : {in_plane, in_space, some_other})
    {
      LawPoint here(named), there(named);
      for (unsigned int n = 0; n < 6; ++n)
        {
          const auto increment = random_gradient(generator, false, 0.05);
          step(here, increment);
          step(there, n == 0 ? q * increment : q * increment * transpose(q));
          EXPECT_LT((there.response.kirchhoff_stress -
                     turned(here.response.kirchhoff_stress, q))
                      .norm(),
                    1e-12 * here.response.kirchhoff_stress.norm());
        }
    }
}
