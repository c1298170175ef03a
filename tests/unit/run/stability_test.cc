#include <gtest/gtest.h>

#include <algorithm>

#include "run_scene.h"

using namespace impm;

namespace
{
  double
  largest(const std::vector<double> &values)
  {
    return *std::max_element(values.begin(), values.end());
  }
} // namespace


// A clamped column is not followed straight past its Euler load of 3.2 kN
// (prm/extreme/euler_column.prm), with any kick to the side and with none.
TEST(StabilityMpi, AColumnBuckles)
{
  for (const std::string kick : {"0", "1e-8", "1e-2"})
    {
      SCOPED_TRACE(kick);
      const auto columns =
        run_file("extreme/euler_column",
                 {"Grid/Method=Lagrangian",
                  "Grid/Cells=8, 160",
                  "Grid/Lower corner=-0.05, 0",
                  "Grid/Upper corner=0.05, 2",
                  "Time/Time step=0.01",
                  "Time/End time=0.6",
                  "General/Constants=kick=" + kick + ", euler = 3200"});
      EXPECT_NEAR(columns.at("load").back() / 3200, 1., 0.03);
      EXPECT_LT(largest(columns.at("load")) / 3200, 1.05);
      EXPECT_GT(std::abs(columns.at("sway").back()), 0.05);
      EXPECT_EQ(largest(columns.at("unstable_equilibria")) > 0, kick != "1e-2");
    }
}


// By points the buckled state is more than a cell away.
TEST(StabilityMpi, AColumnJumps)
{
  const auto columns =
    run_file("extreme/euler_column",
             {"Grid/Cells=24, 80", "Time/Time step=0.02", "Time/End time=0.6"});
  EXPECT_GT(largest(columns.at("damped_steps")), 0);
  EXPECT_EQ(columns.at("damped_steps").back(), 0);
  EXPECT_NEAR(columns.at("load").back() / 3200, 1., 0.08);
}


// An arch snaps through under a load that only grows.
TEST(Stability, AnArchSnapsThrough)
{
  const auto columns = run_file("extreme/arch", {"Grid/Cells=80, 28"});
  EXPECT_NEAR(columns.at("crown").back() / -0.3965, 1., 0.02);
  EXPECT_NEAR(columns.at("quarter").back() / -0.2574, 1., 0.02);
}


// Who does not want to leave is told, or is not.
TEST(Stability, IsWatchedOnly)
{
  for (const std::string what : {"warn", "ignore"})
    {
      const auto columns = run_file("extreme/euler_column",
                                    {"Grid/Method=Lagrangian",
                                     "Grid/Cells=4, 80",
                                     "Grid/Lower corner=-0.05, 0",
                                     "Grid/Upper corner=0.05, 2",
                                     "Time/Time step=0.05",
                                     "Solver/Unstable equilibria=" + what});
      EXPECT_GT(columns.at("load").back(), 2 * 3200);
      EXPECT_EQ(largest(columns.at("unstable_equilibria")) > 0, what == "warn");
    }
}
