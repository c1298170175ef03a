#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

// Bodies that meet by their surfaces, over many steps.
namespace
{
  std::string
  directory(const std::string &name)
  {
    const int id =
      Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
    return testing::TempDir() + "impm_contact_" + name + std::to_string(id);
  }

  template <int dim>
  Columns
  run_scene(const std::string &kind, const Overrides &overrides)
  {
    return run(scene_from<dim>(block_scene(kind), overrides),
               MPI_COMM_WORLD,
               directory(""));
  }

  double
  mean(const std::vector<double> &values,
       const double               from = 0,
       const double               to   = 1)
  {
    const auto begin = values.begin() + std::lround(from * values.size()),
               end   = values.begin() + std::lround(to * values.size());
    return std::accumulate(begin, end, 0.) / (end - begin);
  }

  const double g = 10, angle = 0.3; ///< of the incline

  /** A block of 1 x 0.5 slides down a rigid incline, along x. */
  template <int dim>
  Overrides
  incline(const std::string &friction, const std::string &stiffness)
  {
    const bool solid = dim == 3;
    const auto at    = [&](const std::string &plane, const std::string &z) {
      return solid ? plane + ", " + z : plane;
    };
    return Overrides{"Geometry/Shapes=box, ground",
                     "Geometry/box/Lower corner=" + at("0.5, 0.25", "0.25"),
                     "Geometry/box/Upper corner=" + at("1.5, 0.75", "0.75"),
                     "Geometry/ground/Lower corner=" + at("-10, -1", "-1"),
                     "Geometry/ground/Upper corner=" + at("20, 0.25", "2"),
                     "Grid/Method=GIMP",
                     "Grid/Upper corner=" + at("4, 1", "1"),
                     "Grid/Cells=" + at("16, 4", "4"),
                     "Materials/rubber/Law=neo-Hookean",
                     "Materials/rubber/Density=1000",
                     "Materials/rubber/Young's modulus=" + stiffness,
                     "Bodies/Names=block, tool",
                     "Bodies/tool/Kind=rigid",
                     "Bodies/tool/Contact=surface",
                     "Bodies/tool/Shape=ground",
                     "Contact/Pairs=foot",
                     "Contact/foot/Bodies=block, tool",
                     "Loads/Body force=" + std::to_string(g * std::sin(angle)) +
                       "; " + std::to_string(-g * std::cos(angle)) +
                       (solid ? "; 0" : ""),
                     "Time/Integrator=Newmark",
                     "Time/Time step=0.01",
                     "Solver/Newton tolerance=1e-9",
                     "Output/Probes=way",
                     "Output/way/Kind=mean",
                     "Output/way/Field=displacement",
                     "Output/way/Component=0",
                     "Output/Reactions=fx, fy",
                     "Output/fx/On=tool",
                     "Output/fx/Direction=" + at("1, 0", "0"),
                     "Output/fy/On=tool",
                     "Output/fy/Direction=" + at("0, 1", "0")} +
           (friction.empty() ?
              Overrides{"Contact/foot/Kind=frictionless"} :
              Overrides{"Contact/foot/Kind=Coulomb",
                        "Contact/foot/Friction coefficient=" + friction});
  }

  constexpr double mass = 500; ///< of the block, for each metre of thickness

  double
  way_down(const double friction, const double time)
  {
    return g * (std::sin(angle) - friction * std::cos(angle)) * time * time / 2;
  }
} // namespace


TEST(ContactRuns, ABlockSlidesWithoutFriction)
{
  for (const std::string method : {"GIMP", "MPM"})
    {
      const auto columns = run_scene<2>("plane strain",
                                        incline<2>("", "1e6") +
                                          Overrides{"Grid/Method=" + method});
      EXPECT_NEAR(columns.at("way").back() / way_down(0, 1), 1, 1e-3);
      for (const double force : columns.at("fx"))
        EXPECT_NEAR(force, 0, 1e-9 * mass * g);
      // It hops a little.
      EXPECT_NEAR(mean(columns.at("fy")) / (-mass * g * std::cos(angle)),
                  1,
                  0.01);
    }
}


