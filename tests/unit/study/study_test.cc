#include <impm/base/exceptions.h>
#include <impm/study/study_report.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene_fixture.h"

using namespace impm;

namespace
{
  // The section Study with these lines in it.
  StudySpec
  study(const std::string &lines)
  {
    const TemporaryFile file("subsection Study\n" + lines + "end\n", ".prm");
    ParameterFile       parameters(file.name, {}, declare_file);
    return read_study(parameters.handler());
  }

  std::string
  list_of(const std::string &name, const std::string &lines)
  {
    return "subsection " + name + "\n" + lines + "end\n";
  }

  const std::string grid =
    list_of("grid", "set Entries = Grid/Cells\nset Values = 4, 4 | 8, 8\n");
  const std::string grid_with_sizes =
    list_of("grid",
            "set Entries = Grid/Cells\nset Values = 4, 4 | 8, 8\n"
            "set Labels = coarse, fine\nset Sizes = 0.25, 0.125\n");
  const std::string step =
    list_of("dt",
            "set Entries = Time/Time step\nset Values = 1 | 0.5 | 0.25\n");

  void
  expect_blame(const std::string &lines,
               const std::string &entry,
               const std::string &words)
  {
    SCOPED_TRACE(lines);
    try
      {
        expand(study(lines));
        FAIL() << "is taken";
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, entry);
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
          << error.what();
      }
  }

  StudyResult
  result(const double error, const double seconds)
  {
    StudyResult result;
    result.status       = "done";
    result.wall_seconds = seconds;
    result.counts       = {{"steps", 2.}, {"newton_iterations", 7.}};
    result.errors       = {{"tip", error}};
    return result;
  }

  void
  write(const std::string &name, const std::string &text)
  {
    std::ofstream(name) << text;
  }
} // namespace


TEST(Study, CrossedListsTheLastFastest)
{
  const auto spec = study("set Lists = grid, dt\n" + grid_with_sizes + step);
  const auto runs = expand(spec);
  ASSERT_EQ(runs.size(), 6u);
  EXPECT_EQ(runs[0].name, "coarse_1");
  EXPECT_EQ(runs[1].name, "coarse_0.5");
  EXPECT_EQ(runs[5].name, "fine_0.25");
  EXPECT_EQ(runs[5].overrides,
            (Overrides{"Grid/Cells=8, 8", "Time/Time step=0.25"}));
  EXPECT_EQ(runs[5].choice, (std::vector<unsigned int>{1, 2}));
  EXPECT_EQ(spec.order_along, 0u);
  EXPECT_EQ(spec.lists[1].sizes, (std::vector<double>{1, 0.5, 0.25}));
}


TEST(Study, PairedLists)
{
  const auto runs =
    expand(study("set Lists = grid, n\nset Combine = paired\n" + grid +
                 list_of("n", "set Entries = ranks\nset Values = 1 | 2\n")));
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[1].name, "8-8_2");
  EXPECT_EQ(runs[1].ranks, 2u);
  EXPECT_EQ(runs[1].overrides, Overrides{"Grid/Cells=8, 8"});
}


TEST(Study, SeveralEntriesOfOneList)
{
  const auto spec = study(
    "set Lists = solver\n" +
    list_of("solver",
            "set Entries = Solver/Linear solver; Solver/Preconditioner; ranks\n"
            "set Values = CG; AMG; 2 | direct;; 1\n"
            "set Labels = AMG, direct\n"));
  const auto runs = expand(spec);
  EXPECT_EQ(runs[0].overrides,
            (Overrides{"Solver/Linear solver=CG",
                       "Solver/Preconditioner=AMG"}));
  EXPECT_EQ(runs[0].ranks, 2u);
  // an empty part leaves the entry alone
  EXPECT_EQ(runs[1].overrides, Overrides{"Solver/Linear solver=direct"});
  EXPECT_EQ(spec.order_along, StudySpec::none);
}


// One entry takes the semicolons of its value.
TEST(Study, OneEntryWithSemicolons)
{
  const auto runs = expand(study(
    "set Lists = v\n" +
    list_of("v", "set Entries = Bodies/b/Velocity\nset Values = 0; 1|1; 0\n")));
  EXPECT_EQ(runs[0].overrides, Overrides{"Bodies/b/Velocity=0; 1"});
}


