#include <gtest/gtest.h>

#include <algorithm>

#include "run_scene.h"

using namespace impm;

// A free block that turns once about its middle (prm/rotation.prm), lighter, at
// a tolerance for daily use.
namespace
{
  Columns
  turn(const std::string &method, const std::vector<std::string> &overrides)
  {
    std::vector<std::string> all = {"Materials/stiff/Density=10",
                                    "Solver/Newton tolerance=1e-7",
                                    "Grid/Method=" + method};
    if (method != "Lagrangian")
      all.push_back("Time/Transfer=APIC");
    all.insert(all.end(), overrides.begin(), overrides.end());
    return run_file("rotation", all);
  }

  // Over the moment of inertia of the points: with one of each cell in its
  // middle, that of the block is missed.
  constexpr double energy = 7.88581391647;

  double
  largest(const std::vector<double> &values)
  {
    return *std::max_element(values.begin(), values.end());
  }
} // namespace


// However stiff it is and however far it turns in a step.
TEST(RotationMpi, EnergyMomentumMethodKeepsBoth)
{
  for (const std::string method : {"Lagrangian", "MPM", "GIMP"})
    for (const std::string young : {"1e4", "1e11"})
      {
        SCOPED_TRACE(method + ", " + young);
        const auto columns =
          turn(method,
               {"Time/Integrator=energy-momentum",
                "Materials/stiff/Young's modulus=" + young,
                method == "Lagrangian" ? "Time/Time step=0.0833333333333333" :
                                         "Time/Time step=0.0138888888888889"});
        EXPECT_LE(largest(columns.at("newton_iterations")), 10);
        EXPECT_LE(largest(columns.at("energy_gain")), 1e-3 * energy);
        EXPECT_EQ(largest(columns.at("step_cuts")), 0);
        const auto &spin = columns.at("angular_momentum_z");
        EXPECT_NEAR(spin.back() / spin.front(), 1., 0.02);
      }
}


// The trapezoidal rule makes energy of it: without a tolerance, many times what
// was there; with one, steps are cut.
TEST(Rotation, EnergyFromNothingCutsSteps)
{
  const std::vector<std::string> overrides = {
    "Materials/stiff/Young's modulus=1e9", "Time/Time step=0.0138888888888889"};
  auto unguarded = overrides;
  unguarded.push_back("Time/Energy tolerance=0");
  EXPECT_GT(largest(turn("Lagrangian", unguarded).at("energy_gain")),
            0.5 * energy);
  const auto columns = turn("Lagrangian", overrides);
  EXPECT_GT(largest(columns.at("step_cuts")), 0);
  EXPECT_LT(largest(columns.at("energy_gain")), 0.03 * energy);
}


// Grids come and go under a body that turns; on several ranks they may own as
// many values as the one before, and yet have other ghosts.
TEST(RotationMpi, AdaptiveGridKeepsMomentum)
{
  const auto columns = turn("GIMP",
                            {"Grid/Cells=16, 16",
                             "Grid/Adaptation/Criteria=surface",
                             "Grid/Adaptation/surface/Kind=free surface",
                             "Grid/Adaptation/Highest level=1",
                             "Time/Largest number of steps=40"});
  for (const std::string name : {"momentum_x", "momentum_y"})
    for (const double momentum : columns.at(name))
      EXPECT_NEAR(momentum, 0., 1e-10);
}
