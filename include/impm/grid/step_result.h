#ifndef impm_grid_step_result_h
#define impm_grid_step_result_h

#include <impm/base/vector.h>

namespace impm
{
  /** What a step has made of the nodes, ghosts and hanging nodes included. */
  struct StepResult
  {
    Vector increment; ///< (m)
    /** At the end of the step, with inertia (m/s, m/s^2). What is prescribed
     * has the mean velocity of its step. */
    Vector velocity, acceleration;
  };
} // namespace impm

#endif