TEST(Study, ListsThatDoNotFit)
{
  const std::string lists = "set Lists = grid\n";
  expect_blame("", "Study/Lists", "found ''");
  expect_blame("set Lists = /\n", "Study/Lists", "without '/'");
  expect_blame("set Lists = status\n" + list_of("status", ""),
               "Study/Lists",
               "taken");
  expect_blame(lists + list_of("grid", "set Entries = Cells\nset Values = 1\n"),
               "Study/grid/Entries",
               "'Cells'");
  expect_blame(lists + list_of("grid", "set Entries = Grid/Cells\n"),
               "Study/grid/Values",
               "found ''");
  expect_blame(lists + list_of("grid",
                               "set Entries = Grid/Cells; Time/Time step\n"
                               "set Values = 4, 4; 1 | 8, 8\n"),
               "Study/grid/Values",
               "allowed are 2 parts");
  expect_blame(lists + list_of("grid",
                               "set Entries = Grid/Cells\nset Values = 4 | 8\n"
                               "set Labels = coarse\n"),
               "Study/grid/Labels",
               "allowed are 2");
  expect_blame(lists + list_of("grid",
                               "set Entries = Grid/Cells\nset Values = 4 | 8\n"
                               "set Sizes = 1, 2, 3\n"),
               "Study/grid/Sizes",
               "allowed are 2");
  expect_blame(lists + list_of("grid", "set Entries = ranks\nset Values = 0\n"),
               "Study/grid/Values",
               "at least 1");
  expect_blame("set Lists = grid, dt\nset Combine = paired\n" + grid + step,
               "Study/dt/Values",
               "found 3");
  expect_blame("set Lists = grid, more\n" + grid +
                 list_of("more",
                         "set Entries = Grid/Cells\nset Values = 3, 3\n"),
               "Study/more/Entries",
               "second time");
  expect_blame(lists + "set Order along = grid\n" + grid,
               "Study/Order along",
               "has Sizes");
  expect_blame(lists + "set Order along = dt\n" + grid,
               "Study/Order along",
               "'dt'");
  expect_blame(lists +
                 list_of("grid",
                         "set Entries = Grid/Cells\nset Values = 4,4|4, 4\n"),
               "Study/Lists",
               "'4-4'");
}


// Errors C h^2, but for the one that failed: order 2 across it, too.
// Their number would start again from zero, or take all memory.
TEST(Study, MoreRunsThanCanBeListed)
{
  std::string names, lists;
  for (const std::string name : {"a", "b", "c", "d", "e", "f"})
    {
      std::string values = "0";
      for (unsigned int i = 1; i < 50; ++i)
        values += " | " + std::to_string(i);
      names += name + ", ";
      lists += list_of(name,
                       "set Entries = Loads/" + name +
                         "\nset Values = " + values + "\n");
    }
  expect_blame("set Lists = " + names + "\n" + lists,
               "Study/Lists",
               "more than 100000");
}


TEST(Study, Orders)
{
  const auto spec =
    study("set Lists = law, dt\n" +
          list_of("law",
                  "set Entries = Materials/m/Law\nset Values = soft | hard\n") +
          step);
  auto runs      = expand(spec);
  runs[0].result = result(0.5, 1);
  runs[1].result = result(0.125, 3);
  runs[2].result = result(0.03125, 9);
  runs[3].result = result(0.8, 2);
  runs[4].result = StudyResult{"no", 2, 1, 4., {}, {}, {}};
  runs[5].result = result(0.05, 7);

  std::istringstream       tables(order_tables(spec, runs));
  std::vector<std::string> orders;
  std::string              line, titles;
  while (std::getline(tables, line))
    {
      std::istringstream in(line);
      std::string        size, error, order, seconds, newton;
      in >> size >> error >> order >> seconds >> newton;
      if (newton == "3.5")
        orders.push_back(order);
      else if (size == "law")
        titles += error + " ";
    }
  EXPECT_EQ(titles, "soft hard ");
  EXPECT_EQ(orders,
            (std::vector<std::string>{"-", "2.00", "2.00", "-", "2.00"}));

  const auto [best_csv, best_text] = find_best(runs);
  EXPECT_EQ(best_csv,
            "reference,tolerance,run,error,wall_seconds\n"
            "tip,0.1,hard_0.25,0.05,7\n" // 0.03 takes 9 s
            "tip,0.01,none,,\n"
            "tip,0.001,none,,\n");
  EXPECT_EQ(best_text,
            "cheapest with tip within 10 %: hard_0.25, error 0.05, 7 s\n"
            "cheapest with tip within 1 %: none\n"
            "cheapest with tip within 0.1 %: none\n");

  const auto csv = study_csv(spec, runs);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "law,dt,dt_size,status,exit_code,wall_seconds,steps,points,"
            "newton_iterations,linear_iterations,line_searches,step_cuts,"
            "stress_evaluations,operator_applications,peak_memory_kilobytes,"
            "error_tip");
  EXPECT_NE(csv.find("\nsoft,0.5,0.5,done,0,3,2,,7,,,,,,,0.125\n"),
            std::string::npos)
    << csv;
  EXPECT_NE(csv.find("\nhard,0.5,0.5,no,2,4,,,,,,,,,,\n"), std::string::npos)
    << csv;
}


