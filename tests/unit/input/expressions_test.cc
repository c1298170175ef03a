#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>

#include <gtest/gtest.h>

#include <filesystem>

#include "expect_blame.h"
#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const std::string plane = block_scene("plane strain");
}


// At some points alone, which one rank may have: all ranks learn of it.
TEST(ExpressionsMpi, ValuesThatAreNotFinite)
{
  for (const std::string entry : {"Loads/Body force",
                                  "Geometry/box/Inside where negative",
                                  "Bodies/block/Velocity",
                                  "Grid/Refine where"})
    {
      const bool is_vector =
        entry == "Loads/Body force" || entry == "Bodies/block/Velocity";
      Overrides overrides = with_inertia;
      if (entry == "Geometry/box/Inside where negative")
        overrides.push_back("Geometry/box/Kind=function");
      if (entry == "Grid/Refine where")
        overrides.push_back("Grid/Local refinements=1");
      overrides.push_back(entry + "=" + (is_vector ? "0; " : "") +
                          "-sqrt(0.6 - x)");
      expect_blame(plane,
                   overrides,
                   entry,
                   {"'-sqrt(0.6 - x)', which is not a number at x = 0.",
                    "t ="});
    }
  expect_blame(plane, {"Loads/Body force=0; 1/0"}, "Loads/Body force", {"1/0"});
}


TEST(ExpressionsMpi, ValuesThatAreNotFiniteInTheRun)
{
  const auto scene = scene_from<2>(
    plane,
    with_inertia +
      Overrides{"Loads/Body force=0; if(x > 0.6, 1e-9*sqrt(0.4 - t), 0)",
                "Time/Time step=0.25"});
  Simulation<2> simulation(scene,
                           CommandLine::Verbosity::quiet,
                           MPI_COMM_WORLD);
  const int     id =
    Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
  const auto directory =
    testing::TempDir() + "impm_expressions_" + std::to_string(id);
  try
    {
      simulation.run(directory, "test", "");
      ADD_FAILURE() << "goes on";
    }
  catch (const ComputationError &error)
    {
      EXPECT_EQ(error.entry, "Loads/Body force");
      EXPECT_NE(std::string(error.what()).find(", t = 0.5: allowed"),
                std::string::npos)
        << error.what();
    }
  MPI_Barrier(MPI_COMM_WORLD);
  std::error_code ignored;
  std::filesystem::remove_all(directory, ignored);
}


// A guess does not count, nor does what another scene has left.
TEST(Expressions, WhatDoesNotCount)
{
  const auto scene =
    scene_from<2>(plane, {"Loads/Body force=0; 1/x", "Time/Time step=1"});
  const auto &force = *scene.loads.body_force;
  {
    const ExpressionTrial trial;
    EXPECT_TRUE(std::isinf(force.value(Point<2>(), 1)));
  }
  EXPECT_FALSE(find_flaw(MPI_COMM_SELF));
  EXPECT_TRUE(std::isinf(force.value(Point<2>(), 1)));
  scene_from<2>(plane);
  EXPECT_FALSE(find_flaw(MPI_COMM_SELF));
  EXPECT_TRUE(std::isinf(force.value(Point<2>(0., 0.5), 1)));
  const auto flaw = find_flaw(MPI_COMM_SELF);
  ASSERT_TRUE(flaw);
  EXPECT_EQ(flaw->entry, "Loads/Body force");
  EXPECT_NE(std::string(flaw->what()).find("infinite at x = 0, y = 0.5"),
            std::string::npos);
  EXPECT_FALSE(find_flaw(MPI_COMM_SELF));
}
