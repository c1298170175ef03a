#ifndef impm_time_step_control_h
#define impm_time_step_control_h

#include <impm/input/sections/time.h>

#include <algorithm>
#include <string>

namespace impm
{
  /** Of a step, as means of squares over the mass of the points. */
  struct StepError
  {
    double displacement = 0; ///< that the time integrator loses (m)
    double speed        = 0; ///< of the displacement (m/s)
  };

  /** What the length of the next step may depend on. */
  struct StepFigures
  {
    unsigned int iterations = 0; ///< of Newton's method
    double       error      = 0; ///< over the allowed one
    double       in_cells   = 0; ///< way through the grid, over the longest
  };

  /**
   * How long steps are: they grow, are cut where a step fails, and end on time.
   * Counted in a `unit` (s) that may differ from step to step: 1, or that of a
   * CFL number.
   */
  class StepControl
  {
  public:
    /** Of an integrator of an order. */
    StepControl(const TimeSpec &spec, const unsigned int order)
      : spec(spec)
      , order(order)
      , size(spec.step)
    {}

    /** Length of the next step (s) from a time on. */
    double
    begin(const double time, const double new_unit)
    {
      unit    = new_unit;
      failed  = false;
      of_step = StepError();
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
      return cut(std::min(1., smallest() / dt), true);
    }

    /** Whether a step of that length is too short to go on with. */
    bool
    is_too_short() const
    {
      return dt < smallest();
    }

    /**
     * Error of the step over what is allowed. What a step may lose is its share
     * of the time, but where a motion sets in at once, which no length
     * resolves, that of a thousandth of all.
     */
    double
    relative(const StepError &error);

    /** The part of the step to which it is cut for its error or its way; 1 if
     * it may stand, or is as short as any. */
    double
    part_for(const StepFigures &step) const;

    /** Why there is such a part; for people. */
    std::string
    why_too_long(const StepFigures &step) const;

    /** Whether a step loses too much, or goes too far. */
    bool
    is_wrong(const StepFigures &step) const
    {
      return std::max(step.error, step.in_cells) > tolerated;
    }

    /** The step was made: grow, if it may, after cuts back to the nominal step
     * first. */
    void
    accept(const StepFigures &step, const bool may_grow = true);

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
      bool                    by_cfl = spec.cfl_number > 0;
      double                  saved  = size;
      archive &by_cfl &saved &largest_speed;
      if (by_cfl == (spec.cfl_number > 0))
        size = std::min(saved, spec.largest_step);
    }

  private:
    /** (s) */
    double
    smallest() const
    {
      return spec.smallest_step * spec.step * unit;
    }

    /** Factor to the step that would be as long as it may. */
    double
    factor_for(const StepFigures &step) const;

    /** What a step may exceed, lest it be made again for little. */
    static constexpr double tolerated = 1.5;

    const TimeSpec    &spec;
    const unsigned int order;
    double             size;
    double             dt = 0, unit = 1; ///< of the step that is being made
    bool               failed = false;
    StepError          of_step;           ///< that is being made
    double             largest_speed = 0; ///< see StepError, up to now
  };
} // namespace impm

#endif
