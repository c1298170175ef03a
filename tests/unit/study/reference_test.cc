#include <impm/base/exceptions.h>
#include <impm/run/simulation.h>
#include <impm/study/finer_run.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

#include "expect_blame.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** A directory that all ranks share, or one of a rank's own. */
  std::string
  directory_for(const MPI_Comm communicator)
  {
    const auto id =
      Utilities::MPI::broadcast(communicator, static_cast<int>(getpid()));
    return "/tmp/impm_test_reference_" + std::to_string(id) + "_" +
           std::to_string(Utilities::MPI::n_mpi_processes(communicator));
  }

  nlohmann::json
  errors_in(const std::string &directory)
  {
    std::ifstream file(directory + "/summary.json");
    return nlohmann::json::parse(file).at("errors");
  }

  void
  remove(const std::string &directory, const MPI_Comm communicator)
  {
    MPI_Barrier(communicator);
    std::error_code none;
    std::filesystem::remove_all(directory, none);
    MPI_Barrier(communicator);
  }

  /** The records that a run leaves in summary.json. */
  template <int dim>
  nlohmann::json
  errors_of(const std::string &text,
            const Overrides   &overrides,
            const MPI_Comm     communicator = MPI_COMM_SELF)
  {
    const auto      scene     = scene_from<dim>(text, overrides);
    const auto      directory = directory_for(communicator);
    Simulation<dim> simulation(scene,
                               CommandLine::Verbosity::quiet,
                               communicator);
    simulation.run(directory, "test", "");
    MPI_Barrier(communicator);
    const auto errors = errors_in(directory);
    remove(directory, communicator);
    return errors;
  }

  /** References of one kind with the names a, b, c, ... */
  Overrides
  references(const std::string &kind, const std::vector<Overrides> &entries)
  {
    Overrides   overrides;
    std::string names;
    for (unsigned int i = 0; i < entries.size(); ++i)
      {
        const std::string name(1, 'a' + i);
        names += (i > 0 ? "," : "") + name;
        overrides.push_back("Reference/" + name + "/Kind=" + kind);
        for (const auto &entry : entries[i])
          overrides.push_back("Reference/" + name + "/" + entry);
      }
    overrides.push_back("Reference/Names=" + names);
    return overrides;
  }

  /** A block under uniform strain, so that u = -0.1 (x, 0) is exact. */
  Overrides
  strained(const unsigned int dim)
  {
    return displaced_faces(dim, dim == 2 ? "-0.1*x*t; 0" : "-0.1*x*t; 0; 0");
  }

  /** A face that has moved by -0.1 t^2, at t = 0.5 and 1. */
  const Overrides moving = {"Time/Time step=0.5",
                            "Boundary conditions/bottom/Type=slip",
                            "Boundary conditions/left/Type=slip",
                            "Boundary conditions/top/Type=normal displacement",
                            "Boundary conditions/top/Value=-0.1*t^2",
                            "Boundary conditions/top/Moves the grid=true",
                            "Output/Probes=top",
                            "Output/top/Kind=motion",
                            "Output/top/Of=top",
                            "Output/top/Component=1"};

  void
  expect_blame(const Overrides                &overrides,
               const std::string              &entry,
               const std::vector<std::string> &words)
  {
    impm::expect_blame(block_scene("plane strain"),
                       moving + overrides,
                       entry,
                       words);
  }
} // namespace


TEST(Reference, UniformStrainIsExact)
{
  const auto plane =
    errors_of<2>(block_scene("plane strain"),
                 strained(2) + references("field",
                                          {{"Expression=-0.1*x*t; 0"},
                                           {"Field=deformation_gradient",
                                            "Components=0, 4",
                                            "Expression=1 - 0.1*t; 1",
                                            "Norm=max"}}));
  ASSERT_EQ(plane.size(), 2u);
  for (const auto &record : plane)
    EXPECT_LT(record["error"], 1e-12) << record;
  EXPECT_EQ(plane[0]["name"], "a");
  EXPECT_EQ(plane[0]["kind"], "field");
  EXPECT_EQ(plane[0]["norm"], "L1");
  EXPECT_EQ(plane[1]["norm"], "max");
  EXPECT_GT(plane[0]["wall_seconds"], 0.);
  const auto space =
    errors_of<3>(block_scene("3D"),
                 strained(3) +
                   references("field", {{"Expression=-0.1*x*t; 0; 0*z"}}));
  EXPECT_LT(space[0]["error"], 1e-12);
}


