#ifndef impm_base_memory_h
#define impm_base_memory_h

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace impm
{
  /** Memory by who has it (bytes). */
  using MemoryByOwner = std::map<std::string, std::size_t>;

  /** What lists of plain data have asked for, whether they use it or not
   * (bytes). */
  template <typename... T>
  std::size_t
  bytes_of(const std::vector<T> &...lists)
  {
    return (std::size_t() + ... + (lists.capacity() * sizeof(T)));
  }
} // namespace impm

#endif
