#ifndef impm_input_sections_stabilization_h
#define impm_input_sections_stabilization_h

#include <impm/input/parameter_file.h>
#include <impm/input/sections/time.h>

namespace impm
{
  struct StabilizationSpec
  {
    double ghost_penalty      = 0; ///< in units of Young's modulus; 0: off
    double isolated_stiffness = 0; ///< in units of Young's modulus; 0: off
  };

  void
  declare_stabilization(dealii::ParameterHandler    &prm,
                        const ParameterFile::Chosen &chosen);

  StabilizationSpec
  read_stabilization(dealii::ParameterHandler &prm,
                     const TimeSpec           &time,
                     bool                      lagrangian);
} // namespace impm

#endif
