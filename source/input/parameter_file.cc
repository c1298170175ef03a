#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/input/parameter_file.h>
#include <impm/input/parameter_messages.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

namespace impm
{
  using boost::algorithm::istarts_with;
  using dealii::ParameterHandler;
  using Path = std::vector<std::string>;

  namespace
  {
    Path
    split_path(const std::string &path)
    {
      return dealii::Utilities::split_string_list(path, '/');
    }

    /** `Section/Name=value` as the text of a parameter file. */
    std::string
    override_as_text(const std::string &override)
    {
      const auto refuse = [&](const std::string &why) {
        throw InputError("", "--set " + override + ": " + why);
      };
      const auto equal = override.find('=');
      const auto path  = split_path(override.substr(0, equal));
      if (equal == std::string::npos)
        refuse("found no '=', allowed is Section/Name=value");
      if (path.empty())
        refuse("found no name, allowed is Section/Name=value");
      if (path == split_path("Study/Scene"))
        refuse("only a file sets it");
      std::string text =
        "set " + path.back() + " = " + override.substr(equal + 1) + "\n";
      for (auto section = path.rbegin() + 1; section != path.rend(); ++section)
        text = "subsection " + *section + "\n" + text + "end\n";
      return text;
    }

    /** Refuses what ParameterHandler would take, and should not, here and in
     * the files that are included. `above` are those that include this one. */
    void
    check_lines(const std::string    &text,
                const std::string    &name,
                std::set<std::string> above = {})
    {
      std::error_code ignored;
      above.insert(std::filesystem::weakly_canonical(name, ignored).string());
      const auto lines = split(text, '\n');
      for (unsigned int i = 0; i < lines.size(); ++i)
        {
          const auto refuse = [&](const std::string &allowed) {
            throw InputError("",
                             place_of(name, i + 1) + ": found '" + lines[i] +
                               "', allowed " + allowed);
          };
          if (istarts_with(lines[i], "include ") ||
              istarts_with(lines[i], "include\t"))
            {
              const std::string other =
                dealii::Utilities::trim(lines[i].substr(8));
              // It would read on for ever.
              if (above.count(std::filesystem::weakly_canonical(other, ignored)
                                .string()) > 0)
                refuse("is a file that does not include this one");
              std::ifstream      in(other);
              std::ostringstream all;
              if (std::filesystem::is_regular_file(other, ignored) &&
                  all << in.rdbuf())
                check_lines(all.str(), other, above);
            }
          // It would find a number here, and fail to read it.
          const auto words = split(lines[i].substr(0, lines[i].find('#')), '=');
          if (words.size() == 2 && is_too_small(words[1]))
            refuse("are 0 and numbers that are not as small");
        }
    }

    void
    parse(ParameterHandler  &prm,
          const std::string &text,
          const std::string &name,
          const bool         strict)
    {
      check_lines(text, name);
      std::istringstream in(text);
      try
        {
          prm.parse_input(in, name, "", !strict);
        }
      catch (dealii::ExceptionBase &exception)
        {
          throw InputError("", describe_error(exception, text, prm));
        }
    }

    /** Choices between methods for one and the same problem. */
    bool
    is_method(const std::string &path)
    {
      static const std::set<std::string> methods = {"Grid/Method",
                                                    "Time/Integrator",
                                                    "Time/Formulation",
                                                    "Time/CFL number",
                                                    "Solver/Nonlinear solver",
                                                    "Solver/Convergence",
                                                    "Solver/Linear solver",
                                                    "Solver/Operator"};
      return methods.count(path) > 0 ||
             split_path(path).back() == "Points from";
    }

    /** Also false for a directory, which opens as a file. */
    bool
    has_text(const std::string &file_name)
    {
      return std::ifstream(file_name).peek() !=
             std::ifstream::traits_type::eof();
    }

    std::set<Path>
    declared_entries(const ParameterHandler &prm)
    {
      std::set<Path> entries;
      for (const auto &line : lines_of(text_of(prm)))
        if (!line.is_subsection)
          entries.insert(line.path);
      return entries;
    }
  } // namespace

  ParameterFile::ParameterFile(
    const std::string                                             &file_name,
    const std::vector<std::string>                                &overrides,
    const std::function<void(ParameterHandler &, const Chosen &)> &declare)
    : file_name(file_name)
  {
    if (!has_text(file_name))
      throw InputError("",
                       "cannot read the parameter file '" + file_name +
                         "', or it is empty");
    sources.push_back({file_name, content_of(file_name)});
    read_scene_of_study();
    for (const auto &override : overrides)
      sources.push_back({"--set " + override, override_as_text(override)});

    // Lists of names, then what each name chooses, then what that choice
    // declares (a union may name other shapes), then what a choice among that
    // declares (the constants of a law): four readings find them.
    const unsigned int n_readings = 4;
    prm                           = std::make_unique<ParameterHandler>();
    for (unsigned int reading = 1; reading <= n_readings; ++reading)
      {
        const bool strict = reading == n_readings;
        const auto before =
          std::exchange(prm, std::make_unique<ParameterHandler>());
        const Chosen chosen = chosen_in(*before);
        declare(*prm, chosen);
        if (strict)
          {
            ParameterHandler others;
            declare(others,
                    [&](const std::string &path, const std::string &fallback) {
                      return is_method(path) ? "any" : chosen(path, fallback);
                    });
            drop_idle_entries(others);
          }
        for (const auto &source : sources)
          parse(*prm, source.text, source.name, strict);
      }
  }

