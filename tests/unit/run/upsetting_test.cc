#include <impm/base/files.h>
#include <impm/study/curve.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "run_scene.h"

using namespace impm;

// The scenes of prm/ against their references.
namespace
{
  double
  sum(const std::vector<double> &values)
  {
    return std::accumulate(values.begin(), values.end(), 0.);
  }

  void
  compare_with_finite_elements(const Columns     &columns,
                               const std::string &column,
                               const double       allowed)
  {
    const auto reference =
      read_csv_table(std::string(IMPM_SCENES) + "/references/upsetting.csv");
    const auto curve =
      make_curve(reference["platen_displacement"], reference[column]);
    ASSERT_TRUE(curve);
    const auto &travel = columns.at("platen_displacement");
    for (unsigned int i = 0; i < travel.size(); ++i)
      if (curve->contains(travel[i]))
        {
          EXPECT_NEAR(columns.at(column)[i] / curve->value(travel[i]),
                      1.,
                      allowed)
            << column << " at " << travel[i];
        }
  }
} // namespace

TEST(Upsetting, WithoutFrictionIsExact)
{
  for (const std::string cells : {"12, 8", "24, 15", "48, 30"})
    {
      const auto columns =
        run_file("upsetting_frictionless", {"Grid/Cells=" + cells});
      EXPECT_NEAR(columns.at("platen_load").back(), 764.5e3, 0.7645e3) << cells;
      // The cells of the coarsest grid do not fit the radius.
      if (cells != "12, 8")
        {
          EXPECT_NEAR(columns.at("largest_radius").back(), 15.796e-3, 15.8e-6)
            << cells;
        }
    }
}

// The main scene, against finite elements at every travel.
TEST(Upsetting, AgreesWithFiniteElements)
{
  const auto columns = run_file("upsetting");
  compare_with_finite_elements(columns, "platen_load", 0.015);
  compare_with_finite_elements(columns, "largest_radius", 0.005);
  EXPECT_NEAR(columns.at("platen_displacement").back(), 9e-3, 1e-12);
  EXPECT_LE(sum(columns.at("step_cuts")), 2.);
  EXPECT_GT(sum(columns.at("splits")), 1000.);
  EXPECT_GT(columns.at("smallest_points_per_cell").back(), 3.);
  EXPECT_NEAR(columns.at("mass").back(),
              7800 * dealii::numbers::PI * 1e-4 * 0.015,
              1e-12);
}

// What the side lays down on a platen bears its share: the load of steel
// between 70 and 75 % of compression, by finite elements 1.58 and 2.45 MN at
// the ends (prm/extreme/rough_platens_finite_elements.prm).
TEST(Upsetting, BetweenRoughPlatens)
{
  const auto columns =
    run_file("extreme/rough_platens", {"Time/End time=0.01125"});
  const auto &travel = columns.at("platen_displacement"),
             &load   = columns.at("platen_load");
  double       error = 0;
  unsigned int n     = 0;
  for (unsigned int i = 0; i < travel.size(); ++i)
    if (travel[i] > 0.0105)
      {
        const double part = (travel[i] - 0.0105) / 7.5e-4;
        error += load[i] / (1.58e6 * std::pow(2.45 / 1.58, part)) - 1;
        ++n;
      }
  ASSERT_GT(n, 5u);
  EXPECT_NEAR(error / n, 0., 0.05);
}

TEST(Upsetting, QuasiStaticAgreesWithBackwardEuler)
{
  // "Theta" and "Velocity" belong to inertia alone: the frictionless scene has
  // neither.
  const std::vector<std::string> platen = {
    "Boundary conditions/top/Type=velocity",
    "Boundary conditions/top/Value=0; -speed"};
  auto inertia = platen;
  inertia.push_back("Time/Integrator=theta");
  const auto slow = run_file("upsetting_frictionless", platen);
  const auto fast = run_file("upsetting_frictionless", inertia);
  for (const unsigned int step : {22u, 44u, 67u, 89u})
    EXPECT_NEAR(fast.at("platen_load")[step] / slow.at("platen_load")[step],
                1.,
                0.02);
}

