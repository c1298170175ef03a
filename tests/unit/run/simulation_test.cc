#include <impm/base/exceptions.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // What a run leaves behind, however it ends.
  struct Left
  {
    Columns          history;
    nlohmann::json   summary;
    std::set<double> picture_times;
    std::string      failure;
  };

  template <int dim>
  Left
  leave_behind(const Scene<dim> &scene)
  {
    const int id =
      Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
    const std::string directory =
      "/tmp/impm_test_simulation_" + std::to_string(id);
    Left            left;
    Simulation<dim> simulation(scene,
                               CommandLine::Verbosity::quiet,
                               MPI_COMM_WORLD);
    try
      {
        simulation.run(directory, "test", "");
      }
    catch (const ComputationError &error)
      {
        left.failure = error.what();
      }
    MPI_Barrier(MPI_COMM_WORLD);
    left.history = read_history(directory);
    std::ifstream file(directory + "/summary.json");
    left.summary = nlohmann::json::parse(file);
    std::ifstream pictures(directory + "/particles.pvd");
    std::string   line;
    while (std::getline(pictures, line))
      if (const auto at = line.find("timestep=\""); at != std::string::npos)
        left.picture_times.insert(std::stod(line.substr(at + 10)));
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
    MPI_Barrier(MPI_COMM_WORLD);
    return left;
  }

  // A body without stress that flies over a long grid: motion alone.
  const Overrides flies = {"Materials/rubber/Law=linear elastic",
                           "Materials/rubber/Young's modulus=1e-6",
                           "Time/Integrator=explicit"};

  // A ring that is moved inwards.
  const Overrides ring = {"Geometry/Kind=axisymmetric",
                          "Geometry/box/Lower corner=0.5, 0",
                          "Geometry/box/Upper corner=1.5, 1",
                          "Grid/Method=Lagrangian",
                          "Grid/Lower corner=0.5, 0",
                          "Grid/Upper corner=1.5, 1",
                          "Time/Time step=1",
                          "Time/End time=4",
                          "Time/Smallest time step=0.9"};
} // namespace


TEST(SimulationMpi, AFailedStepIsNotCounted)
{
  const auto left =
    leave_behind(scene_from<2>(block_scene("axisymmetric"),
                               ring + displaced_faces(2, "-0.4*t; 0")));
  EXPECT_NE(left.failure.find("step 2"), std::string::npos) << left.failure;
  EXPECT_EQ(left.summary.at("steps"), 1);
  EXPECT_EQ(left.history.at("step").size(), 1u);
}


// By more than round-off. Its box, cut by the axis, has a radius still and J >
// 0.
TEST(SimulationMpi, APointThatReachesTheAxisFails)
{
  const auto left = leave_behind(
    scene_from<2>(block_scene("axisymmetric"),
                  flies + Overrides{"Grid/Method=GIMP",
                                    "Grid/Boxes=fixed",
                                    "Materials/rubber/Young's "
                                    "modulus=1e-30",
                                    "Bodies/block/Velocity=-0.04; 0",
                                    "Time/End time=4",
                                    "Time/Smallest time step=0.9"}));
  EXPECT_NE(left.failure.find("axis"), std::string::npos) << left.failure;
  EXPECT_NE(left.failure.find("point "), std::string::npos) << left.failure;
  EXPECT_EQ(left.summary.at("steps"), 1);
}


// After a step over several intervals, pictures are not due at every step.
TEST(SimulationMpi, PicturesAfterALongStep)
{
  const auto left = leave_behind(
    scene_from<2>(block_scene("plane strain"),
                  flies + Overrides{"Grid/Upper corner=10, 1",
                                    "Grid/Cells=40, 4",
                                    "Loads/Body force=if(t < 3.9, 0, 0.05); 0",
                                    // which it does not fly freely along
                                    "Boundary conditions/bottom/Type=slip",
                                    "Time/Time step=4",
                                    "Time/End time=10",
                                    "Output/Pictures=true",
                                    "Output/Time between pictures=1"}));
  EXPECT_EQ(left.failure, "");
  std::set<double> expected = {0};
  double           before   = 0;
  const auto      &times    = left.history.at("time");
  ASSERT_EQ(times.front(), 4.);
  for (const double time : times)
    {
      if (std::floor(time + 1e-9) > std::floor(before + 1e-9) ||
          time == times.back())
        expected.insert(time);
      before = time;
    }
  EXPECT_LT(expected.size(), 1 + times.size());
  ASSERT_EQ(left.picture_times.size(), expected.size());
  for (auto a = expected.begin(), b = left.picture_times.begin();
       a != expected.end();
       ++a, ++b)
    EXPECT_NEAR(*a, *b, 1e-5);
}


// A face that presses the block and does not move the grid is left by it.
TEST(SimulationMpi, AFaceThatLosesItsBodyWarnsOnce)
{
  const auto warnings_of = [](const std::string &moves_grid) {
    const Overrides press = {"Materials/rubber/Poisson's ratio=0",
                             "Grid/Cells=10, 10",
                             "Boundary conditions/bottom/Type=slip",
                             "Boundary conditions/top/Type=normal displacement",
                             "Boundary conditions/top/Value=-0.3*t",
                             "Boundary conditions/top/Moves the grid=" +
                               moves_grid,
                             "Solver/Newton tolerance=1e-9",
                             "Time/Time step=0.05"};
    return leave_behind(scene_from<2>(block_scene("plane strain"), press))
      .summary.at("warnings");
  };
  EXPECT_TRUE(warnings_of("true").empty());
  const auto warnings = warnings_of("false");
  // what the file gives away, then what happens, to plain points as well
  ASSERT_EQ(warnings.size(), 3u) << warnings;
  EXPECT_NE(warnings[2].get<std::string>().find("drifted"), std::string::npos);
  const std::string read = warnings[0], happens = warnings[1];
  EXPECT_NE(read.find("'top'"), std::string::npos) << read;
  EXPECT_NE(read.find("Moves the grid"), std::string::npos) << read;
  EXPECT_EQ(happens.find("t = 0."), 0u) << happens;
  EXPECT_NE(happens.find("'top'"), std::string::npos) << happens;
}
