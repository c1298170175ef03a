#include <deal.II/base/quadrature_lib.h>

#include <impm/materials/hardening/find_flow.h>
#include <impm/materials/hardening/list.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "expect_blame.h"
#include "law_fixture.h"
#include "material_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const double relief = 3 * unit_elasticity.shear;

  // Curves of all kinds, gentle and extreme ones, with a name.
  template <typename Action>
  void
  for_each_curve(const Action &action)
  {
    action("perfectly plastic", LinearHardening{0.01, 0.});
    action("linear", LinearHardening{0.01, 0.1});
    action("steep", LinearHardening{0.01, 1e6});
    action("softening", BilinearHardening({0.01, 0.1}, 0.05, 0.2));
    action("collapse", BilinearHardening({0.01, 0.1}, 1e-6, 0.999 * relief));
    action("Voce", VoceHardening{{0.01, 0.01}, 0.02, 5.});
    action("Voce at once", VoceHardening{{0.01, 0.}, 0.02, 1e8});
    action("Swift", SwiftHardening{0.01, 0.01, 0.3});
    action("Swift at once", SwiftHardening{0.01, 1e-12, 0.05});
    action("Ludwik", LudwikHardening{0.01, 0.03, 0.4});
    action("Ludwik, line", LudwikHardening{0.01, 0.03, 1.});
    action("Ludwik, 0.05", LudwikHardening{0.01, 0.03, 0.05});
    action("Ludwik, 0.01", LudwikHardening{0.01, 10., 0.01});
    action("Ludwik, nothing", LudwikHardening{0.01, 0., 0.5});
    action("table",
           TableHardening({{0., 0.01}, {0.05, 0.03}, {0.3, 0.01}, {0.5, 0.}}));
    action("stairs",
           TableHardening({{0., 0.01},
                           {1e-9, 0.02},
                           {0.1, 0.02},
                           {0.1 + 1e-12, 0.13},
                           {0.2, 0.13},
                           {0.3, 0.13 - 0.0999 * relief},
                           {0.4, 5.}}));
  }

  // As laws see one: the limit of a step that starts at a plastic strain.
  template <typename Curve>
  typename CurveHardening<Curve>::template Limit<double>
  limit_of(const Curve &curve, const double before)
  {
    return {curve, before};
  }

  JohnsonCookHardening::Limit<double>
  limit_of(const JohnsonCookHardening::Parameters &parameters,
           const double                            before,
           const double                            dt,
           const double                            softened = 1.)
  {
    return {parameters, before, 0., softened, parameters.reference_rate * dt};
  }

  // Nothing but signs, until two numbers have none between them.
  template <typename Limit>
  double
  bisect(const double trial, const Limit &limit)
  {
    double lower = 0, upper = trial / relief;
    while (true)
      {
        const double middle = lower + 0.5 * (upper - lower);
        if (!(middle > lower && middle < upper))
          return middle;
        (trial - relief * middle > limit.yield_stress(middle) ? lower : upper) =
          middle;
      }
  }

  // Overshoots of all magnitudes against the bisection; the same in lanes.
  template <typename Limit, typename LimitOfLanes>
  void
  check_flow(const Limit &limit, const LimitOfLanes &limit_of_lanes)
  {
    const double start = limit.yield_stress(0.);
    for (double overshoot = 1e-12; overshoot < 2e6; overshoot *= 10)
      {
        SCOPED_TRACE(overshoot);
        const double trial = start * (1 + overshoot) + 1e-300;
        if (!(trial > start))
          continue;
        const auto check = [&](const double flow, const double of_trial) {
          ASSERT_GE(flow, 0.);
          const double end = limit.yield_stress(flow);
          // and what the numbers tell of alpha
          const double allowed =
            1e-14 * end + 1e-15 * of_trial +
            2.3e-16 * (limit.before + flow) * std::abs(limit.slope(flow));
          if (flow > 1e-300)
            {
              EXPECT_LE(std::abs(of_trial - relief * flow - end), allowed);
              // which is more of the flow where the limit falls almost as fast
              EXPECT_NEAR(flow,
                          bisect(of_trial, limit),
                          2000 * allowed / relief);
            }
          else
            EXPECT_LE(bisect(of_trial, limit), 1e-300);
        };
        check(find_flow(trial, limit, relief), trial);

        Lanes trials      = trial;
        trials[0]         = start * 0.5;
        trials[1]         = start * (1 + 2 * overshoot);
        const Lanes flows = find_flow(trials, limit_of_lanes, relief);
        EXPECT_EQ(flows[0], 0.);
        check(flows[1], trials[1]);
        check(flows[n_lanes - 1], trial);
      }
  }
} // namespace


