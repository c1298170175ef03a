#include <impm/app/version.h>
#include <impm/base/exceptions.h>
#include <impm/run/simulation.h>
#include <impm/study/finer_run.h>
#include <impm/study/study_report.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    struct Task
    {
      std::string name, directory, parameters;
      Scene<dim>  scene;
      bool        is_there; ///< complete, and of the same parameters
    };
  } // namespace

  template <int dim>
  FinerRuns
  make_finer_runs(const std::vector<ReferenceSpec<dim>> &references,
                  const CommandLine                     &line,
                  const std::string                     &directory)
  {
    const MPI_Comm         communicator = MPI_COMM_WORLD;
    std::vector<Task<dim>> tasks;
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    for (const auto &spec : references)
      if (spec.kind == ReferenceKind::finer_run)
        try
          {
            auto overrides = line.overrides;
            overrides.insert(overrides.end(),
                             spec.overrides.begin(),
                             spec.overrides.end());
            ParameterFile file(line.parameter_file, overrides, declare_file);
            if (scene_dimension(file.handler()) != dim)
              throw InputError("", "found another dimension, allowed is one");
            Task<dim> task{spec.name,
                           spec.directory.empty() ?
                             directory + "/reference_" + spec.name :
                             spec.directory,
                           file.resolved({"Reference", "Study"}),
                           read_scene<dim>(file.handler()),
                           false};
            task.scene.references.clear();
            const auto columns = History<dim>::column_names(task.scene);
            auto       wanted  = spec.columns;
            wanted.push_back(spec.against);
            for (const auto &column : wanted)
              if (std::count(columns.begin(), columns.end(), column) == 0)
                throw InputError("", "the finer run has no '" + column + "'");
            task.is_there =
              Utilities::MPI::broadcast(communicator,
                                        first && kept_result(task.directory,
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
                             "in the finer run, " +
                               (error.entry.empty() ?
                                  "" :
                                  "entry '" + error.entry + "': ") +
                               error.what());
          }

    FinerRuns runs;
    if (line.check)
      return runs;
    Console console(line.verbosity, first);
    for (const auto &task : tasks)
      {
        const std::string reference = "reference '" + task.name + "'";
        if (!task.is_there)
          try
            {
              console.message(reference + ": finer run in " + task.directory);
              Simulation<dim>(task.scene,
                              CommandLine::Verbosity::quiet,
                              communicator)
                .run(task.directory, task.name, task.parameters);
            }
          catch (const Interruption &interruption)
            {
              throw Interruption(interruption.signal,
                                 "in the finer run of " + reference +
                                   ", which will start anew",
                                 false);
            }
          catch (const ComputationError &error)
            {
              throw ComputationError("the finer run of " + reference + " in " +
                                     task.directory + ": " + error.what());
            }
        if (!first)
          continue;
        try
          {
            const auto result = read_result(task.directory).value();
            runs[task.name] = {read_csv_table(task.directory + "/history.csv"),
                               result.wall_seconds};
            if (task.is_there)
              console.message(reference + ": finer run found in " +
                              task.directory +
                              (result.revision == git_revision ?
                                 "" :
                                 ", made by another revision of the program"));
          }
        catch (const std::exception &error)
          {
            // On this rank alone.
            throw SystemError(reference + ": " + error.what());
          }
      }
    return runs;
  }

  template FinerRuns
  make_finer_runs(const std::vector<ReferenceSpec<2>> &,
                  const CommandLine &,
                  const std::string &);
  template FinerRuns
  make_finer_runs(const std::vector<ReferenceSpec<3>> &,
                  const CommandLine &,
                  const std::string &);
} // namespace impm
