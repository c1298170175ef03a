#include <impm/app/command_line.h>
#include <impm/app/version.h>
#include <impm/base/exceptions.h>
#include <impm/input/parameter_messages.h>

namespace impm
{
  const char *const help =
    R"(usage: impm_dealii [options] FILE.prm
  --set "Section/Sub/Name=value"  override an entry (repeatable)
  --output DIR        where results go (default: the file's own entry,
                      else output/<name of the prm>)
  --restart           go on from the last checkpoint in the directory of
                      results, with the same scene
  --check             parse, validate, print the scene, its point fields
                      and bytes per point; run nothing
  --study             run the file's Study section; with --check, list its runs
  --print-parameters  every entry with default, range, unit and meaning
  --quiet | --verbose
  --version, --help
Exit code: 0 done; 1 bad input; 2 the computation could not go on; 3 the
system failed; 130, 143, 138 stopped by SIGINT, SIGTERM, SIGUSR1, after the step
and its checkpoint (a second signal stops at once). Parallel: mpirun -np N
impm_dealii ..., to be stopped by SIGUSR1.
)";

  CommandLine
  parse_command_line(const int argc, const char *const *argv)
  {
    CommandLine line;
    for (int i = 1; i < argc; ++i)
      {
        const std::string word  = argv[i];
        const auto        value = [&]() -> std::string {
          if (i + 1 == argc)
            throw InputError("", word + " wants a value behind it");
          return argv[++i];
        };
        if (word == "--set")
          line.overrides.push_back(value());
        else if (word == "--output")
          line.output_directory = value();
        else if (word == "--check")
          line.check = true;
        else if (word == "--print-parameters")
          line.answer = parameter_listing();
        else if (word == "--version")
          line.answer =
            std::string("impm_dealii ") + version + ' ' + git_revision + '\n';
        else if (word == "--help" || word == "-h")
          line.answer = help;
        else if (word == "--quiet")
          line.verbosity = CommandLine::Verbosity::quiet;
        else if (word == "--verbose")
          line.verbosity = CommandLine::Verbosity::verbose;
        else if (word == "--study")
          line.study = true;
        else if (word == "--restart")
          line.restart = true;
        else if (word.rfind("-", 0) == 0)
          throw InputError("", "unknown option '" + word + "'; see --help");
        else if (line.parameter_file.empty())
          line.parameter_file = word;
        else
          throw InputError("",
                           "found a second parameter file '" + word +
                             "', allowed is one");
      }
    if (line.answer.empty() && line.parameter_file.empty())
      throw InputError("", "no parameter file; see --help");
    if (line.restart && line.study)
      throw InputError("",
                       "--restart of a --study: it keeps the runs that are "
                       "done anyway");
    return line;
  }
} // namespace impm
