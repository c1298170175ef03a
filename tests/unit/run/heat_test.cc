#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  std::string
  path_of_run()
  {
    return testing::TempDir() + "impm_heat_" +
           std::to_string(
             Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                       static_cast<int>(getpid())));
  }

  /** The block, which conducts with a diffusivity of 0.01 m^2/s, for 1 s. */
  const Overrides conducting = {"Materials/rubber/Specific heat=2",
                                "Materials/rubber/Conductivity=0.02",
                                "Time/Time step=0.1"};

  const Overrides sloped = {
    "Materials/rubber/Initial temperature=300 + 40*x*x - 30*y"};

  Overrides
  held(const unsigned int dim)
  {
    Overrides all;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      all.push_back("Boundary conditions/" + face_names()[f] + "/Type=slip");
    return all;
  }
} // namespace


// Whatever the points, the grid and the geometry, heat goes nowhere, also where
// the block flies or is pressed.
TEST(HeatMpi, InsulatedHeatIsConserved)
{
  const auto check = [](const auto &scene, const std::string &what) {
    SCOPED_TRACE(what);
    const auto   columns = run(scene, MPI_COMM_WORLD, path_of_run());
    const auto  &heat    = columns.at("heat");
    const auto  &work    = columns.at("plastic_work");
    const double scale   = 100; // of 50 K in all of the block
    for (unsigned int row = 0; row < heat.size(); ++row)
      EXPECT_NEAR(heat[row] - work[row], heat[0] - work[0], 1e-12 * scale);
    EXPECT_NEAR(columns.at("heat_supplied").back(), 0, 1e-12 * scale);
    EXPECT_LT(columns.at("largest_temperature").back(),
              columns.at("largest_temperature").front());
  };
  for (const std::string geometry :
       {"plane strain", "plane stress", "axisymmetric"})
    for (const std::string method : {"MPM", "GIMP", "Lagrangian"})
      check(scene_from<2>(block_scene(geometry),
                          conducting + sloped + held(2) +
                            Overrides{"Grid/Method=" + method}),
            geometry + ", " + method);
  for (const std::string method : {"MPM", "GIMP"})
    {
      check(scene_from<2>(block_scene("axisymmetric"),
                          conducting + sloped + held(2) + refined +
                            Overrides{"Grid/Method=" + method}),
            "hanging nodes, " + method);
      check(
        scene_from<2>(block_scene("plane strain"),
                      conducting + sloped + with_inertia +
                        Overrides{"Grid/Method=" + method,
                                  "Grid/Upper corner=2, 2",
                                  "Grid/Cells=8, 8",
                                  "Bodies/block/Velocity=0.7; 0.5 + 0.1*x"}),
        "flying, " + method);
    }
  check(
    scene_from<2>(block_scene("plane strain"),
                  conducting + sloped + plastic + held(2) +
                    Overrides{"Boundary conditions/top/Type=normal "
                              "displacement",
                              "Boundary conditions/top/Value=-0.3*t",
                              "Boundary conditions/top/Moves the grid=true",
                              "Boundary conditions/right/Type=free",
                              "Grid/Upper corner=2, 1",
                              "Grid/Cells=8, 4",
                              "Bodies/block/Point adaptation=split and merge"}),
    "pressed");
  check(scene_from<3>(block_scene("3D"), conducting + sloped + held(3)), "3D");
}


// Between two cylinders: T ~ ln r. Second order in the cell.
TEST(HeatMpi, SteadyRingInClosedForm)
{
  const auto steady = [](const unsigned int n, const std::string &method) {
    double     last = 0;
    const auto scene =
      scene_from<2>(block_scene("axisymmetric"),
                    conducting + held(2) +
                      Overrides{"Geometry/box/Lower corner=0.2, 0",
                                "Grid/Lower corner=0.2, 0",
                                "Grid/Cells=" + std::to_string(n) + ", 1",
                                "Grid/Method=" + method,
                                "Time/End time=1e4",
                                "Time/Time step=1e3",
                                "Materials/rubber/Initial temperature=300",
                                "Heat/left/Temperature=400",
                                "Heat/right/Temperature=300",
                                "Output/Probes=T",
                                "Output/T/Kind=mean",
                                "Output/T/Field=temperature"});
    last = run(scene, MPI_COMM_WORLD, path_of_run()).at("T").back();
    return last;
  };
  // of 300 + 100 ln(r) / ln(0.2) over 2 r dr / (1 - 0.04)
  const double l = std::log(0.2), a = 0.2;
  const double mean =
    300 + 100 / l * 2 / (1 - a * a) * (-0.25 - a * a * (0.5 * l - 0.25));
  for (const std::string method : {"MPM", "GIMP", "Lagrangian"})
    {
      SCOPED_TRACE(method);
      const double coarse = std::abs(steady(8, method) - mean),
                   fine   = std::abs(steady(16, method) - mean);
      EXPECT_LT(fine, 0.1);
      EXPECT_GT(std::log2(coarse / fine), 1.8);
    }
}


