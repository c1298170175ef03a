#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/study/study.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene_fixture.h"

using namespace impm;

namespace
{
  const std::string plane = block_scene("plane strain");

  /** The warnings of a file that is taken. */
  std::string
  warnings_of(const Overrides &overrides, const std::string &more = "")
  {
    const TemporaryFile file(plane + more, ".prm");
    ParameterFile       parameters(file.name, overrides, declare_file);
    std::string         all;
    for (const auto &warning : parameters.warnings)
      all += warning + "\n";
    // What a run keeps of its parameters says the same and reads back.
    const TemporaryFile again(parameters.resolved({"Study"}), ".prm");
    ParameterFile       once_more(again.name, {}, declare_file);
    EXPECT_EQ(once_more.resolved({"Study"}), parameters.resolved({"Study"}));
    EXPECT_TRUE(once_more.warnings.empty());
    return all;
  }

  std::string
  refusal_of(const Overrides &overrides, const std::string &more = "")
  {
    try
      {
        warnings_of(overrides, more);
        return "";
      }
    catch (const InputError &error)
      {
        return error.what();
      }
  }

  bool
  has(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace


// Entries that another choice would use.
TEST(ParameterFile, WarnsOfWhatDoesNothing)
{
  const std::string hardening = "subsection Materials\n"
                                "  subsection rubber\n"
                                "    set Yield stress     = 1\n"
                                "    set Reference strain = 0.1\n"
                                "  end\n"
                                "end\n";
  const auto        text      = warnings_of({}, hardening);
  EXPECT_TRUE(has(text,
                  "line 44: entry 'Materials/rubber/Yield stress' does "
                  "nothing in this scene; it would with "
                  "'Materials/rubber/Law = "))
    << text;
  EXPECT_TRUE(has(text, "line 45: entry 'Materials/rubber/Reference strain'"))
    << text;
  EXPECT_EQ(warnings_of({"Materials/rubber/Law=log-strain von Mises",
                         "Materials/rubber/Hardening=Swift"},
                        hardening),
            "");
  for (const std::string override :
       {"Grid/Refine where=x",
        "Grid/Map=x; y",
        "Time/Theta=0.5",
        "Time/Error tolerance=0.1",
        "Bodies/block/Velocity=1; 0",
        "Bodies/block/Merge tolerance=0.1",
        "Bodies/block/File=points.csv",
        "Grid/Adaptation/Interval=2",
        "Loads/Coordinates=initial",
        "Materials/rubber/Thermal expansion=1e-5",
        "Materials/rubber/Melting temperature=1000",
        "Boundary conditions/top/Value=0; 0",
        "Geometry/box/Radius=1",
        "Solver/GMRES directions=10",
        "Output/Fringe number=3",
        "Stabilization/Isolated stiffness=1e-3"})
    {
      const bool is_used = has(override, "Stabilization");
      const auto warning = warnings_of({override});
      EXPECT_EQ(has(warning, "does nothing in this scene; it would with"),
                !is_used)
        << override << ": " << warning;
    }
  EXPECT_TRUE(has(warnings_of({"Time/Integrator=explicit"}),
                  "subsection 'Solver' does nothing"));
}


// A constant of a material that nobody has given is told.
TEST(ParameterFile, WarnsOfWhatIsMissing)
{
  std::string       text    = plane;
  const std::string density = "set Density";
  const auto        begin   = text.find(density);
  ASSERT_NE(begin, std::string::npos);
  text.erase(begin, text.find('\n', begin) - begin);
  const TemporaryFile file(text, ".prm");
  const auto          warnings_with = [&](const Overrides &overrides) {
    return join(ParameterFile(file.name, overrides, declare_file).warnings,
                "\n");
  };
  EXPECT_EQ(warnings_with({}),
            "entry 'Materials/rubber/Density' is not given: 1000 is taken");
  EXPECT_EQ(warnings_with({"Materials/rubber/Density=1000"}), "");
}


// No choice knows them.
TEST(ParameterFile, RefusesWhatNobodyKnows)
{
  for (const std::string entry : {"Time/Thita",
                                  "Materials/steel/Density",
                                  "Output/probe/Kind",
                                  "Tim/Theta",
                                  "General/x/y/z"})
    EXPECT_TRUE(has(refusal_of({entry + "=1"}), "allowed here are: ")) << entry;
  EXPECT_TRUE(
    has(refusal_of({"Loads/pull/Enabled=maybe", "Loads/Tractions=pull"}),
        "'Enabled': found 'maybe', allowed is true or false"));
}


TEST(ParameterFile, WhatIsSwitchedOff)
{
  const std::string loads = "subsection Loads\n"
                            "  set Body force  = 0; -1\n"
                            "  set Coordinates = initial\n"
                            "  set Tractions   = pull, push\n"
                            "  subsection pull\n"
                            "    set Body  = block\n"
                            "    set Value = 0; 1\n"
                            "  end\n"
                            "  subsection push\n"
                            "    set Body  = block\n"
                            "    set Kind  = pressure\n"
                            "    set Value = 1\n"
                            "  end\n"
                            "end\n";
  const auto        scene = [&](const Overrides &overrides) {
    return scene_from<2>(plane + loads, overrides);
  };
  EXPECT_EQ(scene({}).loads.on_surfaces.size(), 2u);
  EXPECT_EQ(scene({"Loads/pull/Enabled=false"}).loads.on_surfaces.size(), 1u);
  EXPECT_EQ(scene({"Loads/Tractions=pull"}).loads.on_surfaces.size(), 1u);
  EXPECT_EQ(scene({"Loads/Tractions="}).loads.on_surfaces.size(), 0u);
  EXPECT_EQ(scene({"Loads/Body force="}).loads.body_force, nullptr);
  EXPECT_EQ(warnings_of({"Loads/pull/Enabled=false"}, loads), "");
  const auto warning = warnings_of({"Loads/Tractions=pull"}, loads);
  EXPECT_TRUE(has(warning, "line 50: subsection 'Loads/push' does nothing"))
    << warning;
  EXPECT_EQ(std::count(warning.begin(), warning.end(), '\n'), 1) << warning;
  EXPECT_TRUE(has(warnings_of({"Loads/Body force="}, loads),
                  "line 44: entry 'Loads/Coordinates' does nothing"));
  const std::string second = "subsection Bodies\n"
                             "  set Names = block, other\n"
                             "  subsection other\n"
                             "    set Shape    = box\n"
                             "    set Material = rubber\n"
                             "  end\n"
                             "end\n";
  EXPECT_EQ(
    scene_from<2>(plane + second, {"Bodies/other/Enabled=false"}).bodies.size(),
    1u);
}


// Paths are those of the file that has them.
TEST(ParameterFile, PathsInIncludedFiles)
{
  const auto        folder = std::filesystem::path(testing::TempDir());
  const std::string name   = "impm_include_" + std::to_string(getpid());
  const auto        inner  = folder / name;
  std::filesystem::create_directories(inner);
  std::ofstream(inner / "points.csv") << "x,y,volume\n0.3,0.3,0.04\n";
  std::ofstream(inner / "points.prm") << "subsection Bodies\n"
                                         "  subsection block\n"
                                         "    set Points from = file\n"
                                         "    set File = points.csv\n"
                                         "    set Velocity = 1; 0\n"
                                         "  end\n"
                                         "end\n";
  std::ofstream(folder / (name + ".prm"))
    << plane << "include " << name << "/points.prm\n";
  ParameterFile file((folder / (name + ".prm")).string(), {}, declare_file);
  EXPECT_EQ(read_scene<2>(file.handler()).bodies[0].point_file,
            (inner / "points.csv").string());
  ASSERT_EQ(file.warnings.size(), 2u); // of the shape and the velocity
  EXPECT_TRUE(has(file.warnings[1], "points.prm, line 5: entry 'Bodies/block"));
  EXPECT_TRUE(has(file.locate("Bodies/block/File"), "points.prm, line 4"));
  std::filesystem::remove_all(inner);
  std::filesystem::remove(folder / (name + ".prm"));
}


TEST(ParameterFile, NamesOfColumns)
{
  for (const std::string name :
       {"time", "kinetic_energy", "wall_seconds", "residual", "step_error"})
    for (const std::string kind : {"Probe", "Reaction"})
      try
        {
          scene_from<2>(plane,
                        {"Boundary conditions/top/Type=fixed",
                         "Output/" + kind + "s=" + name,
                         kind == "Probe" ? "Output/" + name + "/Position=0, 0" :
                                           "Output/" + name + "/On=top",
                         kind == "Probe" ?
                           "Output/" + name + "/Field=displacement" :
                           "Output/" + name + "/Direction=0, 1"});
          ADD_FAILURE() << name << " is taken";
        }
      catch (const InputError &error)
        {
          EXPECT_EQ(error.entry, "Output/" + kind + "s");
          EXPECT_TRUE(has(error.what(), "'" + name + "'")) << error.what();
        }
}
