#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/study/study_process.h>

#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/exe.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/io.hpp>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace impm
{
  namespace
  {
    std::vector<std::string>
    command(const std::string &directory,
            const CommandLine &line,
            const StudyRun    &run)
    {
      std::vector<std::string> words;
      if (run.ranks > 1)
        // env looks for it along the path.
        words = {"/usr/bin/env", "mpirun", "-np", std::to_string(run.ranks)};
      words.insert(words.end(),
                   {std::filesystem::read_symlink("/proc/self/exe").string(),
                    line.parameter_file,
                    "--quiet",
                    "--output",
                    directory});
      for (const auto *overrides : {&line.overrides, &run.overrides})
        for (const auto &override : *overrides)
          words.insert(words.end(), {"--set", override});
      return words;
    }

    /** Why a run failed: its own last message, or what came first. */
    std::string
    reason(const std::string &log)
    {
      std::istringstream in(log);
      std::string        line, message, first;
      const std::string  own = "impm_dealii: ";
      std::getline(in, line); // the command
      while (std::getline(in, line))
        if (line.rfind(own + "warning: ", 0) == 0)
          continue;
        else if (line.rfind(own, 0) == 0)
          message = line.substr(own.size());
        // mpirun draws lines of dashes.
        else if (first.empty() &&
                 line.find_first_not_of("- \t\r") != std::string::npos)
          first = line;
      if (message.empty() && first.empty())
        return "no message";
      return message.empty() ? first : message;
    }
  } // namespace

  StudyResult
  run_process(const std::string &directory,
              const CommandLine &line,
              const StudyRun    &run)
  {
    namespace process = boost::process;
    const auto words  = command(directory, line, run);

    // A summary from before must not be taken for this run's.
    std::error_code ignored;
    std::filesystem::create_directories(directory, ignored);
    std::filesystem::remove(directory + "/summary.json", ignored);
    const std::string log = directory + "/log.txt";
    std::ofstream     out(log);
    for (const auto &word : words)
      out << std::quoted(word) << ' ';
    out << std::endl;
    FILE *append = out ? std::fopen(log.c_str(), "a") : nullptr;
    if (!append)
      throw SystemError("cannot write '" + log + "'");
    process::child child(
      process::exe  = words[0],
      process::args = std::vector<std::string>(words.begin() + 1, words.end()),
      (process::std_out & process::std_err) > append,
      process::std_in < process::null,
      // It does not go on when the study is killed.
      process::extend::on_exec_setup = [](auto &) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
      });
    std::fclose(append);
    child.wait();

    auto      result = read_result(directory).value_or(StudyResult());
    const int state  = child.native_exit_code();
    if (WIFSIGNALED(state))
      {
        result.exit_code = 128 + WTERMSIG(state); // as a shell has it
        result.status    = std::string("killed: ") + strsignal(WTERMSIG(state));
        return result;
      }
    result.exit_code = WEXITSTATUS(state);
    if (result.exit_code != 0 || !result.done())
      result.status = reason(content_of(log));
    return result;
  }

  std::optional<StudyResult>
  kept_result(const std::string &directory,
              const std::string &parameters,
              const unsigned int ranks)
  {
    const auto result = read_result(directory);
    if (!result || !result->done() || result->ranks != ranks ||
        content_of(directory + "/parameters.prm") != parameters)
      return {};
    return result;
  }

  bool
  is_started_by_mpi()
  {
    return std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE");
  }
} // namespace impm
