#ifndef impm_run_jump_h
#define impm_run_jump_h

#include <impm/balance/step_problem.h>

namespace impm
{
  /**
   * The way of a quasi-static run from where no equilibrium is near to where
   * one is, as a column that buckles or an arch that snaps through: at loads
   * that hardly change any more, steps that are damped by as much as lets them
   * be made. What is on the way is no equilibrium; the end is, since the
   * damping goes when it is needed no more.
   */
  class Jump
  {
  public:
    /** Of the next attempt; the mode along which the start of this step is not
     * stable, if it is known, pushes. */
    StepDamping
    damping(const double cell_extent) const
    {
      return {factor, 0.2 * cell_extent, mode.size() > 0 ? &mode : nullptr};
    }

    bool
    is_on() const
    {
      return factor > 0;
    }

    /** After an attempt that failed: damps more. Returns whether it may. */
    bool
    damp_more()
    {
      factor = is_on() ? 8 * factor : first;
      return factor <= most && n_steps < too_many;
    }

    /** After a step that was made, with a motion in cells; the next one may be
     * as long as any, or not yet. */
    void
    end_step(const double in_cells, const bool is_long)
    {
      mode = Vector();
      if (is_on())
        {
          ++n_steps;
          if (in_cells < 0.5)
            factor /= in_cells < 0.1 ? 8 : 2;
          if (factor < 0.5 * first)
            factor = 0;
        }
      else if (is_long)
        n_steps = 0;
    }

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &factor &n_steps;
    }

    Vector mode; ///< of the attempt before, in this step, or empty

  private:
    static constexpr double       first = 1e-7, most = 100;
    static constexpr unsigned int too_many = 500;

    double factor = 0; ///< see StepDamping
    /** Of this jump, and of those before it without a long step between. */
    unsigned int n_steps = 0;
  };
} // namespace impm

#endif