// The points are at (i + 1/2) / 8.
TEST(Reference, NormsOfAField)
{
  const double square = 1. / 3 - 1. / 768; // mean of x^2
  const auto   plane  = errors_of<2>(
    block_scene("plane strain"),
    strained(2) +
      references("field",
                 {{"Expression=0; 0"},
                     {"Expression=0; 0", "Norm=L2"},
                     {"Expression=0; 0", "Norm=max"},
                     {"Expression=0.3 - 0.1*x; 0.4", "Norm=L2", "Scale=2*pi/pi"},
                     {"Expression=0.05*x; 0", "Scale=reference"},
                     {"Expression=0.25", "Components=1"}}));
  EXPECT_NEAR(plane[0]["error"], 0.05, 1e-12);
  EXPECT_NEAR(plane[0]["value"], 0.05, 1e-12);
  EXPECT_EQ(plane[0]["reference"], 0.);
  EXPECT_NEAR(plane[1]["error"], 0.1 * std::sqrt(square), 1e-12);
  EXPECT_NEAR(plane[2]["error"], 0.1 * 7.5 / 8, 1e-12);
  EXPECT_NEAR(plane[3]["error"], 0.25, 1e-12);
  EXPECT_NEAR(plane[4]["error"], 3., 1e-12);
  EXPECT_NEAR(plane[4]["reference"], 0.025, 1e-12);
  EXPECT_NEAR(plane[5]["error"], 0.25, 1e-12);

  // The volume goes with the radius.
  const auto round =
    errors_of<2>(block_scene("axisymmetric"),
                 strained(2) + references("field", {{"Expression=0; 0"}}));
  EXPECT_NEAR(round[0]["error"], 0.1 * square / 0.5, 1e-12);
}


TEST(Reference, FieldOfOneBody)
{
  const Overrides halves = {"Geometry/Shapes=box, other",
                            "Geometry/box/Upper corner=0.5, 1",
                            "Geometry/other/Lower corner=0.5, 0",
                            "Geometry/other/Upper corner=1, 1",
                            "Bodies/Names=block, second",
                            "Bodies/second/Shape=other",
                            "Bodies/second/Material=rubber"};
  const auto      errors =
    errors_of<2>(block_scene("plane strain"),
                 strained(2) + halves +
                   references("field",
                              {{"Expression=0; 0", "Bodies=second"},
                               {"Expression=0; 0", "Bodies=block, second"}}));
  EXPECT_NEAR(errors[0]["error"], 0.075, 1e-12);
  EXPECT_NEAR(errors[1]["error"], 0.05, 1e-12);
}


TEST(Reference, LargestOverTheSteps)
{
  const Overrides rest = {"Time/End time=2", "Time/Time step=0.5"};
  const auto      errors =
    errors_of<2>(block_scene("plane strain"),
                 with_inertia + rest +
                   references("field",
                              {{"Expression=0.1*t*(2 - t); 0", "When=largest"},
                               {"Expression=0.1*t*(2 - t); 0"},
                               {"Field=velocity",
                                "Expression=t; 0",
                                "When=largest",
                                "Scale=reference"}}));
  EXPECT_NEAR(errors[0]["error"], 0.1, 1e-12);
  EXPECT_NEAR(errors[1]["error"], 0., 1e-12);
  EXPECT_NEAR(errors[2]["error"], 1., 1e-12);
  EXPECT_NEAR(errors[2]["reference"], 2., 1e-12);
}


TEST(Reference, WhatIsNotANumberIsNull)
{
  const auto errors =
    errors_of<2>(block_scene("plane strain"),
                 strained(2) +
                   references("field",
                              {{"Expression=sqrt(x - 0.5); 0"},
                               {"Expression=0; 0", "Scale=reference"},
                               {"Expression=sqrt(x - 0.5); 0",
                                "Norm=max",
                                "When=largest"}}));
  for (const auto &record : errors)
    {
      EXPECT_TRUE(record["error"].is_null()) << record;
      EXPECT_FALSE(record["flaw"].empty()) << record;
    }
  EXPECT_NE(errors[0]["flaw"].get<std::string>().find("not finite"),
            std::string::npos);
  EXPECT_NE(errors[1]["flaw"].get<std::string>().find("zero"),
            std::string::npos);
}


