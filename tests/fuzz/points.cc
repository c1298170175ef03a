#include <impm/base/exceptions.h>
#include <impm/scene/point_file.h>

#include "memory_file.h"

namespace
{
  template <int dim>
  void
  read(const std::string &name)
  {
    try
      {
        impm::read_point_file<dim>(name);
      }
    catch (const impm::InputError &)
      {
        // said as it should be; all else ends the fuzzer
      }
  }
} // namespace

/** The bytes are those of a point file: of a VTU file if they begin as XML. */
extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *bytes, const std::size_t size)
{
  const bool                    is_xml = size > 0 && bytes[0] == '<';
  static const impm::MemoryFile csv(".csv"), vtu(".vtu");
  const auto                   &file = is_xml ? vtu : csv;
  file.write(bytes, size);
  read<2>(file.name);
  read<3>(file.name);
  return 0;
}
