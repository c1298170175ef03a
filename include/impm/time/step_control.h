#ifndef impm_time_step_control_h
#define impm_time_step_control_h

#include <impm/input/sections/time.h>

namespace impm
{
  /**
   * How long steps are: they grow, are cut where a step fails, and end on time.
   * Counted in a `unit` (s) that may differ from step to step: 1, or that of a
   * CFL number.
   */
  class StepControl
  {
  public:
    explicit StepControl(const TimeSpec &spec)
      : spec(spec)
      , size(spec.step)
    {}

    /** Length of the next step (s) from a time on. */
    double
    begin(double time, double unit);

    /** Of the same step with a part of its length: where it failed, the steps
     * that follow are as short. */
    double
    cut(double part, bool has_failed);

    /** Whether a step of that length is too short to go on with. */
    bool
    is_too_short() const
    {
      return dt < spec.smallest_step * spec.step * unit;
    }

    /** The step was made. */
    void
    accept();

    /** In units: what the next step will be if nothing is in its way. */
    double
    step_size() const
    {
      return size;
    }

  private:
    const TimeSpec &spec;
    double          size;
    double          dt = 0, unit = 1; ///< of the step that is being made
    bool            failed = false;
  };
} // namespace impm

#endif
