#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/names.h>
#include <impm/input/parameter_file.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

namespace impm
{
  using dealii::ParameterHandler;

  namespace
  {
    std::vector<std::string>
    split_path(const std::string &path)
    {
      return dealii::Utilities::split_string_list(path, '/');
    }

    /** "Materials/steel" of "Materials/steel/Law". */
    std::string
    section_of(const std::string &path)
    {
      const auto slash = path.rfind('/');
      return slash == std::string::npos ? "" : path.substr(0, slash);
    }

    /** All sections in which entries or sections stand, the top as "". */
    template <typename Paths>
    std::set<std::string>
    sections_of(const Paths &paths)
    {
      std::set<std::string> sections;
      for (std::string path : paths)
        while (!path.empty() && sections.insert(section_of(path)).second)
          path = section_of(path);
      return sections;
    }

    std::vector<std::string>
    paths_of(const std::vector<ParameterEntry> &entries)
    {
      std::vector<std::string> paths;
      for (const auto &entry : entries)
        paths.push_back(entry.path);
      return paths;
    }

    /** Names of what stands in a section. */
    std::string
    names_within(const std::string              &section,
                 const std::vector<std::string> &all)
    {
      std::vector<std::string> names;
      for (const auto &path : all)
        if (!path.empty() && section_of(path) == section)
          names.push_back(
            path.substr(section.empty() ? 0 : section.size() + 1));
      return names.empty() ? "none" : join(names, ", ");
    }

    /** Whether a value is an integer, and too large for one. */
    bool
    is_beyond_integers(const std::string &value, const std::string &pattern)
    {
      return boost::starts_with(pattern, "[Integer") && value.size() > 9 &&
             std::all_of(value.begin(), value.end(), [](const unsigned char c) {
               return std::isdigit(c);
             });
    }

    bool
    is_switched_off(const std::string &path, const EntryValues &values)
    {
      for (auto section = section_of(path); !section.empty();
           section      = section_of(section))
        if (chosen_in(values)(section + "/Enabled", "") == "false")
          return true;
      return false;
    }
  } // namespace

  ParameterFile::ParameterFile(const std::string              &file_name,
                               const std::vector<std::string> &overrides,
                               const DeclareEntries           &declare)
    : file_name(file_name)
    , lines(read_parameter_text(file_name))
    , prm(std::make_unique<ParameterHandler>())
  {
    read_scene_of_study();
    for (const auto &override : overrides)
      {
        lines.push_back(parameter_override(override, file_name));
        if (join(lines.back().path, "/") == "Study/Scene")
          throw InputError("", lines.back().place() + ": only a file sets it");
      }
    EntryValues values;
    for (const auto &line : lines)
      if (!line.is_subsection)
        values[join(line.path, "/")] = line.value;
    declare(*prm, chosen_in(values));

    const auto                         entries = entries_of(*prm);
    std::map<std::string, std::string> patterns;
    for (const auto &entry : entries)
      patterns[entry.path] = entry.pattern;
    const auto     sections = sections_of(paths_of(entries));
    ParameterLines idle;
    for (auto line = lines.begin(); line != lines.end(); ++line)
      {
        const auto path = join(line->path, "/");
        const auto next = line + 1;
        if (!line->is_subsection && sections.count(path) > 0)
          throw InputError("",
                           line->place() + ": found entry '" + path +
                             "', which is no entry but a subsection; allowed "
                             "there are: " +
                             names_within(path, paths_of(entries)));
        // An empty section that has no entries does no harm.
        if (line->is_subsection && prm->subsection_path_exists(line->path) &&
            (next == lines.end() || next->path.size() <= line->path.size()))
          continue;
        if (line->is_subsection ? sections.count(path) == 0 :
                                  patterns.count(path) == 0)
          idle.push_back(*line);
        else if (!line->is_subsection)
          set(*line, patterns[path]);
      }
    for (const auto &entry : entries)
      if (boost::ends_with(entry.documentation, to_be_given) &&
          values.count(entry.path) == 0 && !is_switched_off(entry.path, values))
        warnings.push_back("entry '" + entry.path + "' is not given: " +
                           entry.default_value + " is taken");
    if (!idle.empty())
      judge(idle, values, entries, declare);
  }

