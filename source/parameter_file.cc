#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/exceptions.h>
#include <impm/parameter_file.h>
#include <impm/parameter_messages.h>

#include <algorithm>
#include <cstring>
#include <fstream>
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
          return prm.get(sections, name);
        }
      catch (const dealii::ParameterHandler::ExcEntryUndeclared &)
        {
          return fallback;
        }
    }
  } // namespace

  ParameterFile::ParameterFile(const std::string              &file_name,
                               const std::vector<std::string> &overrides,
                               const Declare                  &declare)
    : file_name(file_name)
    , overrides(overrides)
  {
    std::ifstream file(file_name);
    if (!file)
      throw InputError("",
                       "cannot read the parameter file '" + file_name + "'");
    std::ostringstream content;
    content << file.rdbuf();
    text = content.str();

    // Lists of names, then what each name chooses, then what that choice
    // declares (a union may name other shapes): three readings find them.
    const unsigned int n_readings = 3;
    prm = std::make_unique<dealii::ParameterHandler>();
    for (unsigned int reading = 1; reading <= n_readings; ++reading)
      {
        const auto before = std::move(prm);
        prm               = std::make_unique<dealii::ParameterHandler>();
        declare(*prm,
                [&](const std::string &path, const std::string &fallback) {
                  return look_up(*before, path, fallback);
                });
        read(reading == n_readings);
      }
  }

  void
  ParameterFile::read(const bool strict)
  {
    const auto parse = [&](const std::string &input, const std::string &name) {
      std::istringstream in(input);
      try
        {
          prm->parse_input(in, name, "", !strict);
        }
      catch (dealii::ExceptionBase &exception)
        {
          throw InputError("", describe_error(exception, input, *prm));
        }
    };
    parse(text, file_name);
    for (const auto &override : overrides)
      parse(override_as_text(override), "--set " + override);
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
    for (auto override = overrides.rbegin(); override != overrides.rend();
         ++override)
      if (split_path(override->substr(0, override->find('='))) ==
          split_path(path))
        return "--set " + *override;

    const auto  wanted = split_path(path);
    std::string place;
    for_each_entry(
      text,
      [&](const std::vector<std::string> &here, const unsigned int line, bool) {
        if (here == wanted)
          place = "file " + file_name + ", line " + std::to_string(line);
      });
    return place.empty() ? "file " + file_name + " (entry not set there)" :
                           place;
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
} // namespace impm