// Springs, which hold it until it touches, take none of the load.
TEST(ContactRunsMpi, WhatContactAloneHolds)
{
  const auto columns = run_scene<2>("plane strain",
                                    incline<2>("", "1e6") +
                                      Overrides{"Time/Integrator=quasi-static",
                                                "Time/Time step=0.5",
                                                "Loads/Body force=0; 0",
                                                "Loads/Tractions=press",
                                                "Loads/press/Body=block",
                                                "Loads/press/Kind=pressure",
                                                "Loads/press/Where=y - 0.74",
                                                "Loads/press/Value=1000*t"});
  EXPECT_GT(columns.at("held_cells").back(), 0);
  EXPECT_NEAR(columns.at("fy").back(), -1000, 3);
}


TEST(ContactRuns, ABlockSlidesAgainstFriction)
{
  const auto check = [](const auto &columns, const double end, const double m) {
    EXPECT_NEAR(columns.at("way").back() / way_down(0.1, end), 1, 0.01);
    const auto &normal   = columns.at("foot_normal_force");
    const auto &friction = columns.at("foot_friction_force");
    // It hops a little, and that does not cancel in a short time.
    EXPECT_NEAR(mean(normal) / (m * g * std::cos(angle)), 1, 0.05);
    for (unsigned int i = 0; i < normal.size(); ++i)
      {
        EXPECT_NEAR(columns.at("fy")[i], -normal[i], 1e-9 * m * g);
        // in space also across, where the block swells
        EXPECT_NEAR(columns.at("fx")[i],
                    friction[i],
                    1e-3 * friction[i] + 1e-9);
        // Not from the first moment on: it has to slip for that.
        if (i > 5)
          EXPECT_NEAR(friction[i], 0.1 * normal[i], 1e-4 * m * g);
      }
  };
  check(run_scene<2>("plane strain", incline<2>("0.1", "1e8")), 1, mass);
  check(run_scene<3>("3D",
                     incline<3>("0.1", "1e8") +
                       Overrides{"Time/End time=0.15"}),
        0.15,
        mass / 2);
}


// At which the body stands from the start, or to which it comes. As long as it
// presses, its surface is a little way through the face.
TEST(ContactRuns, AFaceIsLikeARigidBody)
{
  // Boxes are cut by the face, but reach a little into a rigid body.
  for (const std::string method : {"MPM", "GIMP"})
    for (const std::string height : {"0.25", "0.125"})
      {
        const std::string friction = height == "0.25" ? "0.1" : "";
        const auto        block =
          incline<2>(friction, "1e6") +
          Overrides{"Time/End time=0.3", "Grid/Method=" + method};
        const auto ground = run_scene<2>(
          "plane strain",
          block + Overrides{"Geometry/ground/Upper corner=20, " + height,
                            "Grid/Lower corner=0, -0.25",
                            "Grid/Cells=16, " +
                              std::string(height == "0.25" ? "5" : "10")});
        auto on_face = block;
        // Without the rigid body.
        on_face.erase(std::remove_if(on_face.begin(),
                                     on_face.end(),
                                     [](const auto &override) {
                                       return override.find("tool") !=
                                              std::string::npos;
                                     }),
                      on_face.end());
        const auto face = run_scene<2>(
          "plane strain",
          on_face + Overrides{"Grid/Lower corner=0, " + height,
                              "Grid/Cells=16, " +
                                std::string(height == "0.25" ? "3" : "7"),
                              "Contact/foot/Bodies=block, bottom",
                              // No matter for a body that has let it go.
                              std::string("Boundary conditions/bottom/Type=") +
                                (method == "MPM" ? "free" : "slip"),
                              "Output/fx/On=bottom",
                              "Output/fy/On=bottom"});
        for (const std::string name : {"way",
                                       "fx",
                                       "fy",
                                       "foot_normal_force",
                                       "foot_area",
                                       "strain_energy"})
          {
            ASSERT_EQ(face.at(name).size(), 30u);
            const auto &expected = ground.at(name);
            double      largest  = 1e-9;
            for (const double value : expected)
              largest = std::max(largest, std::abs(value));
            for (unsigned int i = 0; i < 30; ++i)
              EXPECT_NEAR(face.at(name)[i], expected[i], 0.02 * largest)
                << name << ", step " << i;
          }
        const auto &force = face.at("foot_normal_force");
        EXPECT_GT(*std::max_element(force.begin(), force.end()), mass * g / 2);
      }
}


