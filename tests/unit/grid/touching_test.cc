#include <gtest/gtest.h>

#include <cmath>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace impm;

// When faces of the domain hold material.
namespace
{
  template <int dim>
  Columns
  run_block(const std::string &kind, const Overrides &overrides)
  {
    const int id =
      dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                        static_cast<int>(getpid()));
    return run(scene_from<dim>(block_scene(kind), overrides),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_touching_" + std::to_string(id));
  }

  // A cell between a block of unit height and a face, which holds what is a
  // tenth of that away.
  constexpr double gap = 0.125, near = 0.1 * gap;

  const Overrides a_face_apart = {"Materials/rubber/Poisson's ratio=0",
                                  "Grid/Upper corner=1, 1.125",
                                  "Grid/Cells=8, 9",
                                  "Output/Reactions=load",
                                  "Output/load/Direction=0, 1"};

  /** A face comes down by 0.3 in ten steps. */
  void
  check_press(const std::string &method, const Overrides &overrides = {})
  {
    SCOPED_TRACE(method);
    const auto columns =
      run_block<2>("plane strain",
                   a_face_apart + overrides +
                     Overrides{"Grid/Method=" + method,
                               "Output/load/On=top",
                               "Boundary conditions/bottom/Type=slip",
                               "Boundary conditions/left/Type=slip",
                               "Boundary conditions/top/Type=normal "
                               "displacement",
                               "Boundary conditions/top/Value=-0.3*t",
                               "Boundary conditions/top/Moves the grid=true",
                               "Solver/Newton tolerance=1e-9",
                               "Time/Time step=0.1"});
    const auto &time = columns.at("time"), &load = columns.at("load");
    for (unsigned int i = 0; i < time.size(); ++i)
      {
        const double closed = 0.3 * time[i] - gap;
        if (closed < -near)
          {
            EXPECT_EQ(load[i], 0.) << time[i];
          }
        // Plain points miss a tenth of the load on cells that they do not fit.
        else if (const double height = 1 - std::max(closed, 0.);
                 method == "GIMP")
          {
            EXPECT_NEAR(load[i], -std::log(height) / height, near) << time[i];
          }
        else if (closed > 0.02)
          {
            EXPECT_GT(load[i], 0.8 * closed) << time[i];
          }
      }
    EXPECT_EQ(time.size(), 10u);
  }
} // namespace

// As if the face were not there before it touches the block.
TEST(TouchingMpi, APlatenIsFeltWhereItIs)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      check_press(method);
      check_press(method, refined);
      check_press(method, {"Bodies/block/Point adaptation=split"});
    }
  check_press("GIMP", {"Grid/Reset=interval", "Grid/Steps between resets=3"});
}


// A block flies towards a wall, on which it lands after a quarter of a second.
TEST(TouchingMpi, AWallIsFeltWhereItIs)
{
  for (const std::string integrator : {"theta", "explicit"})
    for (const std::string method : {"MPM", "GIMP"})
      {
        SCOPED_TRACE(integrator + " " + method);
        const auto columns =
          run_block<2>("plane strain",
                       a_face_apart +
                         Overrides{"Grid/Method=" + method,
                                   "Geometry/box/Lower corner=0, 0.125",
                                   "Geometry/box/Upper corner=1, 1.125",
                                   "Bodies/block/Velocity=0; -0.5",
                                   "Output/load/On=bottom",
                                   "Boundary conditions/bottom/Type=fixed",
                                   "Time/Integrator=" + integrator,
                                   "Time/Time step=0.02",
                                   "Time/End time=0.4"});
        const auto &time = columns.at("time"), &load = columns.at("load");
        for (unsigned int i = 0; i < time.size(); ++i)
          if (time[i] < (gap - near) / 0.5 - 0.01)
            {
              EXPECT_NEAR(load[i], 0., 1e-12) << time[i];
            }
          else if (time[i] > gap / 0.5 + 0.01)
            {
              EXPECT_GT(std::abs(load[i]), 0.1) << time[i];
            }
      }
}