TEST(Hardening, SlopeAndWorkBelongToTheYieldStress)
{
  for_each_curve([](const std::string &name, const auto &curve) {
    // off the kinks
    for (const double alpha : {7e-4, 0.033, 0.17, 0.45, 2.})
      {
        SCOPED_TRACE(name + ", " + std::to_string(alpha));
        const double h      = 0.01 * alpha;
        const auto   stress = [&](const double x) {
          return curve.yield_stress(alpha + x);
        };
        const auto work = [&](const double x) { return curve.work(alpha + x); };
        const double size = curve.yield_stress(alpha) + curve.work(alpha) / h;
        EXPECT_NEAR(curve.slope(alpha), derivative(stress, h), 1e-9 * size / h);
        EXPECT_NEAR(curve.yield_stress(alpha),
                    derivative(work, h),
                    1e-11 * size);
      }
    EXPECT_EQ(curve.work(0.), 0.) << name;
    EXPECT_EQ(curve.yield_stress(0.), 0.01) << name;
  });
}


TEST(Hardening, CurvesByHand)
{
  EXPECT_NEAR(VoceHardening({{2., 3.}, 4., 5.}).yield_stress(0.2),
              2. + 3. * 0.2 + 4. * (1 - std::exp(-1.)),
              1e-15);
  EXPECT_NEAR(SwiftHardening({2., 0.1, 0.5}).yield_stress(0.3), 4., 1e-15);
  EXPECT_NEAR(LudwikHardening({2., 3., 0.5}).yield_stress(0.25), 3.5, 1e-15);
  const BilinearHardening bilinear({2., 1.}, 1., 3.);
  EXPECT_EQ(bilinear.yield_stress(1.5), 1.5);
  EXPECT_EQ(bilinear.yield_stress(9.), 0.);
  EXPECT_EQ(bilinear.work(9.), 4.); // 2.5 and 1.5
  const TableHardening table({{0., 1.}, {1., 3.}, {3., 2.}});
  EXPECT_EQ(table.yield_stress(0.5), 2.);
  EXPECT_EQ(table.yield_stress(2.), 2.5);
  EXPECT_EQ(table.yield_stress(4.), 2.);
  EXPECT_EQ(table.work(4.), 2. + 5. + 2.);
  EXPECT_EQ(table.least_slope(), -0.5);
}


TEST(FindFlow, OvershootsOfAllMagnitudes)
{
  for_each_curve([](const std::string &name, const auto &curve) {
    using Curve = std::decay_t<decltype(curve)>;
    for (const double before : {0., 1e-300, 1e-9, 1e-3, 0.1, 10.})
      {
        SCOPED_TRACE(name + ", " + std::to_string(before));
        const typename CurveHardening<Curve>::template Limit<Lanes> lanes = {
          curve, before};
        check_flow(limit_of(curve, before), lanes);
      }
  });
}