// The slab is as high as two cells: the boxes of the block reach into the upper
// one, whose nodes the bottom must not hold.
TEST(ContactRuns, ABlockSlidesOnAnother)
{
  for (const double friction : {0., 0.1})
    {
      auto overrides = incline<2>(friction > 0 ? "0.1" : "", "1e6");
      overrides.erase(std::remove_if(overrides.begin(),
                                     overrides.end(),
                                     [](const auto &override) {
                                       return override.find("tool") !=
                                                std::string::npos ||
                                              override.find("Output/") == 0;
                                     }),
                      overrides.end());
      const auto columns =
        run_scene<2>("plane strain",
                     overrides +
                       Overrides{"Geometry/ground/Lower corner=0, 0",
                                 "Geometry/ground/Upper corner=4, 0.25",
                                 "Grid/Cells=32, 8",
                                 "Bodies/Names=block, slab",
                                 "Bodies/slab/Shape=ground",
                                 "Bodies/slab/Material=rubber",
                                 "Contact/foot/Bodies=block, slab",
                                 "Boundary conditions/bottom/Type=fixed",
                                 "Time/End time=0.5",
                                 "Output/Probes=way",
                                 "Output/way/Kind=mean",
                                 "Output/way/Field=displacement",
                                 "Output/way/Component=0",
                                 "Output/way/Bodies=block"});
      const auto &normal = columns.at("foot_normal_force"),
                 &along  = columns.at("foot_friction_force");
      const double way   = columns.at("way").back() / way_down(friction, 0.5);
      EXPECT_NEAR(way, 1, friction > 0 ? 0.03 : 1e-3);
      EXPECT_NEAR(mean(normal) / (mass * g * std::cos(angle)), 1, 0.05);
      for (unsigned int i = 5; i < normal.size(); ++i)
        EXPECT_NEAR(along[i], friction * normal[i], 1e-3 * mass * g) << i;
    }
}


// It shakes, since nothing damps it, but does not go down.
TEST(ContactRuns, ABlockSticks)
{
  const auto  columns = run_scene<2>("plane strain", incline<2>("0.5", "1e6"));
  const auto &way     = columns.at("way");
  EXPECT_GT(mean(way, 0.25, 0.5), 0);
  EXPECT_LT(mean(way), 0.003);
  EXPECT_NEAR(mean(way, 0.75, 1), mean(way, 0.25, 0.5), 1e-4);
  for (unsigned int i = 0; i < way.size(); ++i)
    EXPECT_LT(columns.at("foot_friction_force")[i],
              0.5 * columns.at("foot_normal_force")[i] + 1e-3 * mass * g);
}


namespace
{
  /** A column under a plate, or a face, that comes down, first by a gap. */
  template <int dim>
  void
  check_press(const std::string &kind,
              const std::string &method,
              const bool         is_face)
  {
    SCOPED_TRACE(kind + ", " + method + (is_face ? ", face" : ""));
    const bool solid = dim == 3;
    const auto at    = [&](const std::string &plane, const std::string &z) {
      return solid ? plane + ", " + z : plane;
    };
    const Overrides plate = {
      "Geometry/Shapes=box, plate",
      "Geometry/plate/Lower corner=" + at("-1, 1.0001", "-1"),
      "Geometry/plate/Upper corner=" + at("2, 3", "2"),
      "Grid/Upper corner=" + at("1.25, 1.25", "1.25"),
      "Grid/Cells=" + at("5, 5", "5"),
      "Bodies/Names=block, tool",
      "Bodies/tool/Kind=rigid",
      "Bodies/tool/Contact=surface",
      "Bodies/tool/Shape=plate",
      std::string("Bodies/tool/Displacement=0; -0.0003*t") +
        (solid ? "; 0" : ""),
      "Contact/lid/Bodies=tool, block",
      "Output/load/On=tool"};
    const Overrides face = {"Grid/Upper corner=" + at("1.25, 1.0001", "1.25"),
                            "Grid/Cells=" + at("5, 4", "5"),
                            "Boundary conditions/top/Type=normal displacement",
                            "Boundary conditions/top/Value=-0.0003*t",
                            "Boundary conditions/top/Moves the grid=true",
                            "Contact/lid/Bodies=top, block",
                            "Output/load/On=top"};
    const auto      columns =
      run_scene<dim>(kind,
                     (is_face ? face : plate) +
                       Overrides{"Grid/Method=" + method,
                                 "Materials/rubber/Law=linear elastic",
                                 "Materials/rubber/Poisson's ratio=0",
                                 "Contact/Pairs=lid",
                                 "Contact/lid/Kind=frictionless",
                                 "Boundary conditions/bottom/Type=slip",
                                 "Boundary conditions/left/Type=slip",
                                 "Time/Time step=0.25",
                                 "Output/Reactions=load",
                                 "Output/load/Direction=" + at("0, 1", "0")} +
                       (solid ?
                          Overrides{"Boundary conditions/back/Type=slip"} :
                          Overrides{}));
    const double area  = kind == "axisymmetric" ? numbers::PI : 1;
    const double layer = ContactSpec().thickness * 0.25;
    const auto  &load  = columns.at("load");
    ASSERT_EQ(load.size(), 4u);
    for (unsigned int i = 0; i < 4; ++i)
      {
        const double closed = std::max(0., 0.000075 * (i + 1) - 0.0001);
        EXPECT_NEAR(load[i], area * closed / (1 + layer), 1e-3 * area * closed);
        EXPECT_NEAR(columns.at("lid_normal_force")[i], load[i], 1e-12);
      }
    EXPECT_EQ(load[0], 0);
    EXPECT_NEAR(columns.at("lid_area").back(), area, 1e-9);
  }
} // namespace


