#include <impm/base/exceptions.h>
#include <impm/run/simulation.h>

#include <gtest/gtest.h>

#include "expect_blame.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const std::string plane = block_scene("plane strain");

  const Overrides second_body = {"Geometry/Shapes=box, other",
                                 "Geometry/other/Lower corner=0.4, 0.4",
                                 "Geometry/other/Upper corner=0.9, 0.9",
                                 "Bodies/Names=block, second",
                                 "Bodies/second/Shape=other",
                                 "Bodies/second/Material=rubber"};

  // Building a simulation must fail, and blame an entry.
  void
  expect_blame(const Overrides                &overrides,
               const std::string              &entry,
               const std::vector<std::string> &words)
  {
    impm::expect_blame(plane, overrides, entry, words);
  }
} // namespace


TEST(SceneMpi, BodiesThatDoNotFit)
{
  // all of the second lies in the first
  expect_blame(second_body,
               "Bodies/block/Shape",
               {"overlap", "'block'", "'second'"});
  // slivers that miss every point
  expect_blame({"Geometry/box/Upper corner=0.001, 1"},
               "Bodies/block/Shape",
               {"no points"});
  expect_blame({"Geometry/box/Upper corner=1.5, 1"},
               "Bodies/block/Shape",
               {"1.5", "allowed"});
}


// The overlap is seen whichever body has points in it.
TEST(SceneMpi, ARigidBodyThatOverlaps)
{
  expect_blame({"Geometry/Shapes=box, other",
                "Geometry/other/Lower corner=0.4, 0.4",
                "Geometry/other/Upper corner=0.9, 0.9",
                "Bodies/Names=block, tool",
                "Bodies/tool/Kind=rigid",
                "Bodies/tool/Shape=other"},
               "Bodies/block/Shape",
               {"overlap"});
}


// A slip holds the component along the axis, whatever the map makes of the
// face.
TEST(SceneMpi, SlipOnAFaceThatTheMapTilts)
{
  const auto on = [](const std::string &face, const std::string &type) {
    const std::string path      = "Boundary conditions/" + face + "/";
    Overrides         overrides = {"Grid/Method=Lagrangian",
                                   "Grid/Map=x + 0.3*y; y*(1 + 0.2*x)",
                                   "Geometry/box/Lower corner=-9, -9",
                                   "Geometry/box/Upper corner=9, 9",
                                   path + "Type=" + type};
    if (type.rfind("normal", 0) == 0)
      overrides.push_back(path + "Value=0.1*t");
    return overrides;
  };
  for (const std::string type :
       {"slip", "normal displacement", "normal velocity"})
    {
      for (const std::string face : {"left", "right", "top"})
        expect_blame(on(face, type),
                     "Boundary conditions/" + face + "/Type",
                     {"'" + type + "'", "Map", "allowed", "displacement"});
      EXPECT_NO_THROW(scene_from<2>(plane, on("bottom", type)));
    }
  EXPECT_NO_THROW(scene_from<2>(plane, on("left", "fixed")));
  // a face that bulges between its corners, one that has turned
  expect_blame(on("left", "slip") +
                 Overrides{"Grid/Map=x + 0.1*(1 - x)*y*(1 - y); y"},
               "Boundary conditions/left/Type",
               {"'slip'"});
  expect_blame(on("left", "slip") + Overrides{"Grid/Map=1 - y; x"},
               "Boundary conditions/left/Type",
               {"'slip'"});
  const Overrides solid = {"Grid/Method=Lagrangian",
                           "Grid/Map=x; y; z + 0.1*x*(1 - z)",
                           "Boundary conditions/left/Type=slip",
                           "Boundary conditions/front/Type=slip"};
  EXPECT_NO_THROW(scene_from<3>(block_scene("3D"), solid));
  EXPECT_THROW(scene_from<3>(block_scene("3D"),
                             solid +
                               Overrides{"Boundary conditions/back/Type=slip"}),
               InputError);
}


