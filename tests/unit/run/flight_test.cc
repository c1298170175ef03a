#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "run_scene.h"

using namespace impm;

namespace
{
  double
  sum(const std::vector<double> &values)
  {
    return std::accumulate(values.begin(), values.end(), 0.);
  }
} // namespace


// A body that meets nothing crosses several cells a step, and those of other
// ranks.
TEST(FlightMpi, ABlockFallsFreely)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      const auto columns =
        run_file("extreme/flight", {"Grid/Method=" + method});
      EXPECT_EQ(columns.at("time").size(), 20u);
      EXPECT_EQ(sum(columns.at("step_cuts")), 0);
      EXPECT_EQ(columns.at("points").back(), 64);
      for (unsigned int i = 0; i < 20; ++i)
        {
          const double t = columns.at("time")[i];
          EXPECT_NEAR(columns.at("fall")[i], 9.81 / 2 * t * t, 1e-12);
        }
    }
}


// It turns as it falls.
TEST(FlightMpi, ABlockTurnsAsItFalls)
{
  const auto columns =
    run_file("extreme/flight",
             {"Time/Integrator=energy-momentum",
              "Time/Transfer=APIC",
              "Bodies/block/Velocity=-2*(y-5.6); 2*(x-0.6)"});
  EXPECT_EQ(columns.at("time").size(), 20u);
  EXPECT_EQ(sum(columns.at("step_cuts")), 0);
  EXPECT_NEAR(columns.at("fall").back(), 9.81 / 2, 1e-6);
}


// Near a floor that holds nodes it does not, nor near another body.
TEST(FlightMpi, ABlockThatWillLandDoesNot)
{
  const auto near_floor =
    run_file("extreme/flight",
             {"Boundary conditions/bottom/Type=slip", "Time/End time=1.05"});
  EXPECT_GT(near_floor.at("time").size(), 21u);
  EXPECT_GT(sum(near_floor.at("step_cuts")), 0);

  const auto near_another = run_file("extreme/flight",
                                     {"Geometry/Shapes=block, other",
                                      "Geometry/other/Kind=box",
                                      "Geometry/other/Lower corner=0.4, 2.4",
                                      "Geometry/other/Upper corner=0.8, 2.8",
                                      "Bodies/Names=block, other",
                                      "Bodies/other/Shape=other",
                                      "Bodies/other/Material=stiff",
                                      "Bodies/other/Points per cell=2",
                                      "Bodies/other/Velocity=0; 5",
                                      "Time/End time=0.7"});
  EXPECT_GT(sum(near_another.at("step_cuts")), 0);
}


// Side by side they fly each for itself, though their points mix in the order
// of the cells, and stay in one piece each.
TEST(FlightMpi, TwoBlocksSideBySide)
{
  const auto columns = run_file("extreme/flight",
                                {"Geometry/Shapes=block, other",
                                 "Geometry/block/Lower corner=0.1, 5.4",
                                 "Geometry/block/Upper corner=0.4, 5.8",
                                 "Geometry/other/Kind=box",
                                 "Geometry/other/Lower corner=0.8, 5.4",
                                 "Geometry/other/Upper corner=1.1, 5.8",
                                 "Bodies/Names=block, other",
                                 "Bodies/other/Shape=other",
                                 "Bodies/other/Material=stiff",
                                 "Bodies/other/Points per cell=2",
                                 "Bodies/other/Velocity=0; 0.9"});
  EXPECT_EQ(sum(columns.at("step_cuts")), 0);
  for (const double pieces : columns.at("pieces"))
    EXPECT_EQ(pieces, 2);
  EXPECT_NEAR(columns.at("fall").back(), 9.81 / 2, 1e-12);
}


// Nothing changes where the grid is adapted around it.
TEST(FlightMpi, ABlockFallsThroughAnAdaptiveGrid)
{
  const auto columns = run_file("extreme/flight",
                                {"Grid/Adaptation/Criteria=surface",
                                 "Grid/Adaptation/surface/Kind=free surface",
                                 "Grid/Adaptation/Highest level=1"});
  EXPECT_EQ(columns.at("time").size(), 20u);
  EXPECT_NEAR(columns.at("fall").back(), 9.81 / 2, 1e-12);
}