TEST(FindFlow, RatesOfAllMagnitudes)
{
  for (const double C : {0., 0.015, 1.})
    for (const double n : {0.05, 0.26, 1.})
      {
        const JohnsonCookHardening::Parameters parameters{{0.01, 0.02, n},
                                                          C,
                                                          1.};
        for (const double before : {0., 1e-6, 0.2})
          for (double dt = 1e-12; dt < 1e7; dt *= 100)
            for (const double softened : {1., 1e-6})
              {
                SCOPED_TRACE(std::to_string(C) + ", " + std::to_string(n) +
                             ", " + std::to_string(before) + ", " +
                             std::to_string(dt));
                const JohnsonCookHardening::Limit<Lanes> lanes(
                  parameters, before, 0., softened, dt);
                check_flow(limit_of(parameters, before, dt, softened), lanes);
              }
      }
}


TEST(FindFlow, KnowsWhereThereIsNone)
{
  const LinearHardening curve{0.01, 0.1};
  EXPECT_EQ(find_flow(0.005, limit_of(curve, 0.), relief), 0.);
  EXPECT_EQ(find_flow(0.01, limit_of(curve, 0.), relief), 0.);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    EXPECT_TRUE(std::isnan(find_flow(bad, limit_of(curve, 0.), relief)));
  EXPECT_TRUE(std::isnan(find_flow(0.02, limit_of(curve, NAN), relief)));
  // molten: all of the stress goes
  const JohnsonCookHardening::Parameters molten{{0.01, 0.02, 0.3}, 0.1, 1.};
  EXPECT_NEAR(find_flow(0.5, limit_of(molten, 0.1, 1e-3, 0.), relief) * relief,
              0.5,
              1e-15);
}


// Against a fine rule in the logarithm of the flow.
TEST(JohnsonCook, WorkIsTheIntegralOfTheLimit)
{
  const QGauss<1> rule(16);
  for (const double n : {0.05, 0.26, 1.})
    for (const double before : {0., 1e-8, 1e-4, 0.01, 1.})
      for (const double fast : {1.5, 100., 1e6, 1e10})
        for (const double flow : {1e-6, 1e-3, 0.5})
          {
            const JohnsonCookHardening::Parameters parameters{{1., 2., n},
                                                              0.1,
                                                              1.};
            const double                           slow = flow / fast;
            const auto limit    = limit_of(parameters, before, slow);
            double     integral = parameters.curve.work(before + slow) -
                              parameters.curve.work(before);
            const unsigned int n_parts = 200;
            const double       part    = std::log(fast) / n_parts;
            for (unsigned int i = 0; i < n_parts; ++i)
              for (unsigned int q = 0; q < rule.size(); ++q)
                {
                  const double x =
                    slow * std::exp(part * (i + rule.point(q)[0]));
                  integral += rule.weight(q) * part * x * limit.yield_stress(x);
                }
            // what the past has more of than the step is lost to round-off
            EXPECT_NEAR(limit.work(flow),
                        integral,
                        1e-10 * integral +
                          1e-15 * parameters.curve.work(before))
              << n << ", " << before << ", " << fast << ", " << flow;
          }
}


namespace
{
  using Stress = std::function<double(double)>;

  // all_hardenings() once more, but for the one that is no curve, written as
  // they stand in doc/materials.md.
  Stress
  stress_of(const std::string &hardening)
  {
    if (hardening == "linear")
      return [](double a) { return 0.01 + 0.1 * a; };
    if (hardening == "bilinear")
      return [](double a) {
        return a < 0.01 ? 0.01 + 0.1 * a :
                          std::max(0., 0.011 - 0.2 * (a - 0.01));
      };
    if (hardening == "Voce")
      return [](double a) {
        return 0.01 + 0.1 * a + (0.03 - 0.01) * (1 - std::exp(-5 * a));
      };
    if (hardening == "Swift")
      return [](double a) { return 0.01 * std::pow(1 + a / 0.05, 0.3); };
    if (hardening == "Ludwik")
      return [](double a) { return 0.01 + 0.03 * std::pow(a, 0.4); };
    if (hardening == "table")
      return [](double a) {
        return a < 0.004 ? 0.01 + 1.25 * a :
               a < 0.3   ? 0.015 + 0.005 / 0.296 * (a - 0.004) :
               a < 0.5   ? 0.02 - 0.05 * (a - 0.3) :
                           0.01;
      };
    ADD_FAILURE() << hardening;
    return {};
  }

