#ifndef impm_input_sections_general_h
#define impm_input_sections_general_h

#include <impm/base/units.h>
#include <impm/input/sections/section.h>

#include <string>

// Here as in every section: `add_...` declares and reads, see Section.

namespace impm
{
  struct GeneralSpec
  {
    std::string title;
    Constants   constants;
    Units       units;
  };

  void
  add_general(const Section &top, GeneralSpec &general);
} // namespace impm

#endif
