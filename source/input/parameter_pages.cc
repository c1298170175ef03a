#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/input/parameter_pages.h>
#include <impm/study/study.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

namespace impm
{
  namespace
  {
    /** Lists of names, and what an item of each is called. */
    const EntryValues &
    items_of_lists()
    {
      static const EntryValues items = {{"Geometry/Shapes", "shape"},
                                        {"Grid/Adaptation/Criteria",
                                         "criterion"},
                                        {"Materials/Names", "material"},
                                        {"Bodies/Names", "body"},
                                        {"Boundary conditions/Grips", "grip"},
                                        {"Contact/Pairs", "pair"},
                                        {"Loads/Tractions", "traction"},
                                        {"Output/Probes", "probe"},
                                        {"Output/Reactions", "reaction"},
                                        {"Reference/Names", "reference"},
                                        {"Study/Lists", "list"}};
      return items;
    }

    bool
    is_in(const std::string &path, const std::string &section)
    {
      return boost::starts_with(path, section);
    }

    /** The section that comes next on the way from one to a path: "steel" from
     * "Materials/" to "Materials/steel/Law"; empty: the path is in there. */
    std::string
    next_section(const std::string &section, const std::string &path)
    {
      const auto slash = path.find('/', section.size());
      return slash == std::string::npos ?
               "" :
               path.substr(section.size(), slash - section.size());
    }

    std::vector<std::string>
    sections_in(const std::string              &section,
                const std::vector<ListedEntry> &entries)
    {
      std::vector<std::string> names;
      for (const auto &entry : entries)
        if (is_in(entry.path, section))
          {
            const auto name = next_section(section, entry.path);
            if (!name.empty() &&
                std::count(names.begin(), names.end(), name) == 0)
              names.push_back(name);
          }
      return names;
    }

    void
    print_section(const std::string              &section,
                  const std::string              &indent,
                  const std::vector<ListedEntry> &entries,
                  std::ostream                   &out)
    {
      for (const auto &entry : entries)
        if (is_in(entry.path, section) &&
            next_section(section, entry.path).empty())
          {
            for (const auto &line :
                 dealii::Utilities::break_text_into_lines(entry.documentation,
                                                          76 - indent.size()))
              out << indent << "# " << line << '\n';
            if (!entry.when.empty())
              out << indent << "# There for example " << entry.when << ".\n";
            if (const auto range = in_words(entry.pattern); !range.empty())
              out << indent << "# Allowed: " << range << ".\n";
            if (entry.value != entry.default_value)
              out << indent << "# Default: " << entry.default_value << '\n';
            out << indent << "set " << entry.path.substr(section.size())
                << " = " << entry.value << '\n';
          }
      for (const auto &name : sections_in(section, entries))
        {
          out << indent << "subsection " << name << '\n';
          print_section(section + name + "/", indent + "  ", entries, out);
          out << indent << "end\n";
          if (indent.empty())
            out << '\n';
        }
    }

    /** A name without what paths and shells mind: "boundary_conditions". */
    std::string
    file_name_of(const std::string &section)
    {
      std::string name = boost::to_lower_copy(section);
      std::replace(name.begin(), name.end(), ' ', '_');
      return name + ".md";
    }

    std::string
    code(const std::string &text)
    {
      return '`' + text + '`';
    }

    void
    print_page(const std::string              &section,
               const std::vector<ListedEntry> &entries,
               std::ostream                   &out)
    {
      for (const auto &entry : entries)
        if (is_in(entry.path, section) &&
            next_section(section, entry.path).empty())
          {
            out << "- **" << entry.path.substr(section.size()) << "** ("
                << (entry.default_value.empty() ?
                      "empty by default" :
                      "default " + code(entry.default_value));
            if (const auto range = in_words(entry.pattern); !range.empty())
              out << "; " << range;
            if (!entry.when.empty())
              out << "; there for example " << entry.when;
            out << "): " << entry.documentation << '\n';
          }
      for (const auto &name : sections_in(section, entries))
        {
          const auto inner = section + name + "/";
          out << "\n## " << inner.substr(0, inner.size() - 1) << "\n\n";
          print_page(inner, entries, out);
        }
    }
  } // namespace

  std::vector<ListedEntry>
  all_entries()
  {
    std::vector<ListedEntry>                      entries;
    std::set<std::pair<std::string, std::string>> known;
    const auto add = [&](const ParameterEntry &entry,
                         const EntryValues    &changed) {
      if (known.insert({entry.path, entry.documentation}).second)
        entries.push_back({entry, changed.empty() ? "" : in_words(changed)});
      return true;
    };
    auto start = items_of_lists();
    start.insert({"Geometry/Kind", "3D"}); // which has the most
    const auto other_values = [](const ParameterEntry &entry) {
      return items_of_lists().count(entry.path) > 0 ?
               std::vector<std::string>() :
               typical_values(entry);
    };
    explore(declare_file, start, other_values, add);
    // And where all is given that may be left empty: some entries want two
    // others.
    for (const auto &entry : entries)
      if (entry.default_value.empty())
        start.insert({entry.path, "1"});
    explore(declare_file, start, other_values, add);
    for (auto &entry : entries)
      entry.value =
        chosen_in(items_of_lists())(entry.path, entry.default_value);
    return entries;
  }

  std::vector<ListedEntry>
  entries_of_scene(ParameterFile &file)
  {
    std::vector<ListedEntry> entries;
    for (const auto &entry : entries_of(file.handler()))
      if (entry.path != "Study/Scene") // what it says is in there
        entries.push_back({entry});
    return entries;
  }

  std::string
  as_text(const std::vector<ListedEntry> &entries)
  {
    std::ostringstream out;
    print_section("", "", entries, out);
    return out.str();
  }

  std::string
  as_json(const std::vector<ListedEntry> &entries)
  {
    auto json = nlohmann::ordered_json::array();
    for (const auto &entry : entries)
      {
        json.push_back({{"entry", entry.path},
                        {"value", entry.value},
                        {"default", entry.default_value},
                        {"allowed", in_words(entry.pattern)},
                        {"meaning", entry.documentation}});
        if (!entry.when.empty())
          json.back()["with"] = entry.when;
      }
    return json.dump(2) + '\n';
  }

  void
  write_pages(const std::vector<ListedEntry> &entries,
              const std::string              &directory)
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error)
      throw SystemError("cannot make the directory '" + directory +
                        "': " + error.message());
    std::ostringstream index;
    index << "# Parameters\n\nWritten by `impm_dealii "
             "--print-parameters=markdown`. Lists of names have one item each, "
             "which is called what it is: `Materials/material` stands for any "
             "material. What is for a third direction is there in 3D alone. "
             "Units are those of SI, or of `General/Units`.\n\n";
    for (const auto &section : sections_in("", entries))
      {
        std::ostringstream page;
        page << "# " << section << "\n\n";
        print_page(section + "/", entries, page);
        replace_file(directory + "/" + file_name_of(section), page.str());
        index << "- [" << section << "](" << file_name_of(section) << ")\n";
      }
    replace_file(directory + "/README.md", index.str());
  }
} // namespace impm