TEST(ContactRuns, APlatePressesAColumn)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      for (const bool is_face : {false, true})
        {
          check_press<2>("plane strain", method, is_face);
          check_press<2>("axisymmetric", method, is_face);
          check_press<3>("3D", method, is_face);
        }
    }
}


namespace
{
  /** A rod of length 1 hits another one that is at rest, after 0.2. */
  const Overrides rods = {"Geometry/Shapes=box, other",
                          "Geometry/box/Lower corner=0.5, 0",
                          "Geometry/box/Upper corner=1.5, 0.05",
                          "Geometry/other/Lower corner=1.502, 0",
                          "Geometry/other/Upper corner=2.502, 0.05",
                          "Grid/Method=GIMP",
                          "Grid/Upper corner=4, 0.05",
                          "Grid/Cells=160, 2",
                          "Materials/rubber/Law=neo-Hookean",
                          "Materials/rubber/Poisson's ratio=0",
                          "Bodies/Names=block, second",
                          "Bodies/block/Velocity=0.01; 0",
                          "Bodies/second/Shape=other",
                          "Bodies/second/Material=rubber",
                          "Contact/Pairs=ends",
                          "Contact/ends/Bodies=block, second",
                          "Contact/ends/Kind=frictionless",
                          "Boundary conditions/top/Type=slip",
                          "Boundary conditions/bottom/Type=slip",
                          "Time/Integrator=Newmark",
                          "Time/End time=2.5",
                          "Time/Time step=0.0125",
                          "Solver/Newton tolerance=1e-9",
                          "Output/Probes=a, b",
                          "Output/a/Kind=mean",
                          "Output/a/Field=velocity",
                          "Output/a/Bodies=block",
                          "Output/b/Kind=mean",
                          "Output/b/Field=velocity",
                          "Output/b/Bodies=second"};
} // namespace


// A wave goes to the end of each rod and back, and then they part.
TEST(ContactRuns, TwoRodsExchangeTheirVelocities)
{
  const auto  columns = run_scene<2>("plane strain", rods);
  const auto &force   = columns.at("ends_normal_force");
  const auto &time    = columns.at("time");
  EXPECT_NEAR(columns.at("a").back(), 0, 0.03 * 0.01);
  EXPECT_NEAR(columns.at("b").back(), 0.01, 0.03 * 0.01);
  double impulse = 0, begin = 0, end = 0;
  for (unsigned int i = 0; i < time.size(); ++i)
    {
      impulse += 0.0125 * force[i];
      // of the plateau: rho c v / 2
      if (force[i] > 0.5 * 0.05 * 0.005)
        {
          begin = begin > 0 ? begin : time[i];
          end   = time[i];
        }
      EXPECT_NEAR(columns.at("momentum_x")[i], 0.0005, 1e-9);
    }
  EXPECT_NEAR(begin, 0.2, 0.1);
  EXPECT_NEAR(end, 2.2, 0.1);
  EXPECT_NEAR(impulse, 0.0005, 0.03 * 0.0005);
  EXPECT_EQ(force.back(), 0);
}


