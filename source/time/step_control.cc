#include <impm/time/step_control.h>

#include <cmath>
#include <sstream>

namespace impm
{
  double
  StepControl::relative(const StepError &error)
  {
    of_step            = error;
    const double speed = std::max(largest_speed, error.speed);
    const double allowed =
      spec.error_tolerance * speed * std::max(dt, 1e-3 * spec.end);
    return error.displacement > 0 ? error.displacement / allowed : 0.;
  }

  double
  StepControl::factor_for(const StepFigures &step) const
  {
    double factor = spec.growth;
    if (spec.step_control == StepControlKind::iterations)
      factor = std::sqrt(double(spec.wanted_iterations) /
                         std::max(1u, step.iterations));
    // With some distance, lest the next one be cut.
    if (step.error > 0)
      factor = std::min(factor, 0.85 * std::pow(step.error, -1. / order));
    if (step.in_cells > 0)
      factor = std::min(factor, 0.85 / step.in_cells);
    return factor;
  }

  double
  StepControl::part_for(const StepFigures &step) const
  {
    if (!is_wrong(step) || dt < 1.001 * smallest())
      return 1;
    return std::min(1.,
                    std::max(std::clamp(factor_for(step), 0.02, 0.7),
                             smallest() / dt));
  }

  std::string
  StepControl::why_too_long(const StepFigures &step) const
  {
    std::ostringstream text;
    if (step.error > step.in_cells)
      text << "its error is " << step.error << " times what is allowed";
    else
      text << "points would go " << step.in_cells
           << " times as far as they may where bodies come near each other";
    return text.str();
  }

  void
  StepControl::accept(const StepFigures &step, const bool may_grow)
  {
    largest_speed = std::max(largest_speed, of_step.speed);
    if (failed || !may_grow)
      return;
    if (spec.step_control == StepControlKind::fixed)
      {
        size = size < spec.step ?
                 std::min(1.5 * size, spec.step) :
                 std::min(size * spec.growth, spec.largest_step);
        return;
      }
    const double factor = std::clamp(factor_for(step), 0.3, spec.growth);
    // One that was shortened to end on time, or on a body, says little.
    if (factor < 1 || dt > 0.99 * size * unit)
      size = std::clamp(factor * dt / unit,
                        spec.smallest_step * spec.step,
                        spec.largest_step);
  }
} // namespace impm
