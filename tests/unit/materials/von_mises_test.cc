#include <deal.II/base/parameter_handler.h>

#include <impm/materials/hardening/curve_hardening.h>
#include <impm/materials/hardening/voce.h>
#include <impm/materials/list.h>
#include <impm/materials/log_strain_von_mises.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "material_fixture.h"

namespace
{
  using namespace dealii;
  using namespace impm;

  const double young   = 1.;
  const double poisson = 0.3;
  const double sigma_y = 0.02;

  const auto elasticity = ElasticConstants::from_young(young, poisson);

  const Tensor<2, 3> unit = unit_symmetric_tensor<3>();

  // The law with the history of one point.
  struct PointState
  {
    explicit PointState(const double       hardening,
                        const GeometryKind geometry = GeometryKind::three_d)
      : PointState(VoceHardening{{sigma_y, hardening}}, geometry)
    {}

    explicit PointState(const VoceHardening &hardening,
                        const GeometryKind   geometry = GeometryKind::three_d)
      : layout(geometry)
      , law({1000.}, layout, elasticity, hardening)
      , history(layout.size())
    {
      law.initialize_history(history.data());
      trial_history = history;
    }

    bool
    evaluate(const Tensor<2, 3> &increment, const bool with_tangent = true)
    {
      return law.evaluate_one({increment,
                               increment * total,
                               0.,
                               history.data(),
                               trial_history.data()},
                              with_tangent,
                              response);
    }

    const Material::Response &
    respond(const Tensor<2, 3> &increment)
    {
      EXPECT_TRUE(evaluate(increment));
      return response;
    }

    const Material::Response &
    advance(const Tensor<2, 3> &increment)
    {
      respond(increment);
      history = trial_history;
      total   = increment * total;
      return response;
    }

    SymmetricTensor<2, 3>
    elastic(const std::vector<double> &values) const
    {
      return layout.load_symmetric(values.data() +
                                   layout.offset("elastic_left_cauchy_green"));
    }

    double
    alpha(const std::vector<double> &values) const
    {
      return values[layout.offset("equivalent_plastic_strain")];
    }

    PointLayout                                      layout;
    LogStrainVonMises<CurveHardening<VoceHardening>> law;
    Tensor<2, 3>        total = unit_symmetric_tensor<3>();
    std::vector<double> history, trial_history;
    Material::Response  response;
  };

  double
  von_mises(const SymmetricTensor<2, 3> &tau)
  {
    return std::sqrt(1.5) * deviator(tau).norm();
  }

  // Of the tangent and of the stress, from differences.
  double
  derivative_error(PointState         &point,
                   const Tensor<2, 3> &increment,
                   const double        h)
  {
    const auto respond = [&](const Tensor<2, 3> &dF) {
      return point.respond(dF);
    };
    return std::max(tangent_error(respond, increment, h),
                    potential_error(respond, increment, h));
  }
} // namespace


TEST(VonMises, TangentOfElasticSteps)
{
  std::mt19937 generator(1);
  for (const bool planar : {true, false})
    for (unsigned int n = 0; n < 10; ++n)
      {
        PointState point(0.1);
        const auto increment = random_gradient(generator, planar, 4e-3);
        point.respond(increment);
        ASSERT_EQ(point.alpha(point.trial_history), 0.);
        EXPECT_LT(derivative_error(point, increment, 5e-4), 3e-12);
      }
}


TEST(VonMises, TangentOfPlasticSteps)
{
  std::mt19937 generator(2);
  for (const double hardening : {0., 0.1, 10.})
    for (const bool planar : {true, false})
      for (unsigned int n = 0; n < 20; ++n)
        {
          // behind another plastic step, so that the history matters
          PointState point(hardening);
          point.advance(random_gradient(generator, planar, 0.25));
          const auto increment = random_gradient(generator, planar, 0.25);
          point.respond(increment);
          if (point.alpha(point.trial_history) <
              point.alpha(point.history) + 0.02)
            continue; // too near to the kink for differences
          EXPECT_LT(derivative_error(point, increment, 5e-4), 1e-11)
            << hardening << planar << increment;
        }
}