  void
  ParameterFile::read_scene_of_study()
  {
    const ParameterLine *found = nullptr;
    for (const auto &line : lines)
      if (!line.is_subsection && join(line.path, "/") == "Study/Scene")
        found = &line;
    if (!found || found->value.empty())
      return;
    const auto refuse = [&](const std::string &why) {
      throw InputError("",
                       found->place() + ": entry 'Study/Scene': found '" +
                         found->value + "', " + why);
    };
    const auto name =
      (std::filesystem::path(found->file).parent_path() / found->value)
        .string();
    ParameterLines scene;
    try
      {
        scene = read_parameter_text(name);
      }
    catch (const InputError &error)
      {
        const std::string why = error.what();
        if (why.rfind("cannot read", 0) != 0)
          throw;
        refuse("allowed is the path of a parameter file from here: " + why);
      }
    for (const auto &line : scene)
      if (line.path[0] == "Study")
        refuse("which has a section Study of its own (" + line.place() +
               "), allowed is a scene without");
    lines.insert(lines.begin(), scene.begin(), scene.end());
  }

  void
  ParameterFile::set(const ParameterLine &line, const std::string &pattern)
  {
    const auto &name = line.path.back();
    for (unsigned int i = 0; i + 1 < line.path.size(); ++i)
      prm->enter_subsection(line.path[i]);
    try
      {
        prm->set(name, line.value);
      }
    catch (const ParameterHandler::ExcValueDoesNotMatchPattern &)
      {
        throw InputError("",
                         line.place() + ": entry '" + name + "': found '" +
                           abridged(line.value) + "', allowed is " +
                           in_words(pattern) +
                           (is_beyond_integers(line.value, pattern) ?
                              ", up to 2147483647" :
                              ""));
      }
    for (unsigned int i = 0; i + 1 < line.path.size(); ++i)
      prm->leave_subsection();
  }