TEST(Upsetting, PlatenOfRigidPoints)
{
  const auto columns = run_file("upsetting_rigid_points");
  EXPECT_GT(columns.at("platen_load").back(), 800e3);
  EXPECT_LT(columns.at("platen_load").back(), 1100e3);
  EXPECT_EQ(columns.at("points").back(), 600.);
  EXPECT_EQ(sum(columns.at("step_cuts")), 0.);
}

// On the norm of the residual instead of the energy, line searches would cost a
// third more iterations, and cuts of the time step.
TEST(Upsetting, MomentumFormulationDescendsInEnergy)
{
  const auto columns = run_file("upsetting_rigid_points",
                                {"Time/Formulation=momentum",
                                 "Stabilization/Ghost penalty=0",
                                 "Solver/Residual scale=cell",
                                 "Solver/Newton tolerance=1e-4",
                                 "Solver/Newton reduction=1"});
  EXPECT_GT(columns.at("platen_load").back(), 800e3);
  EXPECT_LT(columns.at("platen_load").back(), 1100e3);
  EXPECT_EQ(sum(columns.at("step_cuts")), 0.);
  EXPECT_LT(sum(columns.at("newton_iterations")) /
              columns.at("platen_load").size(),
            6.);
}

TEST(Upsetting, QuarterInThreeDimensions)
{
  const auto columns = run_file<3>("upsetting_quarter", {"Time/End time=1e-3"});
  compare_with_finite_elements(columns, "platen_load", 0.02);
  compare_with_finite_elements(columns, "largest_radius", 0.01);
}

TEST(UpsettingNightly, LongStepsDoNotCarryPointsThroughThePlaten)
{
  const auto columns = run_file("upsetting", {"Time/Time step=1e-3"});
  EXPECT_GT(columns.at("points").back(), 600.);
  EXPECT_NEAR(columns.at("time").back(), 0.009, 1e-12);
}

// Steps of 1 to 1e5 times what a wave takes through the smallest cell, the
// shortest ones for a while. Nodes that land make a stair of the load, of 5 %
// on cells of 1 mm.
TEST(UpsettingNightly, StepsOfAnyLengthAgreeWithFiniteElements)
{
  const auto check = [](const std::string              &cfl,
                        const std::vector<std::string> &overrides,
                        const double                    travel,
                        const double                    allowed) {
    SCOPED_TRACE(cfl);
    auto all = overrides;
    all.push_back("Time/CFL number=" + cfl);
    const auto columns = run_file("upsetting", all);
    EXPECT_GE(columns.at("platen_displacement").back(), travel);
    compare_with_finite_elements(columns, "platen_load", allowed);
    compare_with_finite_elements(columns, "largest_radius", 0.01);
  };
  const std::string              even   = "Grid/Adaptation/Highest level=0";
  const std::vector<std::string> coarse = {even,
                                           "Grid/Cells=12, 8",
                                           "Time/Largest number of steps=330"};
  check("1", coarse, 1e-4, 0.01);
  check("10", coarse, 9e-4, 0.01);
  check("1e3", {even}, 0.009 - 1e-12, 0.06);
  check("1e4", {}, 0.009 - 1e-12, 0.025);
  check("1e5", {}, 0.009 - 1e-12, 0.025);
}

TEST(Extreme, BallThatNothingHolds)
{
  const auto columns = run_file("extreme/isolated_ball");
  EXPECT_GT(columns.at("held_cells").back(), 0.);
  // The block settles as if alone, rho g H^2 / (2 M).
  const double modulus    = 1e6 * 0.7 / (1.3 * 0.4);
  const double settlement = 1e4 * 0.25 / (2 * modulus);
  EXPECT_NEAR(columns.at("settlement").back(), -settlement, 0.01 * settlement);
}
