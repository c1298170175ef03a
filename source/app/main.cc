#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/mpi.h>

#include <impm/app/console.h>
#include <impm/app/mpi_start.h>
#include <impm/app/version.h>
#include <impm/base/exceptions.h>
#include <impm/input/parameter_pages.h>
#include <impm/run/checkpoint_files.h>
#include <impm/run/signals.h>
#include <impm/run/simulation.h>
#include <impm/study/finer_run.h>
#include <impm/study/study.h>

#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <sstream>

namespace
{
  using namespace impm;

  /** The words of a command as a shell takes them. */
  std::string
  quoted(const std::vector<std::string> &words)
  {
    std::string command;
    for (const auto &word : words)
      {
        const bool is_plain =
          std::all_of(word.begin(), word.end(), [](const unsigned char letter) {
            return std::isalnum(letter) ||
                   std::string("_./=,:+-").find(letter) != std::string::npos;
          });
        command += command.empty() ? "" : " ";
        command += is_plain && !word.empty() ?
                     word :
                     "'" + boost::replace_all_copy(word, "'", "'\\''") + "'";
      }
    return command;
  }

  /** What goes on with a run that was stopped. */
  std::string
  command_to_go_on(const int          argc,
                   const char *const *argv,
                   const bool         from_checkpoint)
  {
    std::vector<std::string> words(argv, argv + argc);
    if (from_checkpoint &&
        std::count(words.begin(), words.end(), "--restart") == 0 &&
        std::count(words.begin(), words.end(), "--continue") == 0)
      words.push_back("--restart");
    // A study does without.
    const auto n = dealii::Utilities::MPI::job_supports_mpi() ?
                     dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) :
                     1;
    if (n > 1)
      words.insert(words.begin(), {"mpirun", "-np", std::to_string(n)});
    return quoted(words);
  }

  template <int dim>
  void
  run(const CommandLine &line, ParameterFile &file)
  {
    Scene<dim> scene = read_scene<dim>(file.handler());
    scene.warnings.insert(scene.warnings.begin(),
                          file.warnings.begin(),
                          file.warnings.end());
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      for (const auto &warning : scene.warnings)
        std::cerr << "impm_dealii: warning: " << warning << std::endl;
    const std::string name =
      std::filesystem::path(line.parameter_file).stem().string();
    std::string directory = line.output_directory;
    if (directory.empty())
      directory = scene.output.directory;
    if (directory.empty())
      directory = "output/" + name;

    catch_signals();
    Simulation<dim> simulation(scene, line.verbosity, MPI_COMM_WORLD);
    simulation.describe();
    const auto finer_runs = make_finer_runs(scene.references, line, directory);
    if (line.check)
      return;
    const bool restarts =
      line.restart ||
      (line.goes_on &&
       dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                         has_checkpoint(directory)));
    simulation.run(
      directory, name, file.resolved({"Study"}), finer_runs, restarts);
  }

  /** Before what may take long. */
  void
  announce(const CommandLine &line)
  {
    namespace mpi = dealii::Utilities::MPI;
    const auto n  = mpi::n_mpi_processes(MPI_COMM_WORLD);
    Console(line.verbosity, mpi::this_mpi_process(MPI_COMM_WORLD) == 0)
      .message(std::string("impm_dealii ") + version + ": " +
               line.parameter_file +
               (n > 1 ? ", on " + std::to_string(n) + " ranks" : ""));
  }

  void
  compute(const CommandLine &line)
  {
    if (line.study && is_started_by_mpi())
      throw InputError("",
                       "--study under mpirun: it starts its own processes; "
                       "allowed is an entry 'ranks' in a list of the study");
    if (!line.study)
      announce(line);
    ParameterFile file(line.parameter_file, line.overrides, declare_file);
    try
      {
        if (line.study)
          run_study(line, file);
        else if (scene_dimension(file.handler()) == 3)
          run<3>(line, file);
        else
          run<2>(line, file);
      }
    catch (const InputError &error)
      {
        // What is not finite may be behind another flaw.
        const auto flaw = line.study ? std::nullopt : find_flaw(MPI_COMM_WORLD);
        throw InputError("", file.describe(flaw ? *flaw : error));
      }
    catch (const ComputationError &error)
      {
        throw ComputationError(
          file.describe(InputError(error.entry, error.what())));
      }
  }

  /** Prints parameters, or writes pages of them, on one rank. */
  void
  list_parameters(const CommandLine &line)
  {
    std::vector<ListedEntry> entries;
    if (line.parameter_file.empty())
      entries = all_entries();
    else
      {
        ParameterFile file(line.parameter_file, line.overrides, declare_file);
        try
          {
            if (scene_dimension(file.handler()) == 3)
              read_scene<3>(file.handler());
            else
              read_scene<2>(file.handler());
          }
        catch (const InputError &error)
          {
            throw InputError("", file.describe(error));
          }
        for (const auto &warning : file.warnings)
          std::cerr << "impm_dealii: warning: " << warning << std::endl;
        entries = entries_of_scene(file);
      }
    if (line.listing == "markdown")
      write_pages(entries, line.output_directory);
    else
      std::cout << (line.listing == "json" ? as_json(entries) :
                                             as_text(entries));
  }
} // namespace

int
main(int argc, char **argv)
{
  std::optional<MpiSession>  mpi;
  dealii::ConditionalOStream errors(std::cerr);
  const bool                 is_alone = !is_started_by_mpi();
  if (!is_alone)
    {
      mpi.emplace(argv[0]);
      errors.set_condition(
        dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);
    }
  // A failure of one rank alone would leave the others waiting.
  const auto fail_alone = [&](const std::string &why) {
    std::cerr << "impm_dealii: system failure: " << why << std::endl;
    if (mpi && dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      MPI_Abort(MPI_COMM_WORLD, 3);
    return 3;
  };
  try
    {
      const CommandLine line = parse_command_line(argc, argv);
      // What needs no MPI does not wait for it, and what a study starts can
      // start it only if the study itself has not.
      const bool computes = line.answer.empty() && line.listing.empty();
      if (is_alone && computes && !line.study)
        {
          prepare_mpi_for_one_process();
          mpi.emplace(argv[0]);
        }
      if (computes)
        compute(line);
      else if (errors.is_active())
        {
          std::cout << line.answer;
          if (line.answer.empty())
            list_parameters(line);
        }
    }
  catch (const InputError &error)
    {
      errors << "impm_dealii: bad input: " << abridged(error.what())
             << std::endl;
      return 1;
    }
  catch (const Interruption &interruption)
    {
      errors << "impm_dealii: stopped by signal " << interruption.signal << ' '
             << interruption.what() << "; to go on: "
             << command_to_go_on(argc, argv, interruption.has_checkpoint)
             << std::endl;
      return 128 + interruption.signal;
    }
  catch (const ComputationError &error)
    {
      errors << "impm_dealii: the computation cannot go on: " << error.what()
             << std::endl;
      return 2;
    }
  catch (const dealii::ExceptionBase &error)
    {
      std::ostringstream info;
      error.print_info(info);
      return fail_alone(info.str());
    }
  catch (const std::bad_alloc &)
    {
      return fail_alone("out of memory");
    }
  catch (const std::exception &error)
    {
      return fail_alone(error.what());
    }
  return 0;
}
