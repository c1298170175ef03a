#include <impm/base/exceptions.h>
#include <impm/run/restart_check.h>
#include <impm/run/signals.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  namespace fs = std::filesystem;

  // A directory that all ranks share, and that goes with its scope.
  struct Directory
  {
    explicit Directory(const std::string &kind)
      : name(
          testing::TempDir() + "impm_restart_" + kind + "_" +
          std::to_string(Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                                   static_cast<int>(getpid()))))
    {
      remove();
    }

    ~Directory()
    {
      remove();
    }

    void
    remove() const
    {
      MPI_Barrier(MPI_COMM_WORLD);
      std::error_code ignored;
      fs::remove_all(name, ignored);
      MPI_Barrier(MPI_COMM_WORLD);
    }

    const std::string name;
  };

  std::string
  last_good(const Directory &directory)
  {
    std::string name;
    std::ifstream(directory.name + "/checkpoint/last_good") >> name;
    return name;
  }

  // What a run on the first ranks leaves.
  struct Left
  {
    Columns        history;
    nlohmann::json summary;
    /** Checksums of the points and nodes in the last checkpoint, whose bits
     * the history does not show. */
    std::vector<nlohmann::json> bits;
  };

  template <int dim>
  Left
  run_on(const unsigned int n_ranks,
         const Scene<dim>  &scene,
         const Directory   &directory,
         const bool         restart)
  {
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    MPI_Comm           communicator;
    MPI_Comm_split(MPI_COMM_WORLD,
                   rank < n_ranks ? 0 : MPI_UNDEFINED,
                   rank,
                   &communicator);
    if (rank < n_ranks)
      {
        Simulation<dim>(scene, CommandLine::Verbosity::quiet, communicator)
          .run(directory.name, "test", "", {}, restart);
        MPI_Comm_free(&communicator);
      }
    MPI_Barrier(MPI_COMM_WORLD);
    std::ifstream     file(directory.name + "/summary.json");
    const std::string last = last_good(directory);
    std::ifstream     about(directory.name + "/checkpoint/" + last + ".json");
    const auto        sums = nlohmann::json::parse(about).at("checksums");
    Left              left{read_history(directory.name),
              nlohmann::json::parse(file),
              {sums.at(last + ".grid_variable.data"),
                            sums.at(last + ".grid_fixed.data")}};
    MPI_Barrier(MPI_COMM_WORLD);
    return left;
  }

  // A byte of it changes.
  void
  damage(const Directory &directory, const std::string &checkpoint)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        const auto name =
          directory.name + "/checkpoint/" + checkpoint + ".state";
        std::fstream file(name, std::ios::in | std::ios::out);
        file.seekp(fs::file_size(name) / 2);
        file << '#';
      }
    MPI_Barrier(MPI_COMM_WORLD);
  }

  void
  expect_equal(const Left &whole, const Left &parts)
  {
    EXPECT_EQ(whole.bits, parts.bits);
    for (const auto &[name, values] : whole.history)
      if (name != "wall_seconds")
        {
          EXPECT_EQ(parts.history.at(name), values) << name;
        }
    for (const std::string name : {"newton_iterations",
                                   "linear_iterations",
                                   "tangents",
                                   "linear_solver",
                                   "stress_evaluations",
                                   "figures",
                                   "warnings",
                                   "steps"})
      EXPECT_EQ(whole.summary.contains(name) ? whole.summary.at(name) : "",
                parts.summary.contains(name) ? parts.summary.at(name) : "")
        << name;
    for (const std::string name : {"value", "reference", "error"})
      for (unsigned int i = 0; i < whole.summary.at("errors").size(); ++i)
        EXPECT_EQ(whole.summary.at("errors")[i].at(name),
                  parts.summary.at("errors")[i].at(name));
  }

  /**
   * A scene of some ten steps whole; in two parts, where the second one starts
   * from the last but one checkpoint, since the last is damaged; and on other
   * numbers of ranks.
   */
  template <int dim>
  Left
  expect_restarts(const std::string &kind, const Overrides &overrides)
  {
    SCOPED_TRACE("..., " + overrides.back());
    const Overrides checkpoints = {"Output/Checkpoints/Interval in steps=2"};
    const auto      scene       = [&](const unsigned int n_steps) {
      return scene_from<dim>(block_scene(kind),
                             overrides + checkpoints +
                               Overrides{"Time/Largest number of steps=" +
                                         std::to_string(n_steps)});
    };
    const unsigned int n = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const auto whole = run_on<dim>(n, scene(1000), Directory("whole"), false);
    EXPECT_GE(whole.history.at("step").size(), 8u);
    {
      const Directory directory("parts");
      run_on<dim>(n, scene(5), directory, false);
      damage(directory, last_good(directory));
      expect_equal(whole, run_on<dim>(n, scene(1000), directory, true));
    }
    if (n > 1)
      {
        const Directory directory("ranks");
        run_on<dim>(n, scene(3), directory, false);
        run_on<dim>(1, scene(5), directory, true);
        expect_near(whole.history,
                    run_on<dim>(2, scene(1000), directory, true).history,
                    // what is left of large figures
                    {"transfer_loss", "energy_gain"});
      }
    return whole;
  }

  const Overrides pressed = {"Boundary conditions/left/Type=slip",
                             "Boundary conditions/bottom/Type=fixed",
                             "Boundary conditions/top/Type=displacement",
                             "Boundary conditions/top/Value=0; -0.35*t",
                             "Grid/Upper corner=1.7, 1",
                             "Grid/Cells=10, 6",
                             "Time/Time step=0.1",
                             "Solver/Newton tolerance=1e-9",
                             "Output/Probes=corner, width",
                             "Output/corner/Kind=point",
                             "Output/corner/Position=1, 1",
                             "Output/width/Kind=extent",
                             "Output/Reactions=load",
                             "Output/load/On=top",
                             "Output/load/Direction=0, 1"};

  const Overrides top_moves_the_grid = {
    "Boundary conditions/top/Moves the grid=true"};

  // The block flies to the right.
  const Overrides flies = {"Grid/Upper corner=2, 1",
                           "Grid/Cells=16, 8",
                           "Bodies/block/Velocity=0.7; 0.1*sin(3*x)",
                           "Boundary conditions/bottom/Type=slip",
                           "Boundary conditions/top/Type=slip",
                           "Time/Time step=0.1",
                           "Solver/Newton tolerance=1e-9"};

  Overrides
  plate(const std::string &lower,
        const std::string &upper,
        const std::string &displacement)
  {
    return {"Geometry/Shapes=box, plate",
            "Geometry/plate/Lower corner=" + lower,
            "Geometry/plate/Upper corner=" + upper,
            "Bodies/Names=block, plate",
            "Bodies/plate/Kind=rigid",
            "Bodies/plate/Shape=plate",
            "Bodies/plate/Displacement=" + displacement,
            "Boundary conditions/left/Type=slip",
            "Boundary conditions/bottom/Type=slip",
            "Time/Time step=0.1",
            "Solver/Newton tolerance=1e-9",
            "Output/Reactions=load",
            "Output/load/On=plate",
            "Output/load/Direction=0, 1"};
  }
} // namespace