// Two lists with sizes that are paired are refined together.
TEST(Study, OrdersOfPairedLists)
{
  const auto spec = study(
    "set Lists = grid, dt, law\nset Combine = paired\n" +
    list_of("grid", "set Entries = Grid/Cells\nset Values = 4 | 8 | 4 | 8\n") +
    list_of("dt",
            "set Entries = Time/Time step\nset Values = 4 | 2 | 4 | 2\n") +
    list_of("law",
            "set Entries = Materials/m/Law\nset Values = a | a | b | b\n"));
  auto runs = expand(spec);
  for (unsigned int r = 0; r < 4; ++r)
    runs[r].result = result(r % 2 == 0 ? 1 : 2, 1); // grows with the size
  const auto text = order_tables(spec, runs);
  EXPECT_NE(text.find("law a\nalong grid:"), std::string::npos) << text;
  EXPECT_NE(text.find("law b\nalong grid:"), std::string::npos) << text;
  EXPECT_NE(text.find("1.00"), std::string::npos) << text;
}


// Only what went to its end with the same input on as many ranks is kept.
TEST(Study, Resume)
{
  const std::string directory =
    "/tmp/impm_test_study_" + std::to_string(getpid());
  std::filesystem::create_directories(directory);
  const std::string summary = directory + "/summary.json";
  EXPECT_FALSE(kept_result(directory, "a", 1));
  write(directory + "/parameters.prm", "a");
  EXPECT_FALSE(kept_result(directory, "a", 1));
  write(summary, "{\"status\": \"done\", \"ranks\": 1, \"wall_s");
  EXPECT_FALSE(kept_result(directory, "a", 1));
  write(summary, "{\"status\": \"no convergence\", \"ranks\": 1}");
  EXPECT_FALSE(kept_result(directory, "a", 1));

  write(summary,
        "{\"status\": \"done\", \"ranks\": 1, \"wall_seconds\": 2.5,"
        " \"steps\": 4, \"figures\": {\"tip\": 3.0, \"gap\": null},"
        " \"errors\": {}}");
  EXPECT_FALSE(kept_result(directory, "b", 1));
  EXPECT_FALSE(kept_result(directory, "a", 2));
  auto kept = kept_result(directory, "a", 1);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->wall_seconds, 2.5);
  EXPECT_EQ(kept->counts, (StudyResult::Numbers{{"steps", 4}}));
  EXPECT_EQ(kept->figures, (StudyResult::Numbers{{"tip", 3}}));
  EXPECT_TRUE(kept->errors.empty());

  write(summary,
        "{\"status\": \"done\", \"errors\": ["
        "{\"name\": \"tip\", \"norm\": \"L2\", \"error\": 0.1},"
        "{\"name\": \"tip\", \"norm\": \"max\", \"error\": 0.2},"
        "{\"name\": \"gap\", \"error\": null}]}");
  kept = kept_result(directory, "a", 1);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->errors,
            (StudyResult::Numbers{{"tip", 0.1}, {"tip_max", 0.2}}));
  std::filesystem::remove_all(directory);
}


// A study file is the scene that it names, and what it changes in it.
TEST(Study, SceneOfAnotherFile)
{
  const TemporaryFile scene(block_scene("plane strain"), ".prm");
  const auto name = std::filesystem::path(scene.name).filename().string();
  const TemporaryFile file("subsection Study\n  set Scene = " + name +
                             "\nend\nsubsection Grid\n"
                             "  set Upper corner = 2, 2\n"
                             "  set Cells = 8, 8\nend\n",
                           ".prm");
  ParameterFile       parameters(file.name, {"Grid/Cells=6, 6"}, declare_file);
  EXPECT_EQ(parameters.handler().get({"Grid"}, "Cells"), "6, 6");
  EXPECT_EQ(parameters.handler().get({"Grid"}, "Upper corner"), "2, 2");
  EXPECT_EQ(parameters.handler().get({"Geometry"}, "Shapes"), "box");
  EXPECT_EQ(parameters.locate("Geometry/Shapes"),
            "file " + scene.name + ", line 3");
  EXPECT_EQ(parameters.locate("Grid/Upper corner"),
            "file " + file.name + ", line 5");

  // What is resolved needs neither of the two, and is itself when read again.
  const auto          text = parameters.resolved({"Study"});
  const TemporaryFile again(text, ".prm");
  const ParameterFile same(again.name, {}, declare_file);
  EXPECT_EQ(same.resolved({"Study"}), text);
  EXPECT_EQ(text.find("Study"), std::string::npos);

  for (const std::string wrong : {"nowhere.prm", "twice.prm"})
    {
      write("/tmp/twice.prm", "subsection Study\nend\n");
      const TemporaryFile bad("subsection Study\nset Scene = " + wrong +
                                "\nend\n",
                              ".prm");
      EXPECT_THROW(ParameterFile(bad.name, {}, declare_file), InputError);
    }
  std::filesystem::remove("/tmp/twice.prm");
}
