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

  /** A face comes down by 0.3 in ten steps. */
  template <int dim = 2>
  void
  check_press(const std::string &method,
              const Overrides   &overrides = {},
              const std::string &kind      = "plane strain")
  {
    SCOPED_TRACE(kind + ", " + method);
    const bool solid = dim == 3;
    const auto columns =
      run_block<dim>(kind,
                     Overrides{"Materials/rubber/Poisson's ratio=0",
                               "Grid/Method=" + method,
                               "Bodies/block/Point adaptation=split",
                               solid ? "Grid/Upper corner=1, 1.125, 1" :
                                       "Grid/Upper corner=1, 1.125",
                               solid ? "Grid/Cells=2, 9, 2" : "Grid/Cells=8, 9",
                               "Output/Reactions=load",
                               "Output/load/On=top",
                               std::string("Output/load/Direction=0, 1") +
                                 (solid ? ", 0" : ""),
                               "Boundary conditions/bottom/Type=slip",
                               "Boundary conditions/left/Type=slip",
                               "Boundary conditions/top/Type=normal "
                               "displacement",
                               "Boundary conditions/top/Value=-0.3*t",
                               "Boundary conditions/top/Moves the grid=true",
                               "Solver/Newton tolerance=1e-9",
                               "Time/Time step=0.1"} +
                       (solid ?
                          Overrides{"Boundary conditions/back/Type=slip"} :
                          Overrides{}) +
                       overrides);
    const double area = kind == "axisymmetric" ? dealii::numbers::PI : 1;
    const auto  &time = columns.at("time"), &load = columns.at("load");
    for (unsigned int i = 0; i < time.size(); ++i)
      {
        const double closed = 0.3 * time[i] - gap;
        if (closed < -near)
          {
            EXPECT_NEAR(load[i], 0., 1e-12) << time[i];
          }
        // Plain points miss a tenth of the load on cells that they do not fit.
        else if (const double height = 1 - std::max(closed, 0.);
                 method == "GIMP")
          {
            EXPECT_NEAR(load[i] / area, -std::log(height) / height, near)
              << time[i];
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
    }
  check_press("GIMP", {"Grid/Reset=interval", "Grid/Steps between resets=3"});
  // The upper face carries the block down to the lower one.
  check_press("GIMP",
              {"Geometry/box/Lower corner=0, 0.125",
               "Geometry/box/Upper corner=1, 1.125"});
  for (const std::string method : {"MPM", "GIMP"})
    {
      check_press(method, {}, "axisymmetric");
      check_press<3>(method, {}, "3D");
    }
}


// Another attempt at a step, which is shorter, need not reach the face.
TEST(TouchingMpi, WhatLandsStaysIfTheStepIsMade)
{
  Model<2>   model(block_scene("plane strain"),
                 {"Grid/Method=GIMP",
                    "Grid/Upper corner=1, 1.06",
                    "Grid/Cells=8, 9",
                    "Boundary conditions/top/Type=fixed"});
  auto      &points  = model.points;
  const auto n_touch = [&]() {
    unsigned int n = 0;
    for (unsigned int p = 0; p < points.size(); ++p)
      n += points.fields(p)[points.offset_touched] != 0;
    return dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD);
  };
  const std::vector<dealii::Tensor<1, 2>> ways(points.size(),
                                               dealii::Point<2>(0, 0.1));
  remember_touching(model.scene.faces, model.grid, points);
  EXPECT_EQ(n_touch(), 0u);
  const std::array<double, 4> faces = {{0, 1, 0, 1.06}};
  for (const bool is_made : {false, true})
    {
      EXPECT_TRUE(land(model.scene.faces, faces, ways, points));
      EXPECT_GE(n_touch(), 16u);
      EXPECT_FALSE(land(model.scene.faces, faces, ways, points));
      end_landing(is_made, points);
      EXPECT_EQ(n_touch() > 0, is_made);
    }
}


// With inertia the wall is one that a body has to part from again: it holds all
// that lies in its cells.
TEST(Touching, WhichFacesHoldByTouch)
{
  const auto by_touch = [](const Overrides &overrides) {
    const auto scene =
      scene_from<2>(block_scene("plane strain"),
                    Overrides{"Boundary conditions/bottom/Type=slip",
                              "Boundary conditions/top/Type=normal velocity",
                              "Boundary conditions/top/Value=-1"} +
                      overrides);
    return std::make_pair(scene.faces[2].holds_by_touch,
                          scene.faces[3].holds_by_touch);
  };
  const Overrides split   = {"Bodies/block/Point adaptation=split"},
                  follows = {"Boundary conditions/top/Moves the grid=true"};
  EXPECT_EQ(by_touch(split), std::make_pair(true, false));
  EXPECT_EQ(by_touch(split + follows), std::make_pair(true, true));
  EXPECT_EQ(by_touch(split + follows + with_inertia),
            std::make_pair(false, true));
  EXPECT_EQ(by_touch(follows), std::make_pair(false, false));
  EXPECT_EQ(by_touch({"Grid/Method=Lagrangian"}), std::make_pair(false, false));
}
