#include <impm/app/command_line.h>
#include <impm/app/version.h>
#include <impm/base/exceptions.h>

#include <boost/algorithm/string/trim.hpp>
#include <boost/program_options.hpp>

#include <algorithm>

namespace impm
{
  namespace options = boost::program_options;

  const char *const help =
    R"(usage: impm_dealii [options] FILE.prm
  --set "Section/Sub/Name=value"  override an entry (repeatable)
  -o, --output DIR    where results go (default: the file's own entry,
                      else output/<name of the prm>)
  --restart           go on from the last checkpoint in the directory of
                      results, with the same scene
  --continue          the same where there is one, else begin
  --check             parse, validate, print the scene, its point fields
                      and bytes per point; run nothing
  --study             run the file's Study section; with --check, list its runs
  --print-parameters[=text|json|markdown]  every entry with default, range,
                      unit and meaning; with FILE.prm those of the scene, with
                      its values: the text reads back. Pages of markdown go
                      into DIR
  -q, --quiet | -v, --verbose
  --version, -h, --help
Values may also follow '=': --output=DIR.
Exit code: 0 done; 1 bad input; 2 the computation could not go on; 3 the
system failed; 130, 143, 138 stopped by SIGINT, SIGTERM, SIGUSR1, after the step
and its checkpoint (a second signal stops at once). Parallel: mpirun -np N
impm_dealii ..., to be stopped by SIGUSR1.
)";

  namespace
  {
    /** The options in their order; words without one are called "file". */
    std::vector<options::option>
    parse(const int argc, const char *const *argv)
    {
      options::options_description known;
      auto                         add = known.add_options();
      for (const char *flag : {"restart",
                               "continue",
                               "check",
                               "study",
                               "quiet,q",
                               "verbose,v",
                               "version",
                               "help,h"})
        add(flag, "");
      for (const char *name : {"set", "output,o", "print-parameters", "file"})
        add(name, options::value<std::string>());
      options::positional_options_description files;
      files.add("file", -1);
      using options::command_line_style::style_t;
      // An option whose value may be left out would take the next word for it.
      std::vector<std::string> words(argv + 1, argv + argc);
      std::replace(words.begin(),
                   words.end(),
                   std::string("--print-parameters"),
                   std::string("--print-parameters=text"));
      return options::command_line_parser(words)
        .options(known)
        .positional(files)
        .style(style_t::allow_long | style_t::allow_short |
               style_t::allow_dash_for_short | style_t::long_allow_next |
               style_t::long_allow_adjacent | style_t::short_allow_next |
               style_t::short_allow_adjacent)
        .run()
        .options;
    }
  } // namespace

  CommandLine
  parse_command_line(const int argc, const char *const *argv)
  {
    const auto refuse = [](const std::string &what) {
      throw InputError("", what + "; see --help");
    };
    std::vector<options::option> found;
    try
      {
        found = parse(argc, argv);
      }
    catch (const options::unknown_option &error)
      {
        refuse("unknown option '" + error.get_option_name() + "'");
      }
    catch (const options::error &error)
      {
        refuse(error.what());
      }

    CommandLine line;
    for (const auto &option : found)
      {
        const auto &name  = option.string_key;
        const auto  value = option.value.empty() ? "" : option.value[0];
        if (name == "set")
          line.overrides.push_back(value);
        else if (name == "output" && value.empty())
          refuse("found --output without a directory");
        else if (name == "output")
          line.output_directory = value;
        else if (name == "restart")
          line.restart = true;
        else if (name == "continue")
          line.goes_on = true;
        else if (name == "check")
          line.check = true;
        else if (name == "study")
          line.study = true;
        else if (name == "print-parameters")
          line.listing = value;
        else if (name == "quiet")
          line.verbosity = CommandLine::Verbosity::quiet;
        else if (name == "verbose")
          line.verbosity = CommandLine::Verbosity::verbose;
        else if (name == "version")
          line.answer =
            boost::trim_right_copy(std::string("impm_dealii ") + version + ' ' +
                                   git_revision) + // none outside of git
            '\n';
        else if (name == "help")
          line.answer = help;
        else if (line.parameter_file.empty())
          line.parameter_file = value;
        else
          refuse("found a second parameter file '" + value +
                 "', allowed is one");
      }
    if (!line.listing.empty() && line.listing != "text" &&
        line.listing != "json" && line.listing != "markdown")
      refuse("found --print-parameters=" + line.listing +
             ", allowed are text, json, markdown");
    if (line.listing == "markdown" && line.output_directory.empty())
      refuse("--print-parameters=markdown wants a directory: --output DIR");
    if (line.answer.empty() && line.listing.empty() &&
        line.parameter_file.empty())
      refuse("no parameter file");
    if ((line.restart || line.goes_on) && line.study)
      throw InputError("",
                       "--restart or --continue of a --study: it keeps the "
                       "runs that are done anyway");
    return line;
  }
} // namespace impm
