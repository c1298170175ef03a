#include "run_scene.h"

#include <impm/study/study.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace impm
{
  Columns
  read_history(const std::string &directory)
  {
    std::ifstream            file(directory + "/history.csv");
    std::string              line, field;
    std::vector<std::string> names;
    Columns                  columns;
    std::getline(file, line);
    std::istringstream header(line);
    while (std::getline(header, field, ','))
      names.push_back(field);
    while (std::getline(file, line))
      {
        std::istringstream row(line);
        for (const auto &name : names)
          if (std::getline(row, field, ','))
            columns[name].push_back(std::stod(field));
      }
    return columns;
  }

  void
  expect_near(const Columns               &one,
              const Columns               &other,
              const std::set<std::string> &left_out)
  {
    for (const auto &[name, values] : one)
      {
        if (name == "wall_seconds" || name == "residual" ||
            name == "imbalance" ||
            name.find("iterations") != std::string::npos ||
            name == "line_searches" || name == "noise_stops" ||
            left_out.count(name) > 0)
          continue;
        const auto &others = other.at(name);
        ASSERT_EQ(others.size(), values.size());
        double largest = 0, error = 0;
        for (unsigned int i = 0; i < values.size(); ++i)
          {
            largest = std::max(largest, std::abs(values[i]));
            error   = std::max(error, std::abs(values[i] - others[i]));
          }
        // Momentum across an axis of symmetry is round-off.
        if (largest > 1e-12)
          {
            EXPECT_LT(error / largest, 1e-7) << name;
          }
      }
  }

  template <int dim>
  Columns
  run(const Scene<dim>                &scene,
      const MPI_Comm                   communicator,
      const std::string               &directory,
      std::unique_ptr<GridPolicy<dim>> policy)
  {
    Simulation<dim> simulation(scene,
                               CommandLine::Verbosity::quiet,
                               communicator,
                               std::move(policy));
    simulation.run(directory, "test", "");
    MPI_Barrier(MPI_COMM_WORLD);
    const auto columns = read_history(directory);
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
    MPI_Barrier(MPI_COMM_WORLD);
    return columns;
  }

  template <int dim>
  Columns
  run_file(const std::string &name, const std::vector<std::string> &overrides)
  {
    auto all = overrides;
    all.push_back("Output/Pictures=false");
    const std::string path = std::string(IMPM_SCENES) + "/" + name + ".prm";
    ParameterFile     file(path, all, declare_file);
    const int         id =
      dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                        static_cast<int>(getpid()));
    return run(read_scene<dim>(file.handler()),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_run_" + std::to_string(id));
  }

  template Columns
  run(const Scene<2> &,
      const MPI_Comm,
      const std::string &,
      std::unique_ptr<GridPolicy<2>>);
  template Columns
  run(const Scene<3> &,
      const MPI_Comm,
      const std::string &,
      std::unique_ptr<GridPolicy<3>>);
  template Columns
  run_file<2>(const std::string &, const std::vector<std::string> &);
  template Columns
  run_file<3>(const std::string &, const std::vector<std::string> &);
} // namespace impm