// 1/r of such a point is not a number.
TEST(SceneMpi, APointOnTheAxis)
{
  std::string       text  = block_scene("axisymmetric");
  const std::string shape = "    set Shape    = box\n";
  text.erase(text.find(shape), shape.size());
  const TemporaryFile cloud("x,y,volume\n0.3,0.3,0.04\n0,0.4,0.09\n", ".csv");
  const Overrides     from_file = {"Bodies/block/Points from=file",
                                   "Bodies/block/File=" + cloud.name};
  for (const std::string method : {"MPM", "GIMP"})
    try
      {
        const auto scene =
          scene_from<2>(text, from_file + Overrides{"Grid/Method=" + method});
        const Simulation<2> simulation(scene,
                                       CommandLine::Verbosity::quiet,
                                       MPI_COMM_WORLD);
        ADD_FAILURE() << "is taken";
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        EXPECT_EQ(error.entry, "Bodies/block/File");
        EXPECT_NE(message.find("point 2 of"), std::string::npos) << message;
        EXPECT_NE(message.find("axis"), std::string::npos) << message;
      }
}


TEST(Scene, UnknownNames)
{
  expect_blame({"Bodies/block/Shape=bocks"},
               "Bodies/block/Shape",
               {"'bocks'", "allowed", "box"});
  expect_blame({"Bodies/block/Material=steel"},
               "Bodies/block/Material",
               {"'steel'", "rubber"});
  expect_blame({"Output/Reactions=load",
                "Output/load/On=top",
                "Output/load/Direction=0, 1"},
               "Output/load/On",
               {"'top'", "none"});
  expect_blame({"Output/Probes=p",
                "Output/p/Position=0, 0",
                "Output/p/Field=temperature"},
               "Output/p/Field",
               {"'temperature'"});
  expect_blame({"Output/Probes=p",
                "Output/p/Kind=mean",
                "Output/p/Field=von_mises_stress",
                "Output/p/Bodies=rock"},
               "Output/p/Bodies",
               {"'rock'", "block"});
  expect_blame({"Output/Probes=p", "Output/p/Kind=motion", "Output/p/Of=top"},
               "Output/p/Of",
               {"'top'"});
  expect_blame({"Bodies/Names=block, block"},
               "Bodies/Names",
               {"'block'", "taken"});
}


TEST(Scene, ValuesThatCannotBe)
{
  expect_blame({"Grid/Upper corner=0, 1"},
               "Grid/Upper corner",
               {"'0, 1'", "allowed"});
  expect_blame({"Grid/Upper corner=1, 1, 1"}, "Grid/Upper corner", {"2"});
  expect_blame({"Boundary conditions/top/Type=velocity",
                "Boundary conditions/top/Value=1"},
               "Boundary conditions/top/Value",
               {"'1'", "2 expressions"});
  expect_blame({"Boundary conditions/top/Type=normal velocity",
                "Boundary conditions/top/Value=speed"},
               "Boundary conditions/top/Value",
               {"'speed'"});
  expect_blame({"Boundary conditions/top/Type=velocity"},
               "Boundary conditions/top/Value",
               {"found ''"});
  expect_blame({"General/Constants=speed"},
               "General/Constants",
               {"'speed'", "name = number"});
  expect_blame({"Time/Largest time step=0.5"},
               "Time/Largest time step",
               {"0.5"});
  expect_blame({"Geometry/Kind=axisymmetric", "Grid/Lower corner=-1, 0"},
               "Grid/Lower corner",
               {"radius"});
  expect_blame({"Grid/Local refinements=1", "Grid/Refine where="},
               "Grid/Refine where",
               {"found ''", "expression"});
  // outside what the pattern of the entry allows: with the line
  expect_blame({"Grid/Cells=0, 4"}, "", {"Cells"});
}


