#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/input/parameter_text.h>
#include <impm/run/restart_check.h>

#include <algorithm>
#include <optional>
#include <set>

namespace impm
{
  namespace
  {
    using Entries = std::vector<std::pair<std::string, std::string>>;

    Entries
    entries_of(const std::string &text)
    {
      Entries entries;
      for (const auto &line : parameter_lines(text))
        if (!line.is_subsection)
          entries.emplace_back(join(line.path, "/"), line.value);
      return entries;
    }

    bool
    may_change(const std::string &path)
    {
      static const std::set<std::string> entries = {
        "General/Title",
        "Output/Directory",
        "Output/Format",
        "Output/Pictures",
        "Output/Time between pictures",
        "Output/Steps between pictures",
        "Output/Steps between rows",
        "Output/Point fields",
        "Time/End time",
        "Time/Largest number of steps",
        "Time/CFL number",
        "Time/Time step",
        "Time/Growth",
        "Time/Largest time step",
        "Time/Smallest time step"};
      for (const std::string section :
           {"Output/Checkpoints/", "Reference/", "Solver/"})
        if (path.rfind(section, 0) == 0)
          return true;
      return entries.count(path) > 0;
    }

    /** Of the first entry that is not among others as it is, with what stands
     * there. */
    std::optional<std::pair<std::string, std::string>>
    find_other(const Entries &entries, const Entries &others)
    {
      for (const auto &entry : entries)
        if (!may_change(entry.first) &&
            std::count(others.begin(), others.end(), entry) == 0)
          return entry;
      return {};
    }

    std::string
    value_in(const Entries &entries, const std::string &path)
    {
      for (const auto &[name, value] : entries)
        if (name == path)
          return "'" + value + "'";
      return "no such entry";
    }
  } // namespace

  void
  check_restart(const std::string &before, const std::string &now)
  {
    const auto old_entries = entries_of(before), new_entries = entries_of(now);
    auto       other = find_other(new_entries, old_entries);
    if (!other)
      other = find_other(old_entries, new_entries);
    if (other)
      throw InputError(
        other->first,
        "found " + value_in(new_entries, other->first) +
          ", allowed for a restart is what the checkpoint has, " +
          value_in(old_entries, other->first));
  }
} // namespace impm