  // dF of a step with these principal strains, as a law measures them.
  Tensor<2, 3>
  step_of(const NamedLaw &named, const double axial, const double side)
  {
    const auto stretch = [&](const double e) {
      switch (named.law->form())
        {
          case Material::Form::spatial:
            return std::exp(e);
          case Material::Form::full:
            return 1 + e / (1 - e / 2);
          default:
            return 1 + e;
        }
    };
    return diagonal(stretch(side), stretch(axial), stretch(side));
  }

  // The stress that is the limit of the hardening.
  SymmetricTensor<2, 3>
  stress_of(const LawPoint &point)
  {
    return point.law.form() == Material::Form::spatial ?
             point.response.kirchhoff_stress :
             point.cauchy_stress();
  }
} // namespace


// At the axial strain e = s / E + alpha the stress is s = limit(alpha), the
// sides contract by nu s / E + alpha / 2.
TEST(Hardening, UniaxialStressInClosedForm)
{
  for (const auto &law : laws_that_yield)
    for (const auto &entries : all_hardenings())
      if (entries.at("Hardening") != "Johnson-Cook")
        {
          const auto named  = listed_law(law, entries);
          const auto stress = stress_of(entries.at("Hardening"));
          for (const double sign : {1., -1.})
            for (const double alpha : {1e-12, 1e-6, 1e-3, 0.02, 0.31, 0.49})
              for (const unsigned int n : {1u, 5u})
                {
                  SCOPED_TRACE(named.name + ", " +
                               std::to_string(sign * alpha));
                  LawPoint point(named);
                  double   axial = 0, side = 0;
                  for (unsigned int i = 1; i <= n; ++i)
                    {
                      const double a = alpha * i / n, s = stress(a);
                      const double axial_now = s + a,
                                   side_now  = -0.3 * s - a / 2;
                      ASSERT_TRUE(
                        point.evaluate(step_of(named,
                                               sign * (axial_now - axial),
                                               sign * (side_now - side))));
                      point.commit();
                      axial = axial_now;
                      side  = side_now;
                    }
                  auto expected  = SymmetricTensor<2, 3>();
                  expected[1][1] = sign * stress(alpha);
                  EXPECT_LT((stress_of(point) - expected).norm(), 1e-13);
                  EXPECT_NEAR(point.plastic_strain(), alpha, 1e-13);
                }
        }
}


// Two steps of known flow: rate and temperature of each, by hand.
TEST(JohnsonCook, UniaxialStressInClosedForm)
{
  const double A = 0.01, B = 0.03, n = 0.4, C = 0.1, rate_0 = 0.001, m = 0.8;
  for (const auto &law : laws_that_yield)
    for (const double dt : {1e-6, 0.5, 1e6})
      for (const double flow : {0.02, 0.5})
        {
          SCOPED_TRACE(law + ", " + std::to_string(dt));
          const auto named =
            listed_law(law, all_hardenings()[5], GeometryKind::three_d, warm);
          LawPoint point(named, dt);
          double   axial = 0, side = 0, work = 0;
          for (const unsigned int step : {0, 1})
            {
              const double T      = 1 + 0.9 * work;
              const double share  = std::min(1., (T - 0.9) / (1.5 - 0.9));
              const auto   stress = [&](const double x) {
                return (A + B * std::pow(step * flow + x, n)) *
                       (1 + C * std::log(std::max(1., x / dt / rate_0))) *
                       (1 - std::pow(share, m));
              };
              const double s = stress(flow), a = (step + 1) * flow;
              const double axial_now = s + a, side_now = -0.3 * s - a / 2;
              ASSERT_TRUE(point.evaluate(
                step_of(named, axial_now - axial, side_now - side)));
              point.commit();
              axial          = axial_now;
              side           = side_now;
              auto expected  = SymmetricTensor<2, 3>();
              expected[1][1] = s;
              EXPECT_LT((stress_of(point) - expected).norm(), 1e-13) << step;
              EXPECT_NEAR(point.plastic_strain(), a, 1e-13) << step;
              // of the curve, at the rate of the step
              const QGauss<1>    rule(16);
              const unsigned int n_parts = 100;
              double             done    = 0;
              for (unsigned int i = 0; i < n_parts; ++i)
                for (unsigned int q = 0; q < rule.size(); ++q)
                  {
                    // fine at the start, where the slope may be infinite
                    const double u = (i + rule.point(q)[0]) / n_parts;
                    const double v = u * u * u * u;
                    done += rule.weight(q) / n_parts * 4 * v / u * flow *
                            (A + B * std::pow(step * flow + v * flow, n));
                  }
              work += done * stress(flow) / (A + B * std::pow(a, n));
              EXPECT_NEAR(
                named.law->energy(point.F, point.history.data()).dissipated,
                work,
                1e-9 * work)
                << step;
            }
        }
}