// A hill decays by exp(-2 pi^2 a t) between cold faces.
TEST(HeatMpi, OrdersInCellAndStep)
{
  const double pi = numbers::PI;
  const auto   at = [&](const unsigned int n, const unsigned int steps) {
    Overrides all =
      conducting + held(2) +
      Overrides{"Grid/Cells=" + std::to_string(n) + "," + std::to_string(n),
                "Materials/rubber/Initial temperature=300 + "
                  "100*sin(pi*x)*sin(pi*y)",
                "Time/Time step=" + std::to_string(1. / steps),
                "Output/Probes=T",
                "Output/T/Kind=mean",
                "Output/T/Field=temperature"};
    for (unsigned int f = 0; f < 4; ++f)
      all.push_back("Heat/" + face_names()[f] + "/Temperature=300");
    return run(scene_from<2>(block_scene("plane strain"), all),
               MPI_COMM_WORLD,
               path_of_run())
             .at("T")
             .back() -
           300;
  };
  const double exact = 100 * 4 / (pi * pi) * std::exp(-2 * pi * pi * 0.01);
  // steps that go by the square of the cell
  const double coarse = std::abs(at(16, 40) - exact),
               fine   = std::abs(at(32, 160) - exact);
  EXPECT_LT(fine, 1e-3 * exact);
  EXPECT_GT(std::log2(coarse / fine), 1.9);
}


// Heat does not know whether the body rests, but for what transfers cost, which
// is of second order in the cell.
TEST(HeatMpi, FlightIsRest)
{
  const auto at = [](const std::string &velocity,
                     const std::string &method,
                     const bool         fine) {
    return run(scene_from<2>(
                 block_scene("plane strain"),
                 conducting + with_inertia +
                   Overrides{
                     "Materials/rubber/Initial temperature=300 + "
                     "100*cos(pi*x)",
                     "Grid/Method=" + method,
                     "Grid/Upper corner=4, 2",
                     std::string("Grid/Cells=") + (fine ? "32, 16" : "16, 8"),
                     std::string("Time/Time step=") + (fine ? "0.02" : "0.04"),
                     "Bodies/block/Velocity=" + velocity,
                     "Output/Probes=T",
                     "Output/T/Kind=mean",
                     "Output/T/Field=temperature",
                     "Output/T/Where=if(x < 0.5, 1, -1)"}),
               MPI_COMM_WORLD,
               path_of_run())
      .at("T");
  };
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      double error[2];
      for (const bool fine : {false, true})
        {
          const auto rest   = at("0; 0", method, fine),
                     flight = at("2; 0.5", method, fine);
          EXPECT_GT(rest.front() - rest.back(), 5);
          error[fine] = std::abs(flight.back() - rest.back()) /
                        (rest.front() - rest.back());
        }
      EXPECT_LT(error[1], 0.02);
      EXPECT_GT(std::log2(error[0] / error[1]), 1.8);
    }
}


TEST(HeatMpi, OneRankIsAsMany)
{
  const auto scene = scene_from<2>(
    block_scene("axisymmetric"),
    conducting + sloped + plastic + held(2) +
      Overrides{"Grid/Method=GIMP",
                "Boundary conditions/top/Type=normal displacement",
                "Boundary conditions/top/Value=-0.1*t",
                "Boundary conditions/top/Moves the grid=true",
                "Boundary conditions/right/Type=free",
                "Grid/Upper corner=1.5, 1",
                "Grid/Cells=6, 4",
                "Materials/rubber/Thermal expansion=1e-4",
                "Materials/rubber/Stress-free temperature=300",
                "Heat/bottom/Temperature=300 + 50*t",
                "Heat/Source=3*x"});
  const auto many = run(scene, MPI_COMM_WORLD, path_of_run());
  const auto one =
    run(scene,
        MPI_COMM_SELF,
        path_of_run() + "_" +
          std::to_string(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)));
  expect_near(many, one);
  EXPECT_GT(many.at("heat_supplied").back(), 1);
}


// Source and faces give what the points have.
TEST(HeatMpi, WhatIsSuppliedIsThere)
{
  const auto columns =
    run(scene_from<2>(block_scene("plane strain"),
                      conducting + held(2) +
                        Overrides{"Heat/Source=3*x",
                                  "Heat/left/Temperature=300 + 50*t"}),
        MPI_COMM_WORLD,
        path_of_run());
  const auto &heat     = columns.at("heat"),
             &supplied = columns.at("heat_supplied");
  for (unsigned int row = 0; row < heat.size(); ++row)
    EXPECT_NEAR(heat[row], supplied[row], 1e-11 * supplied.back());
}


// What the stresses and the heat do is what the points have, to the second
// order in the step: what is left of `energy_gain` is lost by the method.
TEST(HeatMpi, WorkOfHeatIsNoGain)
{
  const auto gain = [](const std::string &step) {
    const auto columns =
      run(scene_from<2>(block_scene("plane strain"),
                        Overrides{"Grid/Method=Lagrangian",
                                  "Materials/rubber/Prescribed temperature="
                                  "300 + 10*sin(3*t)",
                                  "Materials/rubber/Thermal expansion=1e-3",
                                  "Boundary conditions/left/Type=fixed",
                                  "Time/Integrator=theta",
                                  "Time/Theta=0.5",
                                  "Time/End time=4",
                                  "Time/Time step=" + step}),
          MPI_COMM_WORLD,
          path_of_run());
    const auto  &work = columns.at("work_of_heat");
    const double most = *std::max_element(work.begin(), work.end());
    EXPECT_GT(most, 1e-6);
    double largest = 0;
    for (unsigned int row = 0; row < work.size(); ++row)
      {
        largest =
          std::max(largest,
                   std::abs(columns.at("strain_energy")[row] -
                            columns.at("internal_work")[row] - work[row]));
        EXPECT_LT(columns.at("energy_gain")[row], 1e-3 * most);
      }
    return largest / most;
  };
  const double coarse = gain("0.02"), fine = gain("0.01");
  EXPECT_LT(coarse, 1e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.7);
}
