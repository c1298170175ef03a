#ifndef impm_base_names_h
#define impm_base_names_h

#include <boost/algorithm/string.hpp>

#include <string>
#include <vector>

namespace impm
{
  using boost::algorithm::join;

  /** Without blanks around the parts; unlike deal.II's, keeps empty ones. */
  inline std::vector<std::string>
  split(const std::string &text, const char delimiter)
  {
    std::vector<std::string> parts;
    boost::split(parts, text, [&](const char c) { return c == delimiter; });
    for (auto &part : parts)
      boost::trim(part);
    return parts;
  }

  /** Of entries that have one. */
  template <typename Entry>
  std::vector<std::string>
  names_of(const std::vector<Entry> &entries)
  {
    std::vector<std::string> names;
    names.reserve(entries.size());
    for (const auto &entry : entries)
      names.push_back(entry.name);
    return names;
  }
} // namespace impm

#endif