// Hardening that saturates within a step, too.
TEST(VonMises, TangentAndStressWhereHardeningSaturates)
{
  std::mt19937 generator(2);
  for (const double rate : {1., 20., 1000.})
    for (const bool planar : {true, false})
      for (unsigned int n = 0; n < 20; ++n)
        {
          const VoceHardening hardening{{sigma_y, 0.01}, 0.03, rate};
          PointState          point(hardening);
          point.advance(random_gradient(generator, planar, 0.25));
          const auto increment = random_gradient(generator, planar, 0.25);
          point.respond(increment);
          const double alpha = point.alpha(point.trial_history);
          if (alpha < point.alpha(point.history) + 0.02)
            continue; // too near to the kink for differences
          EXPECT_NEAR(von_mises(point.response.kirchhoff_stress),
                      hardening.yield_stress(alpha),
                      1e-13);
          EXPECT_LT(derivative_error(point, increment, 5e-4), 1e-10)
            << rate << planar << increment;
        }
}


TEST(VonMises, TangentOfEqualAndNearlyEqualStretches)
{
  for (const double gap : {0., 1e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2})
    for (const double third : {0.9, 1.1})
      for (const auto &q : {in_plane, in_space})
        {
          PointState point(0.1);
          const auto increment = q * diagonal(1.2, 1.2 * (1. + gap), third);
          point.respond(increment);
          ASSERT_GT(point.alpha(point.trial_history), 0.);
          EXPECT_LT(derivative_error(point, increment, 1e-3), 1e-11) << gap;

          // equal strains along other axes
          const auto other = q * diagonal(third, 1.2, 1.2 * (1. + gap));
          EXPECT_LT(derivative_error(point, other, 1e-3), 1e-11) << gap;
        }
}


TEST(VonMises, TangentOfLargeStretches)
{
  for (const double hardening : {0., 0.1})
    for (const auto &stretch : {diagonal(10., 0.1, 1.),
                                diagonal(0.1, 10., 0.1),
                                diagonal(10., 10., 0.1)})
      for (const auto &q : {in_plane, in_space})
        {
          PointState point(hardening);
          const auto increment = q * stretch * transpose(in_plane);
          EXPECT_LT(derivative_error(point, increment, 1e-4), 1e-7)
            << increment;
        }
}


TEST(VonMises, TangentHasMajorSymmetry)
{
  std::mt19937 generator(3);
  for (const bool planar : {true, false})
    {
      PointState point(0.1);
      point.advance(random_gradient(generator, planar, 0.25));
      const auto c =
        point.respond(random_gradient(generator, planar, 0.25)).tangent;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          for (unsigned int k = 0; k < 3; ++k)
            for (unsigned int l = 0; l < 3; ++l)
              EXPECT_NEAR(c[i][j][k][l], c[k][l][i][j], 1e-15);
    }
}


TEST(VonMises, StressEndsOnTheYieldLimitAndFlowKeepsTheVolume)
{
  std::mt19937 generator(4);
  for (const double hardening : {0., 0.1, 10.})
    for (const bool planar : {true, false})
      {
        PointState point(hardening);
        double     volume = 1.;
        for (unsigned int step = 0; step < 20; ++step)
          {
            const auto   increment = random_gradient(generator, planar, 0.2);
            const double before    = point.alpha(point.history);
            point.advance(increment);
            volume *= determinant(increment);

            const double alpha = point.alpha(point.history);
            EXPECT_GE(alpha, before);
            const double limit = sigma_y + hardening * alpha;
            if (alpha > before)
              {
                EXPECT_NEAR(von_mises(point.response.kirchhoff_stress),
                            limit,
                            1e-14 * (1. + hardening));
              }
            EXPECT_NEAR(determinant(point.elastic(point.history)) /
                          (volume * volume),
                        1.,
                        1e-13);
          }
      }
}