// It flies on with twice the velocity of the heavy one, in steps that its waves
// cross forty times.
TEST(ContactRuns, ALightRodIsStruck)
{
  for (const std::string integrator : {"Newmark", "energy-momentum"})
    {
      const auto columns =
        run_scene<2>("plane strain",
                     rods + Overrides{"Materials/Names=rubber, foam",
                                      "Materials/foam/Law=neo-Hookean",
                                      "Materials/foam/Density=1e-6",
                                      "Materials/foam/Young's modulus=1",
                                      "Materials/foam/Poisson's ratio=0",
                                      "Bodies/second/Material=foam",
                                      "Time/Integrator=" + integrator,
                                      "Time/End time=1"});
      EXPECT_NEAR(columns.at("a").back(), 0.01, 1e-6);
      EXPECT_NEAR(columns.at("b").back(), 0.02, 0.02 * 0.02);
    }
}


// Steps are longer than it takes to fall back.
TEST(ContactRuns, AStiffBlockThatFallsKeepsItsEnergy)
{
  for (const std::string integrator : {"Newmark", "energy-momentum"})
    {
      const auto columns =
        run_scene<2>("plane strain",
                     incline<2>("0.1", "1e8") +
                       Overrides{"Geometry/box/Lower corner=0.5, 0.3",
                                 "Geometry/box/Upper corner=1.5, 0.8",
                                 "Time/Time step=0.05",
                                 "Time/Integrator=" + integrator});
      const double fastest = std::sqrt(2 * g * std::cos(angle) * 0.05);
      for (const double momentum : columns.at("momentum_y"))
        EXPECT_LT(std::abs(momentum), 1.001 * mass * fastest);
      EXPECT_LT(columns.at("energy_gain").back(), 0);
    }
}


namespace
{
  /** A block lies on a drum that turns under it, between smooth walls. */
  const Overrides drum = {"Geometry/Shapes=box, ball",
                          "Geometry/box/Lower corner=0, 0.5",
                          "Geometry/box/Upper corner=1, 1",
                          "Geometry/ball/Kind=ball",
                          "Geometry/ball/Centre=0.5, 0",
                          "Geometry/ball/Radius=0.5",
                          "Grid/Lower corner=0, 0.25",
                          "Grid/Upper corner=1, 1.25",
                          "Grid/Cells=16, 16",
                          "Grid/Method=GIMP",
                          "Materials/rubber/Law=neo-Hookean",
                          "Materials/rubber/Density=1000",
                          "Materials/rubber/Young's modulus=1e6",
                          "Bodies/Names=block, tool",
                          "Bodies/tool/Kind=rigid",
                          "Bodies/tool/Contact=surface",
                          "Bodies/tool/Shape=ball",
                          "Bodies/tool/Rotation=0.5*t",
                          "Bodies/tool/Centre=0.5, 0",
                          "Contact/Pairs=foot",
                          "Contact/foot/Bodies=block, tool",
                          "Contact/foot/Kind=Coulomb",
                          "Contact/foot/Friction coefficient=0.2",
                          "Boundary conditions/left/Type=slip",
                          "Boundary conditions/right/Type=slip",
                          "Loads/Body force=0; -10",
                          "Time/Integrator=theta",
                          "Time/Theta=1",
                          "Time/Time step=0.05",
                          "Solver/Newton tolerance=1e-9",
                          "Output/Probes=turn",
                          "Output/turn/Kind=motion",
                          "Output/turn/Of=tool",
                          "Output/turn/Quantity=rotation",
                          "Output/Reactions=fx, fy, moment",
                          "Output/fx/On=tool",
                          "Output/fx/Direction=1, 0",
                          "Output/fy/On=tool",
                          "Output/fy/Direction=0, 1",
                          "Output/moment/On=tool",
                          "Output/moment/Kind=moment",
                          "Output/moment/About=0.5, 0"};
} // namespace


