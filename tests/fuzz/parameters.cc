#include <deal.II/base/exceptions.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/scene/scene.h>
#include <impm/study/study.h>

#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "memory_file.h"

namespace
{
  using namespace impm;

  /** As the program does before it makes a grid. */
  void
  read(const std::string &name, const std::vector<std::string> &overrides)
  {
    ParameterFile file(name, overrides, declare_file);
    try
      {
        if (scene_dimension(file.handler()) == 3)
          read_scene<3>(file.handler());
        else
          read_scene<2>(file.handler());
        if (!chosen_in(file.handler())("Study/Lists", "").empty())
          expand(read_study(file.handler()));
      }
    catch (const InputError &error)
      {
        throw InputError("", file.describe(error));
      }
    // What a run keeps of its parameters must read back.
    static const MemoryFile again("_again.prm");
    const std::string       text = file.resolved({"Study"});
    again.write(reinterpret_cast<const std::uint8_t *>(text.data()),
                text.size());
    try
      {
        ParameterFile(again.name, {}, declare_file);
      }
    catch (const InputError &error)
      {
        throw std::logic_error("what is written does not read back: " +
                               std::string(error.what()));
      }
  }
} // namespace

/** The bytes are those of a parameter file, up to a zero; what comes after it,
 * line by line, is set from outside. */
extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *bytes, const std::size_t size)
{
  const std::string        all(bytes, bytes + size);
  const auto               end = all.find('\0');
  std::vector<std::string> overrides;
  if (end != std::string::npos)
    overrides = split(all.substr(end + 1), '\n');

  static const MemoryFile file(".prm");
  file.write(bytes, std::min(end, size));
  try
    {
      read(file.name, overrides);
    }
  catch (const InputError &error)
    {
      // Said as it should be; all else ends the fuzzer.
      const std::string message = error.what();
      for (const std::string word : {"dealii", "exception", "Assert"})
        if (message.find(word) != std::string::npos &&
            all.find(word) == std::string::npos)
          {
            std::cerr << message << std::endl;
            std::abort();
          }
    }
  return 0;
}