  void
  ParameterFile::read_scene_of_study()
  {
    ParameterHandler handler;
    in_section(handler, "Study", [&]() { handler.declare_entry("Scene", ""); });
    parse(handler, sources.back().text, file_name, false);
    const std::string scene = chosen_in(handler)("Study/Scene", "");
    if (scene.empty())
      return;
    const auto refuse = [&](const std::string &why) {
      throw InputError("",
                       locate("Study/Scene") +
                         ": entry 'Study/Scene': found '" + scene + "', " +
                         why);
    };
    const auto name =
      (std::filesystem::path(file_name).parent_path() / scene).string();
    if (!has_text(name))
      refuse(
        "allowed is the path of a parameter file from here; cannot read '" +
        name + "', or it is empty");
    const std::string text = content_of(name);
    for (const auto &line : lines_of(text))
      if (line.path[0] == "Study")
        refuse("which has in line " + std::to_string(line.number) +
               " a section Study of its own, allowed is a scene without");
    sources.insert(sources.begin(), {name, text});
  }

  void
  ParameterFile::drop_idle_entries(const ParameterHandler &others)
  {
    const auto active = declared_entries(*prm), all = declared_entries(others);
    for (auto &source : sources)
      {
        // Lines stay where they are, for messages that count them.
        auto kept = split(source.text, '\n');
        for (const auto &line : lines_of(source.text))
          if (active.count(line.path) == 0 && all.count(line.path) > 0)
            {
              kept[line.number - 1].clear();
              warnings.push_back(place_of(source.name, line.number) +
                                 ": entry '" + join(line.path, "/") +
                                 "' does nothing in this scene");
            }
        source.text = join(kept, "\n");
      }
  }

  std::string
  ParameterFile::resolved(const std::vector<std::string> &without) const
  {
    std::istringstream all(text_of(*prm));
    // Only sections of the top are not indented.
    const std::string keyword = "subsection ";
    std::string       text, line;
    bool              skips = false;
    while (std::getline(all, line))
      {
        if (line.rfind(keyword, 0) == 0)
          skips = std::count(without.begin(),
                             without.end(),
                             line.substr(keyword.size())) > 0;
        if (!skips)
          text += line + "\n";
      }
    return text;
  }

  std::string
  ParameterFile::locate(const std::string &path) const
  {
    const Path  wanted = split_path(path);
    std::string place  = "file " + file_name + " (entry not set there)";
    for (const auto &source : sources)
      for (const auto &line : lines_of(source.text))
        if (line.path == wanted)
          place = place_of(source.name, line.number);
    return place;
  }

  std::string
  ParameterFile::describe(const InputError &error) const
  {
    return (error.entry.empty() ?
              "" :
              locate(error.entry) + ": entry '" + error.entry + "': ") +
           error.what();
  }

  ParameterFile::Chosen
  chosen_in(ParameterHandler &prm)
  {
    return [&prm](const std::string &path, const std::string &fallback) {
      auto              sections = split_path(path);
      const std::string name     = sections.back();
      sections.pop_back();
      if (!prm.subsection_path_exists(sections))
        return fallback;
      try
        {
          // what is not declared reads as "" where deal.II does not check
          const std::string value = prm.get(sections, name);
          return value.empty() ? fallback : value;
        }
      catch (const ParameterHandler::ExcEntryUndeclared &)
        {
          return fallback;
        }
    };
  }

  std::vector<std::string>
  split_names(const std::string &list)
  {
    auto names = split(list, ',');
    names.erase(std::remove(names.begin(), names.end(), ""), names.end());
    return names;
  }

  void
  in_section(ParameterHandler            &prm,
             const std::string           &path,
             const std::function<void()> &action)
  {
    const auto sections = split_path(path);
    for (const auto &section : sections)
      prm.enter_subsection(section);
    // Leaves them again, whatever happens.
    const std::shared_ptr<void> leave(nullptr, [&](void *) {
      for (unsigned int i = 0; i < sections.size(); ++i)
        prm.leave_subsection();
    });
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        throw InputError(error.entry.empty() ? path : path + "/" + error.entry,
                         error.what());
      }
  }

  void
  declare_text(ParameterHandler  &prm,
               const std::string &entry,
               const std::string &documentation)
  {
    prm.declare_entry(entry, "", dealii::Patterns::Anything(), documentation);
  }

  std::vector<double>
  get_numbers(const ParameterHandler &prm,
              const std::string      &entry,
              const unsigned int      n)
  {
    const auto          words = split_names(prm.get(entry));
    std::vector<double> values;
    try
      {
        values = dealii::Utilities::string_to_double(words);
      }
    catch (const dealii::ExceptionBase &)
      {
        // one of them is no number
      }
    if (values.size() != n ||
        !std::all_of(values.begin(), values.end(), [](const double value) {
          return std::isfinite(value);
        }))
      throw InputError(entry,
                       "found '" + prm.get(entry) + "', allowed are " +
                         std::to_string(n) + " numbers");
    return values;
  }

  void
  require_name(const std::vector<std::string> &allowed,
               const std::string              &found,
               const std::string              &entry)
  {
    if (std::count(allowed.begin(), allowed.end(), found) == 0)
      throw InputError(entry,
                       "found '" + found + "', allowed are: " +
                         (allowed.empty() ? "none" : join(allowed, ", ")));
  }
} // namespace impm