TEST(RestartMpi, GridThatFollowsAFace)
{
  expect_restarts<2>("plane strain", pressed + top_moves_the_grid);
  expect_restarts<2>("plane strain",
                     pressed + top_moves_the_grid + plastic +
                       Overrides{"Grid/Method=GIMP",
                                 "Solver/Nonlinear solver=BFGS",
                                 "Solver/Newton tolerance=1e-12"});
}

// Whose length depends on the step before.
TEST(RestartMpi, StepsThatAreControlled)
{
  const Overrides by_error = {"Time/Step control=error",
                              "Time/Error tolerance=0.003"};
  expect_restarts<2>("plane strain", pressed + top_moves_the_grid + by_error);
  expect_restarts<2>("plane strain", flies + with_inertia + by_error);
  expect_restarts<2>("plane strain",
                     pressed + top_moves_the_grid +
                       Overrides{"Time/Step control=iterations",
                                 "Time/Wanted iterations=3"});
}

// Cells that come and go, points that split and merge.
TEST(RestartMpi, AdaptedGrid)
{
  const Overrides adapting = {"Grid/Method=GIMP",
                              "Bodies/block/Point adaptation=split and merge",
                              "Bodies/block/Points per cell=3",
                              "Grid/Adaptation/Criteria=surface",
                              "Grid/Adaptation/surface/Kind=free surface",
                              "Grid/Adaptation/Highest level=1"};
  const auto      whole =
    expect_restarts<2>("plane strain", flies + with_inertia + adapting);
  EXPECT_GT(whole.history.at("splits").back() +
              whole.history.at("splits").front(),
            0.);
  const auto &dofs = whole.history.at("dofs");
  EXPECT_NE(*std::min_element(dofs.begin(), dofs.end()),
            *std::max_element(dofs.begin(), dofs.end()));
}

// In the middle between two resets of a grid whose face has moved.
TEST(RestartMpi, GridThatIsMoved)
{
  const Overrides seldom = {"Grid/Reset=interval",
                            "Grid/Steps between resets=3"};
  expect_restarts<2>("plane strain",
                     pressed + top_moves_the_grid + plastic + seldom);
  expect_restarts<2>("axisymmetric",
                     pressed + top_moves_the_grid + with_inertia + seldom +
                       Overrides{"Grid/Method=GIMP",
                                 "Bodies/block/Point adaptation=split",
                                 "Grid/Adaptation/Criteria=surface",
                                 "Grid/Adaptation/surface/Kind=free surface"});
  const auto whole = expect_restarts<2>("plane strain",
                                        flies + with_inertia + seldom +
                                          Overrides{"Time/Transfer=APIC",
                                                    "Grid/Method=GIMP",
                                                    "Grid/Largest motion=3"});
  EXPECT_EQ(whole.summary.at("grid_resets"), 3);
}

TEST(RestartMpi, ApicDynamics)
{
  expect_restarts<2>("plane strain",
                     flies + with_inertia +
                       Overrides{"Time/Transfer=APIC", "Time/Theta=0.5"});
  expect_restarts<2>("plane strain",
                     flies + Overrides{"Time/Integrator=explicit",
                                       "Grid/Method=GIMP"});
}