// What turns it is worn away by friction.
TEST(ContactRuns, ADrumTurnsUnderABlock)
{
  const auto  columns = run_scene<2>("plane strain", drum);
  const auto &time = columns.at("time"), &work = columns.at("external_work"),
             &taken = columns.at("contact_work"), &turn = columns.at("turn");
  for (unsigned int i = time.size() / 2; i < time.size(); ++i)
    {
      EXPECT_NEAR(columns.at("fy")[i] / -5000, 1, 1e-3);
      EXPECT_NEAR(columns.at("moment")[i] / (-0.2 * 5000 * 0.5), 1, 2e-3);
      EXPECT_NEAR(turn[i], 0.5 * time[i], 1e-12);
      const double angle = turn[i] - turn[i - 1];
      EXPECT_NEAR((work[i] - work[i - 1]) / (500 * angle), 1, 2e-3);
      EXPECT_NEAR((taken[i] - taken[i - 1]) / (500 * angle), 1, 2e-3);
    }
}


namespace
{
  /** A rigid disc that spins flies past the middle of a block and hits it. */
  const Overrides flying_disc = {"Geometry/Shapes=box, ball",
                                 "Geometry/box/Lower corner=0.8, 0.5",
                                 "Geometry/box/Upper corner=1.4, 1.5",
                                 "Geometry/ball/Kind=ball",
                                 "Geometry/ball/Centre=0.5, 1.2",
                                 "Geometry/ball/Radius=0.25",
                                 "Grid/Upper corner=2, 2",
                                 "Grid/Cells=16, 16",
                                 "Grid/Method=GIMP",
                                 "Materials/rubber/Law=neo-Hookean",
                                 "Materials/rubber/Density=1",
                                 "Materials/rubber/Young's modulus=10",
                                 "Bodies/Names=block, tool",
                                 "Bodies/tool/Kind=rigid",
                                 "Bodies/tool/Contact=surface",
                                 "Bodies/tool/Shape=ball",
                                 "Bodies/tool/Motion=free",
                                 "Bodies/tool/Density=2",
                                 "Bodies/tool/Velocity=0.2, 0.05",
                                 "Bodies/tool/Angular velocity=0.5",
                                 "Contact/Pairs=foot",
                                 "Contact/foot/Bodies=block, tool",
                                 "Contact/foot/Kind=Coulomb",
                                 "Contact/foot/Friction coefficient=0.3",
                                 "Time/Integrator=Newmark",
                                 "Time/Time step=0.02",
                                 "Time/End time=1.2",
                                 "Solver/Newton tolerance=1e-10",
                                 "Output/Probes=fx, vy, turn, spin",
                                 "Output/fx/Kind=motion",
                                 "Output/fx/Of=tool",
                                 "Output/vy/Kind=motion",
                                 "Output/vy/Of=tool",
                                 "Output/vy/Quantity=velocity",
                                 "Output/vy/Component=1",
                                 "Output/turn/Kind=motion",
                                 "Output/turn/Of=tool",
                                 "Output/turn/Quantity=rotation",
                                 "Output/spin/Kind=motion",
                                 "Output/spin/Of=tool",
                                 "Output/spin/Quantity=angular velocity"};
} // namespace


// It flies freely, hits, and flies off; nothing is lost to the other. What is
// lost of angular momentum goes with lumped masses of the grid, with the square
// of its cells.
TEST(ContactRuns, AFreeDiscHitsABlock)
{
  const double        mass = 2 * numbers::PI / 16;
  std::vector<double> lost;
  for (const std::string cells : {"16, 16", "32, 32"})
    {
      const auto columns =
        run_scene<2>("plane strain",
                     flying_disc + Overrides{"Grid/Cells=" + cells});
      const auto &x = columns.at("momentum_x"), &y = columns.at("momentum_y"),
                 &moment = columns.at("angular_momentum_z"),
                 &energy = columns.at("total_energy"),
                 &force  = columns.at("foot_normal_force"),
                 &spin   = columns.at("spin");
      EXPECT_GT(*std::max_element(force.begin(), force.end()), 0.1);
      EXPECT_EQ(force.back(), 0);
      EXPECT_EQ(force.front(), 0);
      EXPECT_NEAR(moment.front() /
                    (mass * (0.5 * 0.05 - 1.2 * 0.2 + 0.5 * 0.25 * 0.25 / 2)),
                  1,
                  1e-4);
      lost.push_back(std::abs(moment.back() / moment.front() - 1));
      for (unsigned int i = 0; i < x.size(); ++i)
        {
          EXPECT_NEAR(x[i], mass * 0.2, 1e-4 * mass);
          EXPECT_NEAR(x[i], x[0], 1e-8 * x[0]);
          EXPECT_NEAR(y[i], y[0], 1e-8 * x[0]);
          EXPECT_LT(energy[i], 1.001 * energy[0]);
        }
      EXPECT_GT(energy.back(), 0.7 * energy[0]);
      EXPECT_NEAR(spin.front(), 0.5, 1e-12);
      EXPECT_GT(std::abs(spin.back() - 0.5), 0.05);
      EXPECT_EQ(spin.back(), spin[spin.size() - 2]);
    }
  EXPECT_LT(lost[0], 0.02);
  EXPECT_LT(lost[1], 0.4 * lost[0]);
}


