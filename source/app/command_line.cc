#include <impm/app/command_line.h>
#include <impm/app/version.h>
#include <impm/base/exceptions.h>

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
    options::variables_map
    parse(const int argc, const char *const *argv)
    {
      options::options_description known;
      auto                         add = known.add_options();
      for (const char *flag : {"restart",
                               "check",
                               "study",
                               "quiet,q",
                               "verbose,v",
                               "version",
                               "help,h"})
        add(flag, "");
      add("print-parameters", options::value<std::string>());
      for (const char *name : {"set", "output,o", "file"})
        add(name, options::value<std::vector<std::string>>());
      options::positional_options_description files;
      files.add("file", -1);
      using options::command_line_style::style_t;
      // An option whose value may be left out would take the next word for it.
      std::vector<std::string> words(argv + 1, argv + argc);
      std::replace(words.begin(),
                   words.end(),
                   std::string("--print-parameters"),
                   std::string("--print-parameters=text"));
      options::variables_map found;
      options::store(options::command_line_parser(words)
                       .options(known)
                       .positional(files)
                       .style(style_t::allow_long | style_t::allow_short |
                              style_t::allow_dash_for_short |
                              style_t::long_allow_next |
                              style_t::long_allow_adjacent |
                              style_t::short_allow_next |
                              style_t::short_allow_adjacent)
                       .run(),
                     found);
      return found;
    }
  } // namespace

  CommandLine
  parse_command_line(const int argc, const char *const *argv)
  {
    const auto refuse = [](const std::string &what) {
      throw InputError("", what + "; see --help");
    };
    options::variables_map found;
    try
      {
        found = parse(argc, argv);
      }
    catch (const options::unknown_option &error)
      {
        refuse("unknown option '" + error.get_option_name() + "'");
      }
    catch (const options::multiple_occurrences &error)
      {
        refuse("found '" + error.get_option_name() + "' twice");
      }
    catch (const options::error &error)
      {
        refuse(error.what());
      }
    const auto has = [&](const std::string &name) {
      return found.count(name) > 0;
    };
    const auto text = [&](const std::string &name) {
      return has(name) ? found[name].as<std::string>() : "";
    };
    const auto texts = [&](const std::string &name) {
      return has(name) ? found[name].as<std::vector<std::string>>() :
                         std::vector<std::string>();
    };

    CommandLine line;
    line.overrides = texts("set");
    line.check     = has("check");
    line.study     = has("study");
    line.restart   = has("restart");
    line.listing   = text("print-parameters");
    line.verbosity = has("verbose") ? CommandLine::Verbosity::verbose :
                     has("quiet")   ? CommandLine::Verbosity::quiet :
                                      CommandLine::Verbosity::normal;
    if (has("output"))
      line.output_directory = texts("output").back();
    if (has("version"))
      line.answer =
        std::string("impm_dealii ") + version + ' ' + git_revision + '\n';
    if (has("help"))
      line.answer = help;
    const auto files = texts("file");
    if (files.size() > 1)
      refuse("found a second parameter file '" + files[1] +
             "', allowed is one");
    if (!files.empty())
      line.parameter_file = files[0];
    if (!line.listing.empty() && line.listing != "text" &&
        line.listing != "json" && line.listing != "markdown")
      refuse("found --print-parameters=" + line.listing +
             ", allowed are text, json, markdown");
    if (line.listing == "markdown" && line.output_directory.empty())
      refuse("--print-parameters=markdown wants a directory: --output DIR");
    if (has("output") && line.output_directory.empty())
      refuse("found --output without a directory");
    if (has("quiet") && has("verbose"))
      refuse("found --quiet and --verbose, allowed is one of both");
    if (line.answer.empty() && line.listing.empty() &&
        line.parameter_file.empty())
      refuse("no parameter file");
    if (line.restart && line.study)
      throw InputError("",
                       "--restart of a --study: it keeps the runs that are "
                       "done anyway");
    return line;
  }
} // namespace impm
