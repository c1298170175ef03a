#include <impm/app/command_line.h>
#include <impm/base/exceptions.h>

namespace impm
{
  const char *
  command_line_help()
  {
    return "usage: impm_dealii [options] FILE.prm\n"
           "  --set \"Section/Sub/Name=value\"  override an entry (repeatable)\n"
           "  --output DIR        where results go (default: the file's own "
           "entry,\n"
           "                      else output/<name of the prm>)\n"
           "  --check             parse, validate, print the scene, its point "
           "fields\n"
           "                      and bytes per point; run nothing\n"
           "  --study             run the file's Study section; with --check, "
           "list its runs\n"
           "  --print-parameters  every entry with default, range, unit and "
           "meaning\n"
           "  --quiet | --verbose\n"
           "  --version, --help\n"
           "Exit code: 0 done; 1 bad input; 2 the computation could not go on; "
           "3 the\nsystem failed. Parallel: mpirun -np N impm_dealii ...\n";
  }

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
          line.action = CommandLine::Action::check;
        else if (word == "--print-parameters")
          line.action = CommandLine::Action::print_parameters;
        else if (word == "--version")
          line.action = CommandLine::Action::print_version;
        else if (word == "--help" || word == "-h")
          line.action = CommandLine::Action::print_help;
        else if (word == "--quiet")
          line.verbosity = CommandLine::Verbosity::quiet;
        else if (word == "--verbose")
          line.verbosity = CommandLine::Verbosity::verbose;
        else if (word == "--study")
          line.study = true;
        else if (word == "--restart")
          throw InputError("", word + " is not there yet in this version");
        else if (word.rfind("-", 0) == 0)
          throw InputError("", "unknown option '" + word + "'; see --help");
        else if (line.parameter_file.empty())
          line.parameter_file = word;
        else
          throw InputError("",
                           "found a second parameter file '" + word +
                             "', allowed is one");
      }
    const bool needs_file = line.action == CommandLine::Action::run ||
                            line.action == CommandLine::Action::check;
    if (needs_file && line.parameter_file.empty())
      throw InputError("", "no parameter file; see --help");
    return line;
  }
} // namespace impm
