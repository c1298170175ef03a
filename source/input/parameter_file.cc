#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/input/parameter_file.h>
#include <impm/input/parameter_messages.h>

#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace impm
{
  namespace
  {
    std::vector<std::string>
    split_path(const std::string &path)
    {
      return dealii::Utilities::split_string_list(path, '/');
    }

    /** `Section/Name=value` as the lines of a parameter file. */
    std::string
    override_as_text(const std::string &override)
    {
      const auto equal = override.find('=');
      if (equal == std::string::npos)
        throw InputError("",
                         "--set " + override +
                           ": found no '=', allowed is Section/Name=value");
      auto              path = split_path(override.substr(0, equal));
      const std::string name = path.back();
      path.pop_back();
      std::string text;
      for (const auto &section : path)
        text += "subsection " + section + "\n";
      text += "set " + name + " = " + override.substr(equal + 1) + "\n";
      for (unsigned int i = 0; i < path.size(); ++i)
        text += "end\n";
      return text;
    }

    std::vector<std::string>
    path_of(const std::string &override)
    {
      return split_path(override.substr(0, override.find('=')));
    }

    std::string
    read_text(const std::string &file_name)
    {
      if (!std::ifstream(file_name))
        throw InputError("",
                         "cannot read the parameter file '" + file_name + "'");
      return content_of(file_name);
    }

    void
    parse(dealii::ParameterHandler &prm,
          const std::string        &text,
          const std::string        &name,
          const bool                strict)
    {
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

    /** The value of an entry, if it has been declared. */
    std::string
    look_up(dealii::ParameterHandler &prm,
            const std::string        &path,
            const std::string        &fallback)
    {
      auto              sections = split_path(path);
      const std::string name     = sections.back();
      sections.pop_back();
      for (unsigned int i = 0; i < sections.size(); ++i)
        if (prm.subsection_path_exists(std::vector<std::string>(
              sections.begin(), sections.begin() + i + 1)) == false)
          return fallback;
      try
        {
          // what is not declared reads as "" where deal.II does not check
          const std::string value = prm.get(sections, name);
          return value.empty() ? fallback : value;
        }
      catch (const dealii::ParameterHandler::ExcEntryUndeclared &)
        {
          return fallback;
        }
    }
  } // namespace

  namespace
  {
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
             boost::algorithm::ends_with(path, "/Points from");
    }

    std::set<std::vector<std::string>>
    declared_entries(const dealii::ParameterHandler &prm)
    {
      std::ostringstream listing;
      prm.print_parameters(listing,
                           dealii::ParameterHandler::ShortPRM |
                             dealii::ParameterHandler::KeepDeclarationOrder);
      std::set<std::vector<std::string>> entries;
      for_each_entry(listing.str(),
                     [&](const std::vector<std::string> &path,
                         unsigned int,
                         const bool is_subsection) {
                       if (!is_subsection)
                         entries.insert(path);
                     });
      return entries;
    }
  } // namespace

  ParameterFile::ParameterFile(const std::string              &file_name,
                               const std::vector<std::string> &overrides,
                               const Declare                  &declare)
    : file_name(file_name)
    , overrides(overrides)
  {
    sources.push_back({file_name, read_text(file_name)});
    read_scene_of_study();

    // Lists of names, then what each name chooses, then what that choice
    // declares (a union may name other shapes), then what a choice among that
    // declares (the constants of a law): four readings find them.
    const unsigned int n_readings = 4;
    prm = std::make_unique<dealii::ParameterHandler>();
    for (unsigned int reading = 1; reading <= n_readings; ++reading)
      {
        const auto before   = std::move(prm);
        prm                 = std::make_unique<dealii::ParameterHandler>();
        const Chosen chosen = chosen_in(*before);
        declare(*prm, chosen);
        if (reading == n_readings)
          {
            dealii::ParameterHandler others;
            declare(others,
                    [&](const std::string &path, const std::string &fallback) {
                      return is_method(path) ? "any" : chosen(path, fallback);
                    });
            drop_idle_entries(others);
          }
        read(*prm, reading == n_readings);
      }
  }

  void
  ParameterFile::read_scene_of_study()
  {
    dealii::ParameterHandler handler;
    handler.enter_subsection("Study");
    handler.declare_entry("Scene", "");
    handler.leave_subsection();
    parse(handler, sources.back().text, file_name, false);
    const std::string scene = look_up(handler, "Study/Scene", "");
    if (scene.empty())
      return;
    const auto name =
      (std::filesystem::path(file_name).parent_path() / scene).string();
    const auto fail = [&](const std::string &message) {
      throw InputError("", locate("Study/Scene") + ": " + message);
    };
    if (!std::ifstream(name))
      fail(
        "entry 'Study/Scene': found '" + scene +
        "', allowed is the path of a parameter file from here; cannot read '" +
        name + "'");
    const std::string text = read_text(name);
    for_each_entry(
      text,
      [&](const std::vector<std::string> &path, const unsigned int line, bool) {
        if (path[0] == "Study")
          fail("entry 'Study/Scene': found '" + scene +
               "', which has in line " + std::to_string(line) +
               " a section Study of its own, allowed is a scene without");
      });
    sources.insert(sources.begin(), {name, text});
  }

  void
  ParameterFile::drop_idle_entries(const dealii::ParameterHandler &others)
  {
    const auto active = declared_entries(*prm), all = declared_entries(others);
    const auto is_idle = [&](const std::vector<std::string> &path) {
      return active.count(path) == 0 && all.count(path) > 0;
    };
    const auto warn = [&](const std::string              &place,
                          const std::vector<std::string> &path) {
      std::string name;
      for (const auto &part : path)
        name += (name.empty() ? "" : "/") + part;
      warnings.push_back(place + ": entry '" + name +
                         "' does nothing in this scene");
    };
    for (auto &source : sources)
      {
        std::set<unsigned int> idle;
        for_each_entry(source.text,
                       [&](const std::vector<std::string> &path,
                           const unsigned int              line,
                           const bool                      is_subsection) {
                         if (is_subsection || !is_idle(path))
                           return;
                         idle.insert(line);
                         warn("file " + source.name + ", line " +
                                std::to_string(line),
                              path);
                       });
        // Lines stay where they are, for messages that count them.
        std::istringstream in(source.text);
        std::string        line, kept;
        for (unsigned int number = 1; std::getline(in, line); ++number)
          kept += (idle.count(number) > 0 ? "" : line) + "\n";
        source.text = kept;
      }
    const auto end = std::remove_if(overrides.begin(),
                                    overrides.end(),
                                    [&](const std::string &override) {
                                      const auto path = path_of(override);
                                      if (!is_idle(path))
                                        return false;
                                      warn("--set " + override, path);
                                      return true;
                                    });
    overrides.erase(end, overrides.end());
  }

  void
  ParameterFile::read(dealii::ParameterHandler &prm, const bool strict) const
  {
    for (const auto &source : sources)
      parse(prm, source.text, source.name, strict);
    for (const auto &override : overrides)
      {
        if (path_of(override) == split_path("Study/Scene"))
          throw InputError("", "--set " + override + ": only a file sets it");
        parse(prm, override_as_text(override), "--set " + override, strict);
      }
  }

  std::string
  ParameterFile::resolved(const std::vector<std::string> &without) const
  {
    std::stringstream all;
    prm->print_parameters(all,
                          dealii::ParameterHandler::ShortPRM |
                            dealii::ParameterHandler::KeepDeclarationOrder);
    // Only sections of the top are not indented.
    std::string text, line;
    bool        skips = false;
    while (std::getline(all, line))
      {
        if (line.rfind("subsection ", 0) == 0)
          skips = std::count(without.begin(),
                             without.end(),
                             line.substr(std::strlen("subsection "))) > 0;
        if (!skips)
          text += line + "\n";
      }
    return text;
  }

  std::string
  ParameterFile::locate(const std::string &path) const
  {
    const auto wanted = split_path(path);
    for (auto override = overrides.rbegin(); override != overrides.rend();
         ++override)
      if (path_of(*override) == wanted)
        return "--set " + *override;

    std::string place;
    for (const auto &source : sources)
      for_each_entry(source.text,
                     [&](const std::vector<std::string> &here,
                         const unsigned int              line,
                         bool) {
                       if (here == wanted)
                         place = "file " + source.name + ", line " +
                                 std::to_string(line);
                     });
    return place.empty() ? "file " + file_name + " (entry not set there)" :
                           place;
  }

  ParameterFile::Chosen
  chosen_in(dealii::ParameterHandler &prm)
  {
    return [&prm](const std::string &path, const std::string &fallback) {
      return look_up(prm, path, fallback);
    };
  }

  std::vector<std::string>
  split_names(const std::string &list)
  {
    std::vector<std::string> names;
    for (const auto &name : dealii::Utilities::split_string_list(list))
      if (!name.empty())
        names.push_back(name);
    return names;
  }

  void
  in_section(dealii::ParameterHandler    &prm,
             const std::string           &path,
             const std::function<void()> &action)
  {
    const auto sections = split_path(path);
    for (const auto &section : sections)
      prm.enter_subsection(section);
    const auto leave = [&]() {
      for (unsigned int i = 0; i < sections.size(); ++i)
        prm.leave_subsection();
    };
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        leave();
        throw InputError(error.entry.empty() ? path : path + "/" + error.entry,
                         error.what());
      }
    catch (...)
      {
        leave();
        throw;
      }
    leave();
  }

  void
  declare_text(dealii::ParameterHandler &prm,
               const std::string        &entry,
               const std::string        &documentation)
  {
    prm.declare_entry(entry, "", dealii::Patterns::Anything(), documentation);
  }

  std::vector<double>
  get_numbers(const dealii::ParameterHandler &prm,
              const std::string              &entry,
              const unsigned int              n)
  {
    const auto values =
      dealii::Utilities::string_to_double(split_names(prm.get(entry)));
    if (values.size() != n)
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
