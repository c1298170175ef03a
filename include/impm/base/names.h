#ifndef impm_base_names_h
#define impm_base_names_h

#include <boost/algorithm/string/join.hpp>

#include <string>
#include <vector>

namespace impm
{
  using boost::algorithm::join;

  /** Of entries that have one. */
  template <typename Entry>
  std::vector<std::string>
  names_of(const std::vector<Entry> &entries)
  {
    std::vector<std::string> names;
    for (const auto &entry : entries)
      names.push_back(entry.name);
    return names;
  }
} // namespace impm

#endif
