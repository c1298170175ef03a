#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "expect_blame.h"
#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  /** The last column of cells of the block moves. */
  Overrides
  grip(const std::string &value, const std::string &type = "displacement")
  {
    return {"Boundary conditions/Grips=jaw",
            "Boundary conditions/jaw/Body=block",
            "Boundary conditions/jaw/Where=x - 0.75",
            "Boundary conditions/jaw/Type=" + type,
            "Boundary conditions/jaw/Value=" + value};
  }

  const Overrides wide = {"Grid/Lower corner=-1, -1",
                          "Grid/Upper corner=3, 3",
                          "Grid/Cells=16, 16"};

  std::string
  path_of_run()
  {
    return "/tmp/impm_test_grips_" +
           std::to_string(
             Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                       static_cast<int>(getpid())));
  }
} // namespace


// The rest goes along, without strain.
TEST(GripsMpi, MoveAFreeBody)
{
  for (const Overrides &more : {Overrides{},
                                Overrides{"Grid/Method=GIMP"},
                                Overrides{"Grid/Method=Lagrangian"}})
    {
      const bool is_lagrangian =
        !more.empty() && more[0] == "Grid/Method=Lagrangian";
      const auto columns =
        run(scene_from<2>(block_scene("plane strain"),
                          more + (is_lagrangian ? Overrides{} : wide) +
                            grip("0.3*t; -0.2*t") +
                            Overrides{"Time/Time step=0.25",
                                      "Output/Probes=motion",
                                      "Output/motion/Kind=mean",
                                      "Output/motion/Field=displacement",
                                      "Output/motion/Component=1",
                                      "Output/Reactions=pull",
                                      "Output/pull/On=jaw",
                                      "Output/pull/Direction=1, 0"}),
            MPI_COMM_WORLD,
            path_of_run());
      EXPECT_NEAR(columns.at("motion").back(), -0.2, 1e-9);
      EXPECT_NEAR(columns.at("strain_energy").back(), 0, 1e-12);
      EXPECT_NEAR(columns.at("pull").back(), 0, 1e-9);
    }
}


// Half a turn, in places at the start: where the grip is by then is found.
TEST(GripsMpi, TurnAFreeBody)
{
  const std::string turn = "0.5 + (x - 0.5)*cos(2*t) - (y - 0.5)*sin(2*t) - x; "
                           "0.5 + (x - 0.5)*sin(2*t) + (y - 0.5)*cos(2*t) - y";
  const auto        columns =
    run(scene_from<2>(block_scene("plane strain"),
                      wide + grip(turn) +
                        Overrides{"Grid/Method=GIMP",
                                  "Time/Time step=0.02",
                                  "Output/Probes=corner",
                                  "Output/corner/Kind=point",
                                  "Output/corner/Position=1, 1",
                                  "Output/corner/Field=displacement",
                                  "Output/corner/Component=0"}),
        MPI_COMM_WORLD,
        path_of_run());
  EXPECT_NEAR(columns.at("corner").back(),
              0.5 * (std::cos(2.) - std::sin(2.) - 1),
              1e-3);
}


TEST(GripsMpi, PullABar)
{
  // Held on the left, the jaw free to go down: uniform stress, E ln(lambda).
  const auto columns =
    run(scene_from<2>(block_scene("plane strain"),
                      grip("0.1*t; free") +
                        Overrides{"Grid/Method=GIMP",
                                  "Grid/Upper corner=1.5, 1",
                                  "Grid/Cells=24, 16",
                                  "Materials/rubber/Poisson's ratio=0",
                                  "Boundary conditions/left/Type=displacement",
                                  "Boundary conditions/left/Value=0; free",
                                  "Boundary conditions/bottom/Type=slip",
                                  "Time/Time step=0.1",
                                  "Output/Reactions=pull",
                                  "Output/pull/On=jaw",
                                  "Output/pull/Direction=1, 0"}),
        MPI_COMM_WORLD,
        path_of_run());
  const double stretch = 1 + 0.1 / 0.75;
  EXPECT_NEAR(columns.at("pull").back(),
              -std::log(stretch) / stretch,
              0.03 * std::log(stretch));
}


TEST(GripsMpi, VelocityWithInertia)
{
  const auto columns =
    run(scene_from<2>(block_scene("plane strain"),
                      wide + grip("0.2; free", "velocity") +
                        Overrides{"Time/Integrator=theta",
                                  "Bodies/block/Velocity=0.2; 0.1",
                                  "Time/Time step=0.1"}),
        MPI_COMM_WORLD,
        path_of_run());
  EXPECT_NEAR(columns.at("momentum_x").back(), 0.2, 1e-9);
  EXPECT_NEAR(columns.at("momentum_y").back(), 0.1, 1e-9);
}


// At one of the nodes, that of one rank.
TEST(GripsMpi, MustKnowWhereNodesComeFrom)
{
  for (const std::string value : {"if(y > 0.9, 0/0, 0); 0", "0.1*x*x; 0"})
    {
      Model<2> model(block_scene("plane strain"), grip(value));
      if (value[0] == 'i')
        EXPECT_THROW(model.begin_step(), ComputationError);
      else
        model.begin_step();
    }
}


TEST(Grips, AreRefused)
{
  const auto blame = [](const Overrides   &overrides,
                        const std::string &entry,
                        const std::string &word) {
    expect_blame(block_scene("plane strain"),
                 overrides,
                 "Boundary conditions/" + entry,
                 {word});
  };
  blame(grip("free; free"), "jaw/Value", "not free");
  blame(grip("0.1*x; free"), "jaw/Value", "expressions in t");
  blame(grip("0"), "jaw/Value", "2 expressions");
  blame(grip("0; 0") + Overrides{"Boundary conditions/jaw/Where=x - 2"},
        "jaw/Where",
        "no point");
  blame(grip("0; 0") + Overrides{"Boundary conditions/jaw/Body=rock"},
        "jaw/Body",
        "block");
  blame({"Boundary conditions/Grips=top"}, "Grips", "face");
  blame({"Boundary conditions/Grips=block"}, "Grips", "body");
  blame({"Boundary conditions/top/Type=displacement",
         "Boundary conditions/top/Value=0; free",
         "Boundary conditions/top/Moves the grid=true"},
        "top/Moves the grid",
        "normal");
}
