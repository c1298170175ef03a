#ifndef impm_input_sections_failure_h
#define impm_input_sections_failure_h

#include <impm/input/sections/section.h>
#include <impm/materials/failure.h>

#include <optional>

namespace impm
{
  /** When points of a material fail. */
  struct FailureSpec
  {
    FailureStrain strain;
    double        remaining_share; ///< see FailingLaw
  };

  /** Adds the entries to the section of a material, which has a temperature or
   * has none; nothing if its points do not fail. */
  std::optional<FailureSpec>
  add_failure(const Section &section, bool has_temperature);
} // namespace impm

#endif