TEST(Reference, ProbeAtATime)
{
  const auto errors = errors_of<2>(
    block_scene("plane strain"),
    moving +
      references("probe",
                 {{"Of=top", "Value=-0.1*t^2"},
                  {"Of=top", "Value=-0.1*t^2", "Time=0.75"},
                  {"Of=top", "Value=-0.1*t^2", "Time=0.75", "Scale=reference"},
                  {"Of=top", "Value=0", "Time=0.25"},
                  {"Of=mass", "Value=2"}}));
  EXPECT_NEAR(errors[0]["error"], 0., 1e-12);
  EXPECT_NEAR(errors[0]["value"], -0.1, 1e-12);
  // halfway between -0.025 and -0.1
  EXPECT_NEAR(errors[1]["value"], -0.0625, 1e-12);
  EXPECT_NEAR(errors[1]["reference"], -0.05625, 1e-12);
  EXPECT_NEAR(errors[1]["error"], 0.00625, 1e-12);
  EXPECT_NEAR(errors[2]["error"], 1. / 9, 1e-12);
  // before the end of the first step
  EXPECT_TRUE(errors[3]["error"].is_null());
  EXPECT_NEAR(errors[4]["error"], 1., 1e-12);
}


TEST(Reference, CurveOfAColumn)
{
  const TemporaryFile named("top, x, time\n0,1,0\n0,1,1\n", ".csv"),
    bare("t,u\n0.5,-0.025\n\n2,-0.3\n", ".csv");
  const std::string points = "Points=0 0; 0.5 0; 0.75 0; 1 0; 2 7";
  const auto        errors =
    errors_of<2>(block_scene("plane strain"),
                 moving + references("curve",
                                     {{"Column=top", points},
                                      {"Column=top", points, "Norm=L2"},
                                      {"Column=top", points, "Norm=max"},
                                      {"Column=top", "File=" + named.name},
                                      {"Column=top", "File=" + bare.name},
                                      {"Column=top", "Expression=0.1*t^2"},
                                      {"Column=time",
                                       "Against=top",
                                       "Points=-0.1 1; -0.0625 1; -0.025 0.5",
                                       "Norm=max"},
                                      {"Column=top", "Points=3 0; 4 0"}}));
  // At 0.5, 0.75, 1: -0.025, -0.0625, -0.1 by the trapezoid rule.
  EXPECT_NEAR(errors[0]["error"], 0.0625, 1e-12);
  const double l2 = 0.025 * 0.025 + 2 * 0.0625 * 0.0625 + 0.1 * 0.1;
  EXPECT_NEAR(errors[1]["error"], std::sqrt(l2 / 4), 1e-12);
  EXPECT_NEAR(errors[2]["error"], 0.1, 1e-12);
  EXPECT_NEAR(errors[2]["value"], -0.1, 1e-12);
  EXPECT_EQ(errors[2]["reference"], 0.);
  // Only the last abscissa, 1, is on the history; then only the first, 0.5.
  EXPECT_NEAR(errors[3]["error"], 0.1, 1e-12);
  EXPECT_NEAR(errors[4]["error"], 0., 1e-12);
  // Twice 0.025 and 0.1 at the rows.
  EXPECT_NEAR(errors[5]["error"], 0.125, 1e-12);
  // The abscissa falls: at -0.0625 the time is 0.75.
  EXPECT_NEAR(errors[6]["error"], 0.25, 1e-12);
  EXPECT_TRUE(errors[7]["error"].is_null());
  EXPECT_NE(errors[7]["flaw"].get<std::string>().find("common"),
            std::string::npos);
}


