#ifndef run_scene_h
#define run_scene_h

#include <impm/run/simulation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

// Runs of a scene for the tests, and what they leave in history.csv.
namespace
{
  using Columns = std::map<std::string, std::vector<double>>;

  inline Columns
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

  /** Of runs on different numbers of ranks. How Newton's method got there may
   * depend on round-off, the imbalance does on the ranks. */
  inline void
  expect_near(const Columns               &one,
              const Columns               &other,
              const std::set<std::string> &left_out = {})
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
  run(const impm::Scene<dim> &scene,
      const MPI_Comm          communicator,
      const std::string      &directory)
  {
    impm::Simulation<dim> simulation(scene,
                                     impm::CommandLine::Verbosity::quiet,
                                     communicator);
    simulation.run(directory, "test", "");
    MPI_Barrier(MPI_COMM_WORLD);
    const auto columns = read_history(directory);
    MPI_Barrier(MPI_COMM_WORLD);
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
    MPI_Barrier(MPI_COMM_WORLD);
    return columns;
  }
} // namespace

#endif
