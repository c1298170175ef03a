#include <impm/study/study.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "run_scene.h"

using namespace impm;

namespace
{
  /** Of shares of the volume that carry the flow. */
  double
  smallest(const std::vector<double> &shares)
  {
    return *std::min_element(shares.begin(), shares.end());
  }

  /** What a coarse necking bar has to say, whole or in two parts, between which
   * its flow goes from most of it to little. */
  std::string
  summary_of_necking(const std::string &method, const bool in_parts)
  {
    const std::string path =
      std::string(IMPM_SCENES) + "/extreme/necking_bar.prm";
    const std::string directory =
      testing::TempDir() + "impm_necking_" + std::to_string(getpid());
    const auto go_on = [&](const unsigned int n_steps, const bool restart) {
      ParameterFile file(path,
                         {"Grid/Cells=7, 20",
                          "Grid/Method=" + method,
                          "Output/Pictures=false",
                          "Output/Checkpoints/Interval in steps=40",
                          "Time/Largest number of steps=" +
                            std::to_string(n_steps)},
                         declare_file);
      Simulation<2> simulation(read_scene<2>(file.handler()),
                               CommandLine::Verbosity::quiet,
                               MPI_COMM_WORLD);
      simulation.run(directory, "test", "", {}, restart);
    };
    if (in_parts)
      go_on(40, false);
    go_on(75, in_parts);
    const auto summary = content_of(directory + "/summary.json");
    std::filesystem::remove_all(directory);
    return summary;
  }
} // namespace


// Ends that cannot draw in let a bar neck in its middle.
TEST(PlasticFlowMpi, LocalisesInANeck)
{
  for (const std::string method : {"GIMP", "MPM"})
    {
      SCOPED_TRACE(method);
      const auto shares = run_file("extreme/necking_bar",
                                   {"Grid/Cells=7, 20",
                                    "Grid/Method=" + method,
                                    "Time/End time=0.0055"})
                            .at("flow_share");
      EXPECT_GT(smallest({shares.begin(), shares.begin() + 30}), 0.85);
      EXPECT_LT(smallest(shares), 0.4);
    }
}


TEST(PlasticFlowMpi, IsWideUnderAPlaten)
{
  const auto shares =
    run_file("upsetting_rigid_points",
             {"Grid/Method=GIMP", "Bodies/billet/Point adaptation=split"})
      .at("flow_share");
  EXPECT_GT(smallest(shares), 0.6);
}


TEST(PlasticFlow, IsToldWhenItLocalises)
{
  const std::string localises = "has localised: from 9", trust = "trusted";
  for (const bool in_parts : {false, true})
    {
      SCOPED_TRACE(in_parts);
      const auto summary = summary_of_necking("GIMP", in_parts);
      EXPECT_NE(summary.find(localises), std::string::npos) << summary;
      EXPECT_EQ(summary.find(trust), std::string::npos);
    }
  const auto summary = summary_of_necking("MPM", false);
  EXPECT_NE(summary.find(localises), std::string::npos);
  EXPECT_NE(summary.find(trust), std::string::npos);
}


// Each body once, by name, and only where its yield stress falls; in the same
// words by a run in two parts.
TEST(PlasticFlowMpi, SofteningIsTold)
{
  const std::string path =
    std::string(IMPM_SCENES) + "/materials/softening_bar.prm";
  const int         id = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                                   static_cast<int>(getpid()));
  const std::string directory =
    testing::TempDir() + "impm_softening_" + std::to_string(id);
  const auto summary = [&](const std::string &hardening, const bool in_parts) {
    const auto go_on = [&](const unsigned int n_steps, const bool restart) {
      std::vector<std::string> overrides = {
        "Grid/Cells=11, 1",
        "General/Constants=h = 0.1",
        "Output/Checkpoints/Interval in steps=10",
        "Time/Largest number of steps=" + std::to_string(n_steps)};
      for (const std::string name : {"steel", "weak"})
        overrides.push_back("Materials/" + name + "/" + hardening);
      ParameterFile file(path, overrides, declare_file);
      Simulation<2> simulation(read_scene<2>(file.handler()),
                               CommandLine::Verbosity::quiet,
                               MPI_COMM_WORLD);
      simulation.run(directory, "test", "", {}, restart);
      MPI_Barrier(MPI_COMM_WORLD);
    };
    if (in_parts)
      go_on(10, false);
    go_on(20, in_parts);
    const auto text = content_of(directory + "/summary.json");
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
    MPI_Barrier(MPI_COMM_WORLD);
    return text;
  };
  const std::string falls = "Softening modulus=2e9",
                    stays = "Softening modulus=0", told = "'middle' softens";
  for (const bool in_parts : {false, true})
    {
      const auto text  = summary(falls, in_parts);
      const auto first = text.find(told);
      ASSERT_NE(first, std::string::npos) << text;
      EXPECT_EQ(text.find(told, first + 1), std::string::npos) << text;
    }
  EXPECT_EQ(summary(stays, false).find("softens"), std::string::npos);
}
