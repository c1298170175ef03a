#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  std::string
  path_of_run()
  {
    return "/tmp/impm_test_history_" +
           std::to_string(
             Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                       static_cast<int>(getpid())));
  }

  // One finite element, pressed in one direction and free in the others.
  Overrides
  press(const unsigned int dim, const unsigned int axis)
  {
    Overrides overrides = {"Grid/Method=Lagrangian",
                           dim == 3 ? "Grid/Cells=1, 1, 1" : "Grid/Cells=1, 1",
                           "Time/Time step=0.25"};
    for (unsigned int d = 0; d < dim; ++d)
      overrides.push_back("Boundary conditions/" + face_names()[2 * d] +
                          "/Type=slip");
    const auto face = "Boundary conditions/" + face_names()[2 * axis + 1] + "/";
    overrides.push_back(face + "Type=normal displacement");
    overrides.push_back(face + "Value=-0.2*t");
    return overrides;
  }

  const Overrides heat = {"Materials/rubber/Specific heat=0.5",
                          "Materials/rubber/Initial temperature=300",
                          "Materials/rubber/Density=3"};

  Overrides
  mean(const std::string &field)
  {
    return {"Output/" + field + "/Kind=mean",
            "Output/" + field + "/Field=" + field};
  }
} // namespace


// In uniaxial stress tau = Y + H alpha = E (e - alpha) for a logarithmic strain
// e, and all the plastic work, Y alpha + H alpha^2 / 2, heats.
TEST(HistoryMpi, TemperatureAndInternalEnergy)
{
  const double e = -std::log(0.8), Y = 0.02, H = 0.1;
  const double alpha = (e - Y) / (1 + H), tau = Y + H * alpha;
  const double work   = Y * alpha + H * alpha * alpha / 2;
  const double stored = tau * tau / 2;
  const auto   check  = [&](const Columns &columns, const double volume) {
    EXPECT_NEAR(columns.at("temperature").front(),
                300 + (Y * (0.05129329438755058 - Y) / 1.1 +
                       H * std::pow((0.05129329438755058 - Y) / 1.1, 2) / 2) /
                        (3 * 0.5),
                1e-9);
    EXPECT_NEAR(columns.at("temperature").back(), 300 + work / (3 * 0.5), 1e-9);
    EXPECT_NEAR(columns.at("internal_energy").back(),
                (stored + work) / 3,
                1e-11);
    EXPECT_NEAR(columns.at("internal_energy").back() *
                  columns.at("mass").back(),
                columns.at("strain_energy").back() +
                  columns.at("plastic_work").back(),
                1e-12);
    EXPECT_NEAR(columns.at("plastic_work").back(), work * volume, 1e-10);
  };
  const Overrides probes =
    mean("temperature") + mean("internal_energy") +
    Overrides{"Output/Probes=temperature, internal_energy"};
  check(run(scene_from<3>(block_scene("3D"),
                          press(3, 1) + plastic + heat + probes),
            MPI_COMM_WORLD,
            path_of_run()),
        1);
  check(run(scene_from<2>(block_scene("axisymmetric"),
                          press(2, 1) + plastic + heat + probes),
            MPI_COMM_WORLD,
            path_of_run()),
        numbers::PI);
}


// Of a law without a history, rows have the energy that the step has found, and
// probes that of the points.
TEST(HistoryMpi, EnergyOfTheStepIsThatOfThePoints)
{
  for (const std::string geometry : {"plane strain", "plane stress"})
    for (const std::string law : {"log-strain elastic", "neo-Hookean"})
      {
        SCOPED_TRACE(geometry + ", " + law);
        const auto columns =
          run(scene_from<2>(block_scene(geometry),
                            press(2, 1) + mean("internal_energy") +
                              Overrides{"Materials/rubber/Law=" + law,
                                        "Output/Probes=internal_energy"}),
              MPI_COMM_WORLD,
              path_of_run());
        EXPECT_GT(columns.at("strain_energy").back(), 1e-3);
        for (unsigned int row = 0; row < columns.at("mass").size(); ++row)
          EXPECT_NEAR(columns.at("internal_energy")[row] *
                        columns.at("mass")[row],
                      columns.at("strain_energy")[row],
                      1e-11 * columns.at("strain_energy")[row]);
      }
}


