#include <impm/base/exceptions.h>
#include <impm/run/likely_causes.h>

#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace impm;

namespace
{
  /** What a scene says when it cannot go on. */
  template <int dim = 2>
  std::string
  failure_of(const std::string &name, const Overrides &overrides)
  {
    try
      {
        run_file<dim>(name, overrides);
      }
    catch (const ComputationError &error)
      {
        return error.what();
      }
    return "done";
  }

  void
  expect_cause(const std::string &text, const std::string &cause)
  {
    EXPECT_NE(text.find(cause), std::string::npos) << text;
    EXPECT_NE(text.find("at t = "), std::string::npos) << text;
    EXPECT_NE(text.find("likely"), std::string::npos) << text;
  }

  // No second attempt.
  const Overrides at_once = {"Time/Smallest time step=1"};
} // namespace


// A symmetric arch under a weight that grows beyond what it bears.
TEST(LikelyCauses, ALimitPoint)
{
  expect_cause(failure_of("extreme/arch",
                          {"Grid/Cells=80, 28",
                           "Solver/Unstable equilibria=warn"}),
               "a limit point");
}


TEST(LikelyCausesMpi, CrossingOfCells)
{
  expect_cause(failure_of("upsetting_rigid_points",
                          Overrides{"Time/Time step=2e-3"} + at_once),
               "crossing");
}


// Disks that fly into each other too fast for a step.
TEST(LikelyCausesMpi, Contact)
{
  expect_cause(failure_of("disks",
                          Overrides{"General/Constants=speed=2",
                                    "Materials/rubber/Law=neo-Hookean",
                                    "Time/Time step=0.02",
                                    "Time/End time=61"} +
                            at_once),
               "contact");
}


TEST(LikelyCausesMpi, TheMaterial)
{
  expect_cause(failure_of("extreme/flight",
                          Overrides{"Bodies/block/Velocity=0; "
                                    "-60*(y-5.6)",
                                    "Time/Integrator=explicit",
                                    "Time/Time step=0.02"} +
                            at_once),
               "the material");
}


// A cloud of twice the points that there is room for, pressed to half its
// height at once: the run says so when it begins and when it ends.
TEST(LikelyCauses, AnOverfullCell)
{
  std::string csv = "x, y, volume\n";
  for (unsigned int i = 0; i < 128; ++i)
    csv += std::to_string((i % 8 + (i < 64 ? 0.5 : 0.6)) / 8) + ", " +
           std::to_string((i / 8 % 8 + 0.5) / 8) + ", 0.015625\n";
  const TemporaryFile cloud(csv, ".csv");
  const std::string   directory =
    testing::TempDir() + "impm_overfull_" + std::to_string(getpid());
  const auto scene =
    scene_from<2>(block_scene("plane strain"),
                  at_once + Overrides{"Bodies/block/Points from=file",
                                      "Bodies/block/File=" + cloud.name,
                                      "Boundary conditions/bottom/Type=fixed",
                                      "Boundary conditions/top/Type=normal "
                                      "displacement",
                                      "Boundary conditions/top/Value=-2*t"});
  try
    {
      run(scene, MPI_COMM_SELF, directory);
      ADD_FAILURE();
    }
  catch (const ComputationError &error)
    {
      expect_cause(error.what(), "an overfull cell");
    }
}


TEST(LikelyCauses, FailedPoints)
{
  FailedStep step;
  step.failure = "a point turns inside out";
  step.failed  = 12;
  EXPECT_NE(likely_causes(step).find("failed points: 12 of them"),
            std::string::npos);
}


// A body flies out, since no face holds it.
TEST(LikelyCauses, AFaceThatHoldsNothing)
{
  FailedStep step;
  step.failure =
    "point 0 at 1 0 would leave the domain through its bottom face";
  EXPECT_NE(likely_causes(step).find("Boundary conditions"), std::string::npos);
}


// Newton's method stops where round-off keeps the residual up: such a tolerance
// ends no run.
TEST(LikelyCauses, ToleranceBelowRoundOff)
{
  const auto columns = run_file("upsetting_frictionless",
                                {"Solver/Newton tolerance=1e-30",
                                 "Solver/Newton reduction=1e-30",
                                 "Time/End time=1e-3"});
  double     stops   = 0;
  for (const double n : columns.at("noise_stops"))
    stops += n;
  EXPECT_GT(stops, 0.);
}


// A residual that round-off keeps up.
TEST(LikelyCauses, OfFigures)
{
  FailedStep step;
  step.failure = "Newton's method did not converge";
  EXPECT_NE(likely_causes(step).find("no sign"), std::string::npos);
  step.fullest = 1.8;
  EXPECT_EQ(likely_causes(step).rfind("likely an overfull cell", 0), 0u);
  step.fullest   = 1;
  step.residuals = {1, 1e-5, 2e-12, 1.5e-12, 1.7e-12, 1.6e-12};
  EXPECT_EQ(likely_causes(step).rfind("likely a tolerance below round-off", 0),
            0u);
  step.pieces = 3;
  EXPECT_NE(likely_causes(step).find("a tear"), std::string::npos);
  step.bodies_touch = true;
  EXPECT_NE(likely_causes(step).find(", or a tolerance"), std::string::npos);
}