// Uniaxial tension without stress across, axial logarithmic strain e:
// E (e - alpha) = sigma_y + H alpha, lateral strain -nu (e - alpha) - alpha
// / 2.
TEST(VonMises, UniaxialTension)
{
  for (const double hardening : {0., 0.1})
    for (const double e : {0.01, 0.0199, 0.0201, 0.3, 1.5})
      for (const double sign : {1., -1.})
        {
          const double alpha =
            std::max(0., (young * e - sigma_y) / (young + hardening));
          const double axial = std::exp(sign * e);
          const double lateral =
            std::exp(-sign * (poisson * (e - alpha) + alpha / 2.));

          PointState  point(hardening);
          const auto &response =
            point.advance(diagonal(lateral, axial, lateral));
          const auto &tau = response.kirchhoff_stress;
          EXPECT_NEAR(tau[1][1], sign * young * (e - alpha), 3e-15);
          EXPECT_NEAR(tau[0][0], 0., 3e-15);
          EXPECT_NEAR(tau[2][2], 0., 3e-15);
          EXPECT_NEAR(point.alpha(point.history), alpha, 3e-15);

          const auto energy =
            point.law.energy(point.total, point.history.data());
          EXPECT_NEAR(energy.stored,
                      0.5 * young * std::pow(e - alpha, 2),
                      3e-15);
          EXPECT_NEAR(energy.dissipated,
                      sigma_y * alpha + 0.5 * hardening * alpha * alpha,
                      3e-15);
          EXPECT_NEAR(response.potential,
                      energy.stored + energy.dissipated,
                      3e-15);
        }
}


// Along a proportional path the steps add up to one: the work of the stress is
// what is stored and dissipated.
TEST(VonMises, WorkIsStoredOrDissipated)
{
  const unsigned int n_steps = 400;
  const double       rate    = 0.2 / n_steps;
  const auto         increment =
    diagonal(std::exp(rate), std::exp(-0.4 * rate), std::exp(-0.6 * rate));

  PointState point(0.1);
  double     work = 0., last = 0.;
  for (unsigned int step = 0; step < n_steps; ++step)
    {
      const auto  &tau   = point.advance(increment).kirchhoff_stress;
      const double power = tau[0][0] - 0.4 * tau[1][1] - 0.6 * tau[2][2];
      work += 0.5 * (last + power) * rate;
      last = power;
    }
  const auto energy = point.law.energy(point.total, point.history.data());
  EXPECT_GT(energy.dissipated, 0.);
  EXPECT_NEAR((energy.stored + energy.dissipated) / work, 1., 1e-4);
}


TEST(VonMises, Objectivity)
{
  std::mt19937 generator(5);
  for (const bool planar : {true, false})
    for (const auto &q : {in_plane, in_space})
      {
        PointState point(0.1), spun(0.1);
        const auto first  = random_gradient(generator, planar, 0.25);
        const auto second = random_gradient(generator, planar, 0.25);

        // the second body turns by q during the first step
        point.advance(first);
        spun.advance(q * first);
        for (unsigned int step = 0; step < 2; ++step)
          {
            EXPECT_LT((spun.response.kirchhoff_stress -
                       turned(point.response.kirchhoff_stress, q))
                        .norm(),
                      1e-14);
            EXPECT_LT((spun.elastic(spun.history) -
                       turned(point.elastic(point.history), q))
                        .norm(),
                      1e-14);
            EXPECT_NEAR(spun.alpha(spun.history),
                        point.alpha(point.history),
                        1e-14);
            point.advance(second);
            spun.advance(q * second * transpose(q));
          }
        EXPECT_GT(point.alpha(point.history), 0.);
      }
}


TEST(VonMises, NoDeformationKeepsThePointState)
{
  for (const auto &q : {unit, in_plane, in_space})
    {
      PointState point(0.1);
      point.advance(q * diagonal(1.002, 0.999, 1.001));
      ASSERT_EQ(point.alpha(point.history), 0.);
      point.trial_history.assign(point.history.size(), -1.);
      point.respond(unit);
      EXPECT_EQ(point.trial_history, point.history);
    }
}


TEST(VonMises, NothingFlowsAgainWithoutDeformation)
{
  std::mt19937 generator(6);
  for (const double hardening : {0., 0.1})
    for (const bool planar : {true, false})
      for (unsigned int n = 0; n < 20; ++n)
        {
          PointState point(hardening);
          const auto before =
            point.advance(random_gradient(generator, planar, 0.3));
          const auto &after = point.respond(unit);
          EXPECT_LT((after.kirchhoff_stress - before.kirchhoff_stress).norm(),
                    1e-14);
          EXPECT_NEAR(after.potential, before.potential, 1e-15);
          EXPECT_NEAR(point.alpha(point.trial_history),
                      point.alpha(point.history),
                      1e-15);
          EXPECT_LT((point.elastic(point.trial_history) -
                     point.elastic(point.history))
                      .norm(),
                    1e-14);
        }
}


