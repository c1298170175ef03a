#include <impm/input/sections/section.h>

#include <set>

namespace impm
{
  Section
  Section::subsection(const std::string &name) const
  {
    Section section = *this;
    section.name    = name;
    section.path    = path.empty() ? name : path + "/" + name;
    section.inside([](auto &) {}); // is there even without entries
    return section;
  }

  std::string
  Section::text(const std::string           &entry,
                const std::string           &fallback,
                const Patterns::PatternBase &pattern,
                const std::string           &documentation) const
  {
    if (!is_read)
      inside([&](auto &prm) {
        prm.declare_entry(entry, fallback, pattern, documentation);
      });
    const std::string found = chosen(path + "/" + entry, fallback);
    return pattern.match(found) ? found : fallback;
  }

  void
  Section::add(const std::string     &entry,
               std::optional<double> &number,
               const std::string     &documentation) const
  {
    const bool is_set = !get(entry).empty();
    const auto values = numbers(entry, is_set ? 1 : 0, documentation);
    if (is_set)
      number = values[0];
  }

  std::vector<double>
  Section::numbers(const std::string           &entry,
                   const unsigned int           n,
                   const std::string           &documentation,
                   const std::string           &fallback,
                   const Patterns::PatternBase &pattern) const
  {
    text(entry, fallback, pattern, documentation);
    std::vector<double> values(n);
    if (is_read)
      inside([&](const auto &prm) { values = get_numbers(prm, entry, n); });
    return values;
  }

  std::vector<std::string>
  Section::names(const std::string &entry,
                 const std::string &documentation) const
  {
    std::vector<std::string> names;
    add(entry, names, documentation);
    std::set<std::string> taken;
    for (const auto &name : names)
      if (is_path(name))
        fail(entry,
             "found '" + name +
               "', allowed are names without '/', which is "
               "for paths of entries");
      else if (!taken.insert(name).second)
        fail(entry, "found '" + name + "' twice, the name is taken already");
    std::vector<std::string> enabled;
    for (const auto &name : names)
      if (!is_path(name))
        {
          bool is_enabled = true;
          subsection(name).add("Enabled",
                               is_enabled,
                               true,
                               "Whether it counts; false: as if the list did "
                               "not name it.");
          if (is_enabled)
            enabled.push_back(name);
        }
    return enabled;
  }
} // namespace impm