TEST(JohnsonCook, MeltsAndIsElasticWithoutTime)
{
  auto hot                = warm;
  hot.initial_temperature = 1.5;
  for (const auto &law : laws_that_yield)
    {
      SCOPED_TRACE(law);
      const auto molten =
        listed_law(law, all_hardenings()[5], GeometryKind::three_d, hot);
      LawPoint point(molten);
      ASSERT_TRUE(point.evaluate(diagonal(1.1, 1., 0.95)));
      EXPECT_LT(deviator(point.response.kirchhoff_stress).norm(), 1e-15);
      const auto cold =
        listed_law(law, all_hardenings()[5], GeometryKind::three_d, warm);
      LawPoint still(cold, 0.);
      ASSERT_TRUE(still.evaluate(diagonal(1.1, 1., 0.95)));
      still.commit();
      EXPECT_EQ(still.plastic_strain(), 0.);
      EXPECT_GT(deviator(still.response.kirchhoff_stress).norm(), 0.03);
    }
}


TEST(Hardening, RateCountsForJohnsonCookAlone)
{
  const auto increment = diagonal(1.1, 0.97, 0.95);
  for (const auto &law : laws_that_yield)
    for (const auto &entries : all_hardenings())
      {
        const bool by_rate = entries.at("Hardening") == "Johnson-Cook";
        const auto named =
          listed_law(law, entries, GeometryKind::three_d, warm);
        SCOPED_TRACE(named.name);
        LawPoint fast(named, 1e-9), slow(named, 1e3), slower(named, 1e6);
        for (auto *point : {&fast, &slow, &slower})
          ASSERT_TRUE(point->evaluate(increment));
        EXPECT_EQ(slow.response.kirchhoff_stress,
                  slower.response.kirchhoff_stress);
        if (by_rate)
          {
            EXPECT_GT(deviator(fast.response.kirchhoff_stress).norm(),
                      2 * deviator(slow.response.kirchhoff_stress).norm());
          }
        else
          EXPECT_EQ(fast.response.kirchhoff_stress,
                    slow.response.kirchhoff_stress);
      }
}


TEST(Hardening, FrameDoesNotCount)
{
  std::mt19937 generator(1);
  for (const auto &law : laws_that_yield)
    for (const auto &entries : all_hardenings())
      for (const auto &q : {in_plane, in_space})
        {
          const auto named =
            listed_law(law, entries, GeometryKind::three_d, warm);
          SCOPED_TRACE(named.name);
          LawPoint point(named), other(named);
          for (unsigned int i = 0; i < 3; ++i)
            {
              const auto increment = random_gradient(generator, false, 0.1);
              ASSERT_TRUE(point.evaluate(increment));
              // Logarithmic strains stand a turn in a step, too.
              const bool turns =
                i == 0 && named.law->form() == Material::Form::spatial;
              ASSERT_TRUE(other.evaluate(turns ? q * increment :
                                                 q * increment * transpose(q)));
              EXPECT_LT((other.response.kirchhoff_stress -
                         turned(point.response.kirchhoff_stress, q))
                          .norm(),
                        1e-14);
              point.commit();
              other.commit();
              EXPECT_NEAR(other.plastic_strain(),
                          point.plastic_strain(),
                          1e-14);
            }
          EXPECT_GT(point.plastic_strain(), 0.01);
        }
}