TEST(VonMises, GeometriesAgree)
{
  std::mt19937 generator(7);
  PointState   plane(0.1, GeometryKind::plane_strain);
  PointState   axisymmetric(0.1, GeometryKind::axisymmetric);
  PointState   space(0.1, GeometryKind::three_d);
  PointState   upright(0.1, GeometryKind::three_d); // goes the spatial way
  EXPECT_EQ(plane.history.size(), 5u);
  EXPECT_EQ(axisymmetric.history.size(), 5u);
  EXPECT_EQ(space.history.size(), 7u);

  for (unsigned int step = 0; step < 10; ++step)
    {
      Tensor<2, 3> increment = random_gradient(generator, true, 0.1);
      increment[2][2]        = 1.;
      const auto tau         = plane.advance(increment).kirchhoff_stress;
      EXPECT_EQ(axisymmetric.advance(increment).kirchhoff_stress, tau);
      EXPECT_EQ(space.advance(increment).kirchhoff_stress, tau);

      const auto q = rotation_x(0.9);
      upright.advance(q * increment * transpose(q));
      EXPECT_LT((upright.response.kirchhoff_stress - turned(tau, q)).norm(),
                1e-14);
    }
  EXPECT_GT(plane.alpha(plane.history), 0.1);
}


TEST(VonMises, RefusesWhatHasNoStress)
{
  PointState point(0.1);
  point.advance(diagonal(1.2, 1., 0.9));
  EXPECT_FALSE(point.evaluate(diagonal(-1., 1., 1.)));
  EXPECT_FALSE(point.evaluate(diagonal(0., 1., 1.)));
  EXPECT_FALSE(point.evaluate(diagonal(1e200, 1e-200, 1.)));

  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          {
            Tensor<2, 3> increment = unit;
            increment[i][j]        = bad;
            EXPECT_FALSE(point.evaluate(increment)) << i << j << bad;
          }
      for (double &value : point.history)
        {
          const double good = value;
          value             = bad;
          EXPECT_FALSE(point.evaluate(diagonal(1.1, 1., 1.)));
          value = good;
        }
    }

  // two mirror images: the total is fine, the increment is not
  point.total = diagonal(-1., 1., 1.);
  EXPECT_FALSE(point.evaluate(diagonal(-1., 1., 1.)));
  EXPECT_FALSE(point.evaluate(unit));
}


TEST(VonMises, Entries)
{
  const auto &list = material_list();
  const auto  entry =
    std::find_if(list.begin(), list.end(), [](const MaterialEntry &e) {
      return e.name == "log-strain von Mises";
    });
  ASSERT_NE(entry, list.end());

  ParameterHandler prm;
  entry->declare(prm, chosen_in(prm));
  for (const std::string bad : {"0", "-1"})
    EXPECT_THROW(prm.set("Yield stress", bad),
                 ParameterHandler::ExcValueDoesNotMatchPattern);
  EXPECT_THROW(prm.set("Hardening modulus", "-1"),
               ParameterHandler::ExcValueDoesNotMatchPattern);

  prm.set("Young's modulus", "20");
  prm.set("Poisson's ratio", "0.25");
  prm.set("Density", "6");
  prm.set("Yield stress", "2");
  prm.set("Hardening modulus", "3");
  PointLayout layout(GeometryKind::plane_strain);
  layout.add("something else", PointLayout::Kind::vector);
  const auto material = entry->create(prm, {6.}, layout);
  EXPECT_EQ(material->stiffness(), 20.);
  EXPECT_EQ(material->density, 6.);
  EXPECT_TRUE(material->has_potential());
  EXPECT_NEAR(material->wave_speed(), 2., 1e-15); // K + 4/3 G = 24

  std::vector<double> history(layout.size());
  material->initialize_history(history.data());
  history[layout.offset("equivalent_plastic_strain")] = 0.5;
  EXPECT_EQ(material->energy(unit, history.data()).stored, 0.);
  EXPECT_EQ(material->energy(unit, history.data()).dissipated,
            2. * 0.5 + 3. * 0.125);
}
