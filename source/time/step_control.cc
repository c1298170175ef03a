#include <impm/time/step_control.h>

#include <algorithm>

namespace impm
{
  double
  StepControl::begin(const double time, const double new_unit)
  {
    unit   = new_unit;
    failed = false;
    // The last step ends on time, and none is a sliver.
    const double left = spec.end - time;
    dt                = size * unit;
    if (left < 1.001 * dt)
      dt = left;
    else if (left < 1.999 * dt)
      dt = left / 2;
    return dt;
  }

  double
  StepControl::cut(const double part, const bool has_failed)
  {
    dt *= part;
    if (has_failed)
      {
        failed = true;
        size   = dt / unit;
      }
    return dt;
  }

  void
  StepControl::accept()
  {
    // Grow; after a failure, back to the nominal step first.
    if (!failed && size < spec.step)
      size = std::min(1.5 * size, spec.step);
    else if (!failed)
      size = std::min(size * spec.growth, spec.largest_step);
  }
} // namespace impm
