#include <gtest/gtest.h>

#include <cmath>

#include "run_scene.h"

using namespace impm;

namespace
{
  // The force over the exact one at the end, and the drift of the deformation,
  // when a bar is drawn by half (prm/extreme/stretched_bar.prm).
  std::pair<double, double>
  draw(const std::string &method, const std::string &adaptation)
  {
    const auto columns =
      run_file("extreme/stretched_bar",
               {"Time/End time=0.5",
                "Grid/Method=" + method,
                "Bodies/bar/Point adaptation=" + adaptation});
    const double l = 1.5;
    return {columns.at("force").back() / (0.125e6 * (l - 1 / l)),
            columns.at("deformation_drift").back()};
  }
} // namespace


// What boxes carry is right; where plain points carry too little, since each
// cell that they cross tells them its own gradient, their drift says so.
TEST(ThinningMpi, DriftTellsOfForcesThatAreTooSmall)
{
  for (const std::string adaptation : {"split", "off"})
    {
      SCOPED_TRACE(adaptation);
      const auto [force, drift] = draw("GIMP", adaptation);
      EXPECT_NEAR(force, 1., 0.015);
      EXPECT_LT(drift, 0.01);
      const auto [lost_force, large_drift] = draw("MPM", adaptation);
      EXPECT_LT(lost_force, 0.75);
      EXPECT_NEAR(large_drift, 1 - lost_force, 0.1);
    }
}


// Without friction, to a twentieth of the height: exact.
TEST(ThinningMpi, CompressionToATwentiethIsExact)
{
  for (const std::string method : {"GIMP", "MPM"})
    {
      SCOPED_TRACE(method);
      const auto   columns = run_file("upsetting_frictionless",
                                    {"Grid/Upper corner=0.048, 0.015",
                                       "Grid/Cells=24, 8",
                                       "Grid/Method=" + method,
                                       "Bodies/billet/Point adaptation=split",
                                       "Time/Time step=2e-4",
                                       "Time/End time=0.01425"});
      const double L       = std::log(20.);
      const double load = (0.7e9 + 0.3e9 * L) / (1 + 0.3 / 200) * M_PI * 2e-3;
      EXPECT_NEAR(columns.at("platen_load").back() / load, 1., 1e-3);
    }
}


// Boxes are cut where the side folds onto the platen. Points that went with
// what is left of them passed through it, and the run ended at 80 %.
TEST(ThinningMpi, PointsOfAFoldStayBehindThePlaten)
{
  const auto columns = run_file("extreme/rough_platens",
                                {"Grid/Cells=20, 8", "Time/Time step=2e-4"});
  EXPECT_NEAR(columns.at("platen_displacement").back(), 0.0135, 1e-12);
  EXPECT_NEAR(columns.at("largest_radius").back(), 0.031, 0.001);
  // No probe asks for where points began.
  EXPECT_GT(columns.at("deformation_drift").back(), 0.1);
}


// Points that move through most of the grid while they draw apart: halves that
// flew on side by side would lose the gradient of velocity.
TEST(ThinningMpi, ABarIsDrawnToTenTimesItsLength)
{
  for (const auto &[transfer, error] :
       {std::make_pair("APIC", 0.01), std::make_pair("FLIP", 0.05)})
    {
      SCOPED_TRACE(transfer);
      const auto columns = run_file("extreme/drawn_bar",
                                    {"Grid/Cells=96, 2",
                                     std::string("Time/Transfer=") + transfer});
      EXPECT_NEAR(columns.at("stress").back() / 49.5, 1., error);
      EXPECT_EQ(columns.at("pieces").back(), 1);
    }
}


// Two points a cell, drawn out to two and a half times their length along an
// axis.
TEST(ThinningMpi, PointsCountAlongTheAxisInWhichTheyAreFew)
{
  const auto columns = run_file("extreme/drawn_bar",
                                {"Grid/Cells=96, 2",
                                 "Bodies/bar/Point adaptation=off",
                                 "Time/End time=1.5"});
  EXPECT_NEAR(columns.at("smallest_points_per_cell").back(), 0.8, 0.1);
  EXPECT_GT(columns.at("mean_points_per_cell").back(), 0.7);
}


// A node that is out of balance moves into the box however short the step: the
// run once cut it for ever.
TEST(ThinningMpi, ANodeIsNotDrivenIntoABoxForEver)
{
  const auto columns =
    run_file("extreme/rough_platens_finite_elements",
             {"Bodies/billet/Material=rubber", "Time/End time=0.0086"});
  EXPECT_NEAR(columns.at("platen_displacement").back(), 0.0086, 1e-12);
}
