#ifndef run_scene_h
#define run_scene_h

#include <impm/run/simulation.h>

#include <filesystem>
#include <map>
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