  void
  ParameterFile::judge(const ParameterLines              &idle,
                       const EntryValues                 &values,
                       const std::vector<ParameterEntry> &declared,
                       const DeclareEntries              &declare)
  {
    std::set<std::string> unknown;
    for (const auto &line : idle)
      unknown.insert(join(line.path, "/"));
    const auto near = sections_of(unknown);

    // What the file has said of an entry before, and other values of choices
    // that may matter.
    std::map<std::string, std::vector<std::string>> said;
    for (const auto &line : lines)
      if (!line.is_subsection)
        said[join(line.path, "/")].push_back(line.value);
    const auto other_values =
      [&](const ParameterEntry &entry) -> std::vector<std::string> {
      static const std::set<std::string> decisive = {"Geometry",
                                                     "Grid",
                                                     "Time",
                                                     "Solver"};
      const auto                         section  = section_of(entry.path);
      const bool is_choice = boost::starts_with(entry.pattern, "[Selection");
      if (near.count(section) == 0 &&
          !(is_choice && decisive.count(section) > 0))
        return {};
      auto       all    = typical_values(entry);
      const auto before = said.find(entry.path);
      if (before != said.end())
        all.insert(all.end(), before->second.begin(), before->second.end());
      return all;
    };
    std::map<std::string, std::string> reasons; // by path
    const auto look = [&](const EntryValues &method, const EntryValues &given) {
      auto start = method;
      start.insert(values.begin(), values.end());
      start.insert(given.begin(), given.end());
      explore(declare,
              start,
              other_values,
              [&](const ParameterEntry &entry, EntryValues changed) {
                changed.insert(method.begin(), method.end());
                for (auto path = entry.path; !path.empty();
                     path      = section_of(path))
                  if (unknown.erase(path) > 0)
                    reasons[path] = in_words(changed);
                return !unknown.empty();
              });
    };
    look({}, {});
    // What wants two other choices: one of them another method, or that an
    // entry is given which may be empty.
    EntryValues given;
    for (const auto &entry : declared)
      if (entry.default_value.empty() && near.count(section_of(entry.path)) > 0)
        given[entry.path] = "1";
    if (!unknown.empty())
      look({}, given);
    for (const auto &entry : declared)
      if (entry.path == "Geometry/Kind" || entry.path == "Grid/Method" ||
          entry.path == "Time/Integrator")
        for (const auto &method : typical_values(entry))
          if (!unknown.empty() &&
              method != chosen_in(values)(entry.path, entry.default_value))
            look({{entry.path, method}}, {});

    const auto               allowed  = paths_of(declared);
    const auto               sections = sections_of(allowed);
    std::vector<std::string> section_names; // in the order of declaration
    for (const auto &path : allowed)
      for (const auto &section : sections_of(std::vector{path}))
        if (std::count(section_names.begin(), section_names.end(), section) ==
            0)
          section_names.push_back(section);
    std::set<std::string> sections_without_use;
    for (const auto &line : idle)
      {
        const auto path   = join(line.path, "/");
        const auto reason = reasons.find(path);
        if (reason == reasons.end())
          {
            auto name = path;
            while (sections.count(section_of(name)) == 0)
              name = section_of(name);
            const bool is_section = line.is_subsection || name != path;
            const auto section    = section_of(name);
            throw InputError(
              "",
              line.place() + ": found " +
                (is_section ? "subsection" : "entry") + " '" +
                abridged(
                  name.substr(section.empty() ? 0 : section.size() + 1)) +
                "', which this scene does not have" +
                (is_section ? " (a list of names may lack it)" : "") +
                "; allowed here are: " +
                names_within(section, is_section ? section_names : allowed));
          }
        const bool is_told =
          sections_without_use.count(line.file + section_of(path)) > 0;
        if (line.is_subsection)
          sections_without_use.insert(line.file + path);
        if (!is_told && !is_switched_off(path, values))
          warnings.push_back(
            line.place() + ": " +
            (line.is_subsection ? "subsection" : "entry") + " '" + path +
            "' does nothing in this scene; it would " + reason->second);
      }
  }

  std::string
  ParameterFile::resolved(const std::vector<std::string> &without) const
  {
    std::stringstream all;
    prm->print_parameters(all,
                          ParameterHandler::ShortPRM |
                            ParameterHandler::KeepDeclarationOrder);
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
    std::string place = "file " + file_name + " (entry not set there)";
    for (const auto &line : lines)
      if (!line.is_subsection && join(line.path, "/") == path)
        place = line.place();
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

  Chosen
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
          return prm.get(sections, name);
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

  std::vector<std::string>
  names_in(const Chosen &chosen, const std::string &list)
  {
    auto names = split_names(chosen(list, ""));
    names.erase(std::remove_if(names.begin(),
                               names.end(),
                               [&](const auto &name) {
                                 return !is_path(name) &&
                                        chosen(section_of(list) + "/" + name +
                                                 "/Enabled",
                                               "") == "false";
                               }),
                names.end());
    return names;
  }

  bool
  is_path(const std::string &name)
  {
    return name.find('/') != std::string::npos;
  }

  namespace
  {
    std::vector<std::string> &
    open_sections()
    {
      static std::vector<std::string> sections;
      return sections;
    }
  } // namespace

  void
  in_section(ParameterHandler            &prm,
             const std::string           &path,
             const std::function<void()> &action)
  {
    const auto sections = split_path(path);
    for (const auto &section : sections)
      prm.enter_subsection(section);
    open_sections().push_back(path);
    // Leaves them again, whatever happens.
    const std::shared_ptr<void> leave(nullptr, [&](void *) {
      open_sections().pop_back();
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

  std::string
  current_section()
  {
    std::string path;
    for (const auto &section : open_sections())
      path += section + "/";
    return path;
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
