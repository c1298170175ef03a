#ifndef impm_input_sections_stabilization_h
#define impm_input_sections_stabilization_h

#include <impm/input/sections/time.h>

namespace impm
{
  struct StabilizationSpec
  {
    double ghost_penalty      = 0; ///< in units of Young's modulus; 0: off
    double isolated_stiffness = 0; ///< in units of Young's modulus; 0: off
  };

  void
  add_stabilization(const Section     &top,
                    StabilizationSpec &stabilization,
                    const TimeSpec    &time,
                    bool               lagrangian);
} // namespace impm

#endif