TEST(Scene, LawsThatDoNotFit)
{
  const Overrides jaumann = {"Materials/rubber/Law=Jaumann elastic"};
  expect_blame(jaumann + Overrides{"Solver/Linear solver=CG"},
               "Solver/Linear solver",
               {"'CG'", "symmetric", "'block'", "GMRES"});
  const Overrides f_bar = {"Materials/rubber/F-bar=true"};
  expect_blame(f_bar + Overrides{"Materials/rubber/Law=linear elastic"},
               "Materials/rubber/F-bar",
               {"'true'", "linear elastic", "Jaumann"});
  EXPECT_NO_THROW(scene_from<2>(plane, jaumann + f_bar));
  expect_blame(f_bar + Overrides{"Geometry/Kind=plane stress"},
               "Materials/rubber/F-bar",
               {"'true'", "plane stress"});
  const Overrides softening = {"Materials/rubber/Law=linear von Mises",
                               "Materials/rubber/Yield stress=0.01",
                               "Materials/rubber/Hardening=bilinear",
                               "Materials/rubber/Limit strain=0.1"};
  expect_blame(softening + Overrides{"Materials/rubber/Softening modulus=2"},
               "Materials/rubber/Softening modulus",
               {"'2'", "shear"});
  EXPECT_NO_THROW(scene_from<2>(
    plane, softening + Overrides{"Materials/rubber/Softening modulus=1"}));
  const auto blame = [](const Overrides &overrides) -> std::string {
    try
      {
        scene_from<2>(fluid_scene("plane strain"), overrides);
        return "";
      }
    catch (const InputError &error)
      {
        return error.entry;
      }
  };
  EXPECT_EQ(blame({}), "");
  EXPECT_EQ(blame({"Geometry/Kind=plane stress"}), "Materials/rubber/Law");
  EXPECT_EQ(blame({"Materials/rubber/Second viscosity=-0.3"}),
            "Materials/rubber/Second viscosity");
  EXPECT_EQ(blame({"Solver/Linear solver=CG"}), "Solver/Linear solver");
}


TEST(Scene, IsWhatTheFileSays)
{
  const auto scene = scene_from<2>(
    plane,
    plastic + with_inertia + refined +
      Overrides{"General/Constants=speed = 3",
                "Time/Theta=0.75",
                "Boundary conditions/top/Type=velocity",
                "Boundary conditions/top/Value=x; -speed*t",
                "Boundary conditions/top/Moves the grid=true",
                "Boundary conditions/left/Type=slip",
                "Boundary conditions/right/Type=normal displacement",
                "Boundary conditions/right/Value=speed",
                "Loads/Body force=0; -9.81"});
  EXPECT_TRUE(scene.time.has_inertia());
  EXPECT_EQ(scene.time.theta, 0.75);
  EXPECT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].material->density, 1.);
  EXPECT_EQ(scene.grid.refinement_levels, 1u);
  const auto &left = scene.faces[0], &right = scene.faces[1],
             &bottom = scene.faces[2], &top = scene.faces[3];
  EXPECT_TRUE(left.constrained[0] && !left.constrained[1] && !left.value);
  EXPECT_TRUE(right.constrained[0] && !right.constrained[1]);
  EXPECT_FALSE(right.is_velocity || right.moves_grid);
  EXPECT_EQ(right.value->value({0.3, 0.2}), 3.);
  EXPECT_FALSE(bottom.constrained[0] || bottom.constrained[1]);
  EXPECT_TRUE(top.constrained[0] && top.constrained[1]);
  EXPECT_TRUE(top.is_velocity && top.moves_grid);
  top.value->set_time(2.);
  EXPECT_EQ(top.value->value({0.3, 0.2}, 0), 0.3);
  EXPECT_EQ(top.value->value({0.3, 0.2}, 1), -6.);
  EXPECT_EQ(scene.loads.body_force->value({0, 0}, 1), -9.81);
}


// Where a load is evaluated once, or at every point and instant, is told by
// the names in it.
TEST(Scene, ExpressionsTellWhatTheyDependOn)
{
  const auto names = [](const std::string &force, const std::string &words) {
    const auto scene =
      scene_from<2>(block_scene("plane strain"), {"Loads/Body force=" + force});
    return names_any_of(*scene.loads.body_force, words);
  };
  const std::string place = "x|y|z|rand|rand_seed", time = "t|rand|rand_seed";
  EXPECT_FALSE(names("0; -9.81", place));
  EXPECT_FALSE(names("0; -1e1*sqrt(2)", time));
  EXPECT_FALSE(names("0; -10*t", place));
  EXPECT_TRUE(names("0; -10*t", time));
  EXPECT_TRUE(names("y^2; 0", place));
  EXPECT_TRUE(names("0; 2*(x-1)", place));
  EXPECT_FALSE(names("exp(1); max(1, tan(1))", place));
  EXPECT_FALSE(names("exp(1); max(1, tan(1))", time));
  EXPECT_TRUE(names("0; rand()", place));
  EXPECT_TRUE(names("0; rand()", time));
}
