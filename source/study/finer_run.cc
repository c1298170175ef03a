#include <impm/app/version.h>
#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/run/simulation.h>
#include <impm/study/finer_run.h>
#include <impm/study/study.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Null when there is none that can be read. */
    nlohmann::json
    summary_in(const std::string &directory)
    {
      return nlohmann::json::parse(content_of(directory + "/summary.json"),
                                   nullptr,
                                   false);
    }

    bool
    is_complete(const std::string &directory, const std::string &parameters)
    {
      const auto summary = summary_in(directory);
      return summary.is_object() && summary.value("status", "") == "done" &&
             content_of(directory + "/parameters.prm") == parameters;
    }
  } // namespace

  template <int dim>
  FinerRunner<dim>::FinerRunner(
    const std::vector<ReferenceSpec<dim>> &references,
    const CommandLine                     &line,
    const std::string                     &directory,
    const MPI_Comm                         communicator)
    : verbosity(line.verbosity)
    , communicator(communicator)
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    for (const auto &spec : references)
      if (spec.kind == ReferenceSpec<dim>::Kind::finer_run)
        try
          {
            auto overrides = line.overrides;
            overrides.insert(overrides.end(),
                             spec.overrides.begin(),
                             spec.overrides.end());
            ParameterFile file(line.parameter_file, overrides, declare_file);
            if (scene_dimension(file.handler()) != dim)
              throw InputError("", "found another dimension, allowed is one");
            Task task{spec.name,
                      spec.directory.empty() ?
                        directory + "/reference_" + spec.name :
                        spec.directory,
                      file.resolved({"Reference", "Study"}),
                      read_scene<dim>(file.handler(), line.parameter_file),
                      false};
            task.scene.references.clear();
            const auto columns =
              history_columns<dim>(task.scene.output, task.scene.geometry);
            auto wanted = spec.columns;
            wanted.push_back(spec.against);
            for (const auto &column : wanted)
              if (std::count(columns.begin(), columns.end(), column) == 0)
                throw InputError("", "the finer run has no '" + column + "'");
            task.is_there =
              Utilities::MPI::broadcast(communicator,
                                        first && is_complete(task.directory,
                                                             task.parameters));
            if (!task.is_there)
              Simulation<dim>(task.scene,
                              CommandLine::Verbosity::quiet,
                              communicator);
            tasks.push_back(std::move(task));
          }
        catch (const InputError &error)
          {
            throw InputError("Reference/" + spec.name + "/Overrides",
                             std::string("in the finer run, ") +
                               (error.entry.empty() ?
                                  std::string() :
                                  "entry '" + error.entry + "': ") +
                               error.what());
          }
  }

  template <int dim>
  FinerRuns
  FinerRunner<dim>::run() const
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    Console    console(verbosity, first);
    FinerRuns  runs;
    for (const auto &task : tasks)
      {
        const auto  summary = task.directory + "/summary.json";
        std::string revision;
        if (!task.is_there)
          {
            console.message("reference '" + task.name + "': finer run in " +
                            task.directory);
            // Or an old one would vouch for a run that is interrupted.
            std::error_code none;
            if (first)
              std::filesystem::remove(summary, none);
            Simulation<dim> simulation(task.scene,
                                       CommandLine::Verbosity::quiet,
                                       communicator);
            try
              {
                simulation.run(task.directory, task.name, task.parameters);
              }
            catch (const ComputationError &error)
              {
                throw ComputationError("the finer run of reference '" +
                                       task.name + "' in " + task.directory +
                                       ": " + error.what());
              }
          }
        if (!first)
          continue;
        try
          {
            const nlohmann::json json = summary_in(task.directory);
            runs[task.name] = {read_csv_table(task.directory + "/history.csv"),
                               json.at("wall_seconds").get<double>()};
            revision        = json.value("revision", "");
          }
        catch (const std::exception &error)
          {
            // On this rank alone.
            throw SystemError("reference '" + task.name + "': " + error.what());
          }
        if (task.is_there)
          console.message("reference '" + task.name + "': finer run found in " +
                          task.directory +
                          (revision == git_revision ?
                             "" :
                             ", made by another revision of the program"));
      }
    return runs;
  }

  template class FinerRunner<2>;
  template class FinerRunner<3>;
} // namespace impm