TEST(RestartMpi, ThreeDimensions)
{
  expect_restarts<3>("3D",
                     with_inertia +
                       Overrides{"Grid/Method=GIMP",
                                 "Grid/Upper corner=2, 1.5, 1",
                                 "Grid/Cells=4, 3, 2",
                                 "Bodies/block/Velocity=0.9; 0.3*sin(3*x); 0",
                                 "Boundary conditions/bottom/Type=slip",
                                 "Solver/Newton tolerance=1e-9",
                                 "Time/Time step=0.1"});
}

TEST(RestartMpi, RigidPoints)
{
  expect_restarts<2>("plane strain",
                     plate("0, 1", "1.5, 1.25", "0; -0.3*t") +
                       Overrides{"Grid/Upper corner=1.5, 1.5",
                                 "Grid/Cells=6, 6"});
}

TEST(RestartMpi, LagrangianGridThatSticksToARigidBox)
{
  const auto box = plate("-1, 1.15", "3, 2", "0; -0.5*t") +
                   Overrides{"Grid/Method=Lagrangian"};
  const auto whole = expect_restarts<2>("plane strain", box);
  EXPECT_EQ(whole.history.at("load").front(), 0.);
  EXPECT_GT(whole.history.at("load").back(), 0.);
  expect_restarts<2>("plane strain", box + refined + with_inertia);
  expect_restarts<2>("plane strain",
                     box + plastic +
                       Overrides{"Grid/Map=x + 0.4*x*(1 - x)*y; y"});
}

TEST(RestartMpi, ReferencesWithMaxima)
{
  const auto whole =
    expect_restarts<2>("plane strain",
                       pressed + top_moves_the_grid +
                         Overrides{"Reference/Names=u, f, g",
                                   "Reference/u/Field=displacement",
                                   "Reference/u/Expression=0; -0.35*t*y",
                                   "Reference/u/When=largest",
                                   "Reference/f/Kind=curve",
                                   "Reference/f/Column=load",
                                   "Reference/f/Expression=t",
                                   "Reference/g/Kind=probe",
                                   "Reference/g/Of=width",
                                   "Reference/g/Value=1.2"});
  EXPECT_EQ(whole.summary.at("errors").size(), 3u);
}

TEST(RestartMpi, OfARunThatIsDone)
{
  const Directory    directory("done");
  const unsigned int n = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  // A restart may compare with something else.
  const auto scene = [](const std::string &end, const std::string &reference) {
    const std::string section = "Reference/" + reference;
    return scene_from<2>(block_scene("plane strain"),
                         pressed + Overrides{"Time/End time=" + end,
                                             "Reference/Names=" + reference,
                                             section + "/Field=volume",
                                             section + "/Expression=1",
                                             section + "/When=largest"});
  };
  const auto whole = run_on<2>(n, scene("0.3", "u"), directory, false);
  expect_equal(whole, run_on<2>(n, scene("0.3", "u"), directory, true));
  const auto longer = run_on<2>(n, scene("0.5", "v"), directory, true);
  EXPECT_EQ(longer.summary.at("errors").size(), 1u);
  EXPECT_EQ(longer.history.at("step").size(), 5u);
  EXPECT_EQ(longer.summary.at("status"), "done");
}

TEST(RestartMpi, ASignalIsObeyedByAll)
{
  const Directory    directory("signal");
  const unsigned int n = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const auto         scene =
    scene_from<2>(block_scene("plane strain"), pressed + top_moves_the_grid);
  const auto whole = run_on<2>(n, scene, directory, false);
  // To one rank alone, as it happens.
  catch_signals();
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == n - 1)
    std::raise(SIGTERM);
  try
    {
      Simulation<2>(scene, CommandLine::Verbosity::quiet, MPI_COMM_WORLD)
        .run(directory.name, "test", "");
      FAIL() << "goes on";
    }
  catch (const Interruption &interruption)
    {
      EXPECT_EQ(interruption.signal, SIGTERM);
    }
  catch_signals(); // forgets it
  EXPECT_EQ(read_history(directory.name).at("step").size(), 1u);
  MPI_Barrier(MPI_COMM_WORLD);
  expect_equal(whole, run_on<2>(n, scene, directory, true));
}

TEST(RestartCheck, NamesWhatMustNotChange)
{
  const auto text = [](const std::string &end, const std::string &ratio) {
    return "subsection Time\n  set End time = " + end +
           "\nend\nsubsection Materials\n  subsection rubber\n"
           "    set Poisson's ratio = " +
           ratio + "\n  end\nend\n";
  };
  EXPECT_NO_THROW(check_restart(text("1", "0.3"), text("2", "0.3")));
  try
    {
      check_restart(text("1", "0.3"), text("1", "0.4"));
      FAIL() << "is taken";
    }
  catch (const InputError &error)
    {
      EXPECT_EQ(error.entry, "Materials/rubber/Poisson's ratio");
      EXPECT_NE(std::string(error.what()).find("'0.4'"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("'0.3'"), std::string::npos);
    }
}