// Falls through nothing, by the body force.
TEST(ContactRuns, AFreeBodyFalls)
{
  const auto columns =
    run_scene<2>("plane strain",
                 flying_disc + Overrides{"Loads/Body force=-1 - 6*t; -2",
                                         "Time/End time=0.2"});
  const double t = 0.2;
  EXPECT_NEAR(columns.at("fx").back(),
              0.2 * t - t * t / 2 - t * t * t,
              0.02 * 0.02 * t);
  EXPECT_NEAR(columns.at("vy").back(), 0.05 - 2 * t, 1e-12);
  EXPECT_NEAR(columns.at("turn").back(), 0.5 * t, 1e-12);
  EXPECT_NEAR(columns.at("energy_gain").back(), 0, 1e-4);
}


namespace
{
  /** A box with three different inertias, that turns and meets nothing yet. */
  Overrides
  tumbling(const unsigned int n_steps)
  {
    return {"Geometry/Shapes=box, brick",
            "Geometry/box/Upper corner=0.5, 1, 1",
            "Geometry/brick/Lower corner=2, 0, 0",
            "Geometry/brick/Upper corner=2.1, 0.2, 0.3",
            "Bodies/Names=block, tool",
            "Bodies/tool/Kind=rigid",
            "Bodies/tool/Contact=surface",
            "Bodies/tool/Shape=brick",
            "Bodies/tool/Motion=free",
            "Bodies/tool/Density=100",
            "Bodies/tool/Angular velocity=0.3, 2, 0.1",
            "Contact/Pairs=foot",
            "Contact/foot/Bodies=block, tool",
            "Contact/foot/Kind=frictionless",
            "Time/Integrator=Newmark",
            "Time/End time=1",
            "Time/Time step=" + std::to_string(1. / n_steps)};
  }
} // namespace


// In space the angular momentum turns with the axes of the body, to second
// order.
TEST(ContactRuns, ABrickTumbles)
{
  std::vector<double> errors;
  for (const unsigned int n : {20, 40})
    {
      const auto columns = run_scene<3>("3D", tumbling(n));
      double     error   = 0;
      for (const std::string direction : {"x", "y", "z"})
        {
          const auto &moment = columns.at("angular_momentum_" + direction);
          EXPECT_GT(std::abs(moment.front()), 1e-4);
          error = std::max(error, std::abs(moment.back() - moment.front()));
        }
      EXPECT_LT(error, 1e-3 * columns.at("angular_momentum_y")[0]);
      errors.push_back(error);
      EXPECT_NEAR(columns.at("kinetic_energy").back() /
                    columns.at("kinetic_energy")[0],
                  1,
                  1e-3);
    }
  EXPECT_GT(errors[0] / errors[1], 3.5);
}


// The grid is fine where the rigid body is near.
TEST(ContactRuns, OnAGridThatAdapts)
{
  const auto columns =
    run_scene<2>("plane strain",
                 incline<2>("0.1", "1e7") +
                   Overrides{"Grid/Adaptation/Criteria=ground",
                             "Grid/Adaptation/ground/Kind=distance",
                             "Grid/Adaptation/ground/Of=tool",
                             "Grid/Adaptation/ground/Distance=0.1",
                             "Grid/Adaptation/ground/Level=1",
                             "Grid/Adaptation/Highest level=1"});
  EXPECT_NEAR(columns.at("way").back() / way_down(0.1, 1), 1, 0.01);
  const auto coarse =
    run_scene<2>("plane strain",
                 incline<2>("0.1", "1e7") + Overrides{"Time/End time=0.01"});
  EXPECT_GT(*std::min_element(columns.at("dofs").begin(),
                              columns.at("dofs").end()),
            1.3 * coarse.at("dofs")[0]);
}