TEST(Reference, Curves)
{
  const auto falling = make_curve({3, 2, 0}, {1, 5, 9});
  ASSERT_TRUE(falling);
  EXPECT_EQ(falling->value(0), 9.);
  EXPECT_EQ(falling->value(1), 7.);
  EXPECT_EQ(falling->value(2.25), 4.);
  EXPECT_EQ(falling->value(3), 1.);
  EXPECT_TRUE(falling->contains(3 + 1e-10));
  EXPECT_EQ(falling->value(3 + 1e-10), 1.);
  EXPECT_TRUE(std::isnan(falling->value(3.1)));
  EXPECT_TRUE(std::isnan(falling->value(-0.1)));
  EXPECT_FALSE(make_curve({0, 2, 1}, {0, 0, 0}));
  // an abscissa that rests: from the last of its values on
  EXPECT_EQ(make_curve({0, 1, 1, 2}, {0, 1, 3, 4})->value(1.5), 3.5);
}


TEST(ReferenceMpi, NormsDoNotDependOnTheRanks)
{
  const auto overrides =
    strained(2) + refined +
    references("field",
               {{"Expression=x*y; exp(x)"},
                {"Expression=x*y; exp(x)", "Norm=L2", "When=largest"},
                {"Expression=x*y; exp(x)", "Norm=max"},
                {"Field=von_mises_stress", "Expression=x", "Norm=L2"}});
  const auto text     = block_scene("axisymmetric");
  const auto alone    = errors_of<2>(text, overrides, MPI_COMM_SELF);
  const auto together = errors_of<2>(text, overrides, MPI_COMM_WORLD);
  ASSERT_EQ(alone.size(), together.size());
  for (unsigned int i = 0; i < alone.size(); ++i)
    for (const std::string figure : {"value", "reference", "error"})
      EXPECT_NEAR(alone[i][figure].get<double>(),
                  together[i][figure].get<double>(),
                  1e-11)
        << i << ' ' << figure;
}


TEST(ReferenceMpi, FinerRunIsMadeOnce)
{
  const TemporaryFile file(block_scene("plane strain"), ".prm");
  const auto          directory = directory_for(MPI_COMM_WORLD);
  const bool first = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  // The finer one has moved by 0.01 t^2 more.
  CommandLine line;
  line.parameter_file = file.name;
  line.verbosity      = CommandLine::Verbosity::quiet;
  line.overrides =
    moving + references("finer run",
                        {{"Overrides=Time/Time step=0.25 | Boundary "
                          "conditions/top/Value=-0.11*t^2",
                          "Columns=top, mass",
                          "Norm=max"}});
  const auto errors = [&]() {
    ParameterFile parameters(file.name, line.overrides, declare_scene);
    const auto    scene = read_scene<2>(parameters.handler());
    Simulation<2> simulation(scene,
                             CommandLine::Verbosity::quiet,
                             MPI_COMM_WORLD);
    simulation.run(directory,
                   "test",
                   "",
                   make_finer_runs(scene.references, line, directory));
    MPI_Barrier(MPI_COMM_WORLD);
    const auto records = errors_in(directory);
    MPI_Barrier(MPI_COMM_WORLD);
    return records;
  };
  const auto fresh = errors();
  ASSERT_EQ(fresh.size(), 2u);
  EXPECT_EQ(fresh[0]["name"], "a_top");
  EXPECT_EQ(fresh[0]["kind"], "finer run");
  EXPECT_NEAR(fresh[0]["error"], 0.01, 1e-11);
  EXPECT_NEAR(fresh[0]["value"], -0.1, 1e-11);
  EXPECT_NEAR(fresh[0]["reference"], -0.11, 1e-11);
  EXPECT_EQ(fresh[1]["name"], "a_mass");
  EXPECT_NEAR(fresh[1]["error"], 0., 1e-11);
  EXPECT_GT(fresh[0]["reference_wall_seconds"], 0.);

  // Marks the finer run, to see whether it is made again.
  const auto summary = directory + "/reference_a/summary.json";
  if (first)
    {
      nlohmann::json json;
      std::ifstream(summary) >> json;
      EXPECT_TRUE(json["errors"].empty());
      json["wall_seconds"] = 12345;
      std::ofstream(summary) << json;
    }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(errors()[0]["reference_wall_seconds"], 12345.);
  // What the references say does not matter to it; the scene does.
  line.overrides.push_back("Reference/a/Norm=L1");
  EXPECT_EQ(errors()[0]["reference_wall_seconds"], 12345.);
  line.overrides.push_back("Materials/rubber/Density=2");
  EXPECT_NE(errors()[0]["reference_wall_seconds"], 12345.);

  line.overrides.push_back("Reference/a/Overrides=Time/Thyme=1");
  try
    {
      errors();
      ADD_FAILURE() << "is taken";
    }
  catch (const InputError &error)
    {
      EXPECT_EQ(error.entry, "Reference/a/Overrides");
      EXPECT_NE(std::string(error.what()).find("Thyme"), std::string::npos);
    }
  remove(directory, MPI_COMM_WORLD);
}