TEST(Hardening, WhatIsRefused)
{
  const std::string rubber = "Materials/rubber/";
  const auto        blame  = [&](const std::string              &law,
                         const Overrides                &overrides,
                         const std::string              &entry,
                         const std::vector<std::string> &words) {
    Overrides all = {rubber + "Law=" + law};
    for (const auto &override : overrides)
      all.push_back(rubber + override);
    expect_blame(block_scene("plane strain"),
                 all,
                 entry.empty() ? "" : rubber + entry,
                 words);
  };
  // What another choice would use.
  const auto expect_idle = [&](const std::string &law, Overrides overrides) {
    for (auto &override : overrides)
      override = rubber + override;
    const TemporaryFile file(block_scene("plane strain"), ".prm");
    const ParameterFile parameters(file.name,
                                   overrides + Overrides{rubber + "Law=" + law},
                                   declare_scene);
    EXPECT_EQ(std::count_if(parameters.warnings.begin(),
                            parameters.warnings.end(),
                            [](const auto &warning) {
                              return warning.find("does nothing") !=
                                     std::string::npos;
                            }),
              1)
      << law << overrides[0];
  };
  for (const auto &law : laws_that_yield)
    {
      // entries of another hardening
      for (const std::string other : {"Saturation stress=2",
                                      "Limit strain=0.1",
                                      "Reference strain=1",
                                      "Strength coefficient=1",
                                      "Rate coefficient=1",
                                      "Yield stresses=0 1"})
        expect_idle(law, {other});
      blame(law, {"Hardening=magic"}, "", {"magic", "Johnson-Cook"});
      blame(law,
            {"Hardening=bilinear", "Softening modulus=2"},
            "Softening modulus",
            {"'2'", "three shear moduli"});
      blame(law,
            {"Hardening=Voce", "Yield stress=2", "Saturation stress=1"},
            "Saturation stress",
            {"Yield stress"});
      for (const std::string hardening : {"Swift", "Ludwik", "Johnson-Cook"})
        for (const std::string bad : {"0", "-1", "1.1"})
          blame(law,
                {"Hardening=" + hardening, "Hardening exponent=" + bad},
                "",
                {"Hardening exponent", bad});
      blame(law,
            {"Hardening=Swift", "Reference strain=0"},
            "",
            {"Reference strain"});
      expect_idle(law, {"Hardening=Johnson-Cook", "Melting temperature=2000"});
      blame(law,
            {"Hardening=Johnson-Cook",
             "Specific heat=1",
             "Melting temperature=100"},
            "Melting temperature",
            {"100", "Reference temperature"});
      expect_idle(law, {"Taylor-Quinney factor=0.9"});
      blame(law,
            {"Specific heat=1", "Taylor-Quinney factor=1.1"},
            "",
            {"Taylor-Quinney factor"});
      for (const auto &[table, word] :
           {std::pair<std::string, std::string>("", "pair"),
            {"0", "pairs"},
            {"0 1 2", "pairs"},
            {"0 1; x 2", "pairs"},
            {"0 nan", "pairs"},
            {"0.1 1", "increase"},
            {"0 1; 0 2", "increase"},
            {"0 1; 0.2 2; 0.1 3", "increase"},
            {"0 0", "positive"},
            {"0 1; 0.1 -1", "negative"},
            {"0 1; 0.1 0.8", "three shear moduli"}})
        blame(law,
              {"Hardening=table", "Yield stresses=" + table},
              "Yield stresses",
              {"found '", word});
    }
}
