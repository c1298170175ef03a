#ifndef impm_time_step_control_h
#define impm_time_step_control_h

#include <impm/input/sections/time.h>

#include <algorithm>

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
    begin(const double time, const double new_unit)
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

    /** Of the same step with a part of its length: where it failed, the steps
     * that follow are as short. */
    double
    cut(const double part, const bool has_failed)
    {
      dt *= part;
      failed = failed || has_failed;
      if (has_failed)
        size = dt / unit;
      return dt;
    }

    /** To the shortest at once, where what is between does not help. */
    double
    cut_to_smallest()
    {
      return cut(std::min(1., spec.smallest_step * spec.step * unit / dt),
                 true);
    }

    /** Whether a step of that length is too short to go on with. */
    bool
    is_too_short() const
    {
      return dt < spec.smallest_step * spec.step * unit;
    }

    /** The step was made: grow, if it may, after cuts back to the nominal step
     * first. */
    void
    accept(const bool may_grow = true)
    {
      if (!failed && may_grow)
        size = size < spec.step ?
                 std::min(1.5 * size, spec.step) :
                 std::min(size * spec.growth, spec.largest_step);
    }

    /** In units: what the next step will be if nothing is in its way. */
    double
    step_size() const
    {
      return size;
    }

    /** In units of its own if steps are now counted in others. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      bool             by_cfl = spec.cfl_number > 0;
      double           saved  = size;
      archive &by_cfl &saved;
      if (by_cfl == (spec.cfl_number > 0))
        size = std::min(saved, spec.largest_step);
    }

  private:
    const TimeSpec &spec;
    double          size;
    double          dt = 0, unit = 1; ///< of the step that is being made
    bool            failed = false;
  };
} // namespace impm

#endif