TEST(Reference, WhatCannotBe)
{
  const auto field = [](const Overrides &entries) {
    return references("field", {entries});
  };
  expect_blame(field({"Expression=0", "Field=velocity"}),
               "Reference/a/Field",
               {"'velocity'", "cauchy_stress"});
  expect_blame(field({"Expression=0; 0", "Components=0, 3"}),
               "Reference/a/Components",
               {"found 3", "less than 3"});
  expect_blame(field({"Expression=0"}),
               "Reference/a/Expression",
               {"found 1", "are 2"});
  expect_blame(field({"Expression=0; 0", "Components=0"}),
               "Reference/a/Expression",
               {"one expression"});
  expect_blame(field({"Components=0"}), "Reference/a/Expression", {"''"});
  expect_blame(field({"Expression=0; 0", "Bodies=rock"}),
               "Reference/a/Bodies",
               {"'rock'", "block"});
  expect_blame(field({"Expression=0; 0", "Scale=0"}),
               "Reference/a/Scale",
               {"'0'", "reference"});
  expect_blame(field({"Expression=0; 0", "Scale=1 + t"}),
               "Reference/a/Scale",
               {"'1 + t'"});
  expect_blame(references("probe", {{"Of=load", "Value=0"}}),
               "Reference/a/Of",
               {"'load'", "kinetic_energy", "top"});
  expect_blame(references("probe", {{"Of=top", "Value=0", "Time=1.5"}}),
               "Reference/a/Time",
               {"1.5", "end time"});
  expect_blame(references("curve", {{"Column=load", "Expression=0"}}),
               "Reference/a/Column",
               {"'load'"});
  expect_blame(references("curve", {{"Column=top"}}),
               "Reference/a/File",
               {"none", "exactly one"});
  expect_blame(references("curve",
                          {{"Column=top", "Points=0 0", "Expression=0"}}),
               "Reference/a/Expression",
               {"more than one"});
  expect_blame(references("curve", {{"Column=top", "Points=0 0; 1"}}),
               "Reference/a/Points",
               {"'1'"});
  expect_blame(references("curve", {{"Column=top", "Points=0 0; 2 0; 1 0"}}),
               "Reference/a/Points",
               {"rises and falls"});
  expect_blame(references("curve", {{"Column=top", "File=nowhere.csv"}}),
               "Reference/a/File",
               {"nowhere.csv"});
  const TemporaryFile wrong("time,bottom,x\n0,0,0\n", ".csv"),
    broken("time,top\n0,a\n", ".csv"),
    no_number("time,top\n0,1\n\n1,nan\n", ".csv"), header("time,top\n", ".csv");
  expect_blame(references("curve", {{"Column=top", "File=" + wrong.name}}),
               "Reference/a/File",
               {"'top'"});
  expect_blame(references("curve", {{"Column=top", "File=" + broken.name}}),
               "Reference/a/File",
               {"line 2", "'a'"});
  expect_blame(references("curve", {{"Column=top", "File=" + no_number.name}}),
               "Reference/a/File",
               {"line 4", "not finite"});
  expect_blame(references("curve", {{"Column=top", "File=" + header.name}}),
               "Reference/a/File",
               {"no points", "two points"});
  expect_blame(references("curve", {{"Column=top", "Points=0 0"}}),
               "Reference/a/Points",
               {"one point", "two points"});
  expect_blame(references("finer run", {{"Columns=load", "Overrides=a/b=1"}}),
               "Reference/a/Columns",
               {"'load'"});
  expect_blame({"Reference/Names=a, a", "Reference/a/Expression=0; 0"},
               "Reference/Names",
               {"twice"});
}