TEST(HistoryMpi, TemperatureNeedsSpecificHeats)
{
  const auto refusal = [](const Overrides &overrides) -> std::string {
    try
      {
        const auto scene =
          scene_from<2>(block_scene("plane strain"), overrides);
        const Simulation<2> simulation(scene,
                                       CommandLine::Verbosity::quiet,
                                       MPI_COMM_WORLD);
      }
    catch (const InputError &error)
      {
        return error.entry + ": " + error.what();
      }
    return "";
  };
  const Overrides probe =
    mean("temperature") + Overrides{"Output/Probes=temperature"};
  EXPECT_NE(refusal(probe).find("Output/temperature/Field: found "
                                "'temperature', which needs a 'Specific heat'"),
            std::string::npos);
  EXPECT_EQ(refusal(probe + heat), "");
  EXPECT_NE(
    refusal({"Materials/rubber/Specific heat=-1"}).find("greater than 0"),
    std::string::npos);
  // Without it there is none, and pictures leave it out.
  EXPECT_EQ(refusal({"Materials/rubber/Initial temperature=1"}), "");
  EXPECT_EQ(refusal({"Output/Pictures=true",
                     "Output/Point fields=temperature, volume"}),
            "");
}


TEST(HistoryMpi, RowsEveryFewSteps)
{
  const Overrides upset = press(2, 1) + plastic +
                          Overrides{"Time/Time step=0.125",
                                    "Output/Probes=top",
                                    "Output/top/Kind=extent",
                                    "Output/top/Component=1",
                                    "Output/Reactions=load",
                                    "Output/load/On=top",
                                    "Output/load/Direction=0, 1"};
  const auto scene = [&](const Overrides &more) {
    return scene_from<2>(block_scene("plane strain"), upset + more);
  };
  const auto all = run(scene({}), MPI_COMM_WORLD, path_of_run());
  const auto some =
    run(scene({"Output/Steps between rows=3"}), MPI_COMM_WORLD, path_of_run());
  ASSERT_EQ(all.at("step").size(), 8u);
  ASSERT_EQ(some.at("step"), std::vector<double>({3, 6, 8}));
  for (const auto &[name, values] : all)
    {
      if (name == "wall_seconds")
        continue;
      const bool is_count = name.find("iterations") != std::string::npos ||
                            name == "line_searches" || name == "step_cuts" ||
                            name == "tangent_projections" ||
                            name == "solver_fallbacks" || name == "noise_stops";
      std::vector<double> expected(3);
      for (unsigned int i = 0; i < 8; ++i)
        expected[i / 3] = is_count ? expected[i / 3] + values[i] : values[i];
      EXPECT_EQ(some.at(name), expected) << name;
    }
  EXPECT_GT(some.at("newton_iterations").front(), 3.);
  // also where the number of steps ends the run
  EXPECT_EQ(run(scene({"Output/Steps between rows=3",
                       "Time/Largest number of steps=4"}),
                MPI_COMM_WORLD,
                path_of_run())
              .at("step"),
            std::vector<double>({3, 4}));
}


TEST(History, CountsAddUp)
{
  StepReport sum, step;
  step.newton_iterations = 1;
  step.linear_iterations = 2;
  step.line_searches     = 3;
  step.step_cuts         = 4;
  step.projections       = 5;
  step.solver_fallbacks  = 6;
  step.noise_stops       = 7;
  step.held_cells        = 8;
  for (step.step = 1; step.step < 4; ++step.step)
    sum.append(step);
  EXPECT_EQ(sum.step, 3u);
  EXPECT_EQ(sum.newton_iterations, 3u);
  EXPECT_EQ(sum.linear_iterations, 6u);
  EXPECT_EQ(sum.line_searches, 9u);
  EXPECT_EQ(sum.step_cuts, 12u);
  EXPECT_EQ(sum.projections, 15u);
  EXPECT_EQ(sum.solver_fallbacks, 18u);
  EXPECT_EQ(sum.noise_stops, 21u);
  EXPECT_EQ(sum.held_cells, 8u);
}
