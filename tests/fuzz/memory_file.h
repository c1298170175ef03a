#ifndef memory_file_h
#define memory_file_h

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

namespace impm
{
  /** A file of this process that is never on a disk. */
  class MemoryFile
  {
  public:
    explicit MemoryFile(const std::string &ending)
      : name("/dev/shm/impm_fuzz_" + std::to_string(getpid()) + ending)
    {}

    ~MemoryFile()
    {
      std::remove(name.c_str());
    }

    void
    write(const std::uint8_t *bytes, const std::size_t size) const
    {
      std::ofstream(name, std::ios::binary)
        .write(reinterpret_cast<const char *>(bytes), size);
    }

    const std::string name;
  };
} // namespace impm

#endif