namespace
{
  /** The same on the first ranks as on the first alone. */
  template <int dim>
  void
  compare(const std::string &kind, const Overrides &overrides)
  {
    const auto         scene = scene_from<dim>(block_scene(kind), overrides);
    const unsigned int rank  = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    Columns            alone;
    for (const unsigned int n : {1, 2, 3})
      {
        if (n > Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD))
          break;
        SCOPED_TRACE(n);
        MPI_Comm communicator;
        MPI_Comm_split(MPI_COMM_WORLD,
                       rank < n ? 0 : MPI_UNDEFINED,
                       rank,
                       &communicator);
        const auto name = directory(std::to_string(n));
        if (rank < n)
          {
            Simulation<dim>(scene, CommandLine::Verbosity::quiet, communicator)
              .run(name, "test", "");
            MPI_Comm_free(&communicator);
          }
        MPI_Barrier(MPI_COMM_WORLD);
        const auto columns = read_history(name);
        if (n == 1)
          alone = columns;
        else
          expect_near(alone, columns);
        MPI_Barrier(MPI_COMM_WORLD);
        std::error_code ignored;
        std::filesystem::remove_all(name, ignored);
        MPI_Barrier(MPI_COMM_WORLD);
      }
  }

  const Overrides meet_soon = {"Geometry/other/Lower corner=1.5005, 0",
                               "Geometry/other/Upper corner=2.5005, 0.05",
                               "Time/End time=0.25"};
} // namespace


TEST(ContactRunsMpi, OnAnyNumberOfRanks)
{
  compare<2>("plane strain",
             incline<2>("0.1", "1e6") + Overrides{"Time/End time=0.2"});
  compare<2>("plane strain", rods + meet_soon);
  compare<2>("plane strain", drum + Overrides{"Time/End time=0.3"});
  compare<2>("plane strain", flying_disc + Overrides{"Time/End time=0.6"});
}


namespace
{
  /** A run of so many steps, then to the end, as one. */
  void
  expect_restart(const Overrides &overrides)
  {
    const auto run_to = [&](const unsigned int n_steps,
                            const std::string &name,
                            const bool         restart) {
      Simulation<2>(
        scene_from<2>(block_scene("plane strain"),
                      overrides +
                        Overrides{"Output/Checkpoints/Interval in steps=5",
                                  "Time/Largest number of steps=" +
                                    std::to_string(n_steps)}),
        CommandLine::Verbosity::quiet,
        MPI_COMM_WORLD)
        .run(name, "test", "", {}, restart);
      MPI_Barrier(MPI_COMM_WORLD);
      return read_history(name);
    };
    const auto clear = [](const std::string &name) {
      MPI_Barrier(MPI_COMM_WORLD);
      std::error_code ignored;
      std::filesystem::remove_all(name, ignored);
      MPI_Barrier(MPI_COMM_WORLD);
    };
    const auto whole = run_to(20, directory("whole"), false);
    // in contact, and in friction if there is any
    EXPECT_GT(whole.at(whole.count("fx") > 0 ? "foot_normal_force" :
                                               "ends_normal_force")[9],
              0);
    run_to(10, directory("parts"), false);
    const auto parts = run_to(20, directory("parts"), true);
    EXPECT_EQ(whole.at("step").size(), 20u);
    for (const auto &[name, values] : whole)
      if (name != "wall_seconds")
        {
          EXPECT_EQ(parts.at(name), values) << name;
        }
    clear(directory("whole"));
    clear(directory("parts"));
  }
} // namespace


TEST(ContactRunsMpi, RestartInContact)
{
  expect_restart(incline<2>("0.1", "1e6"));
  expect_restart(incline<2>("0.5", "1e6"));
  expect_restart(drum);
  expect_restart(flying_disc + Overrides{"Geometry/ball/Centre=0.53, 1.2"});
  expect_restart(rods + meet_soon);
}
