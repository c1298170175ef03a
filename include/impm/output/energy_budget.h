#ifndef impm_output_energy_budget_h
#define impm_output_energy_budget_h

#include <algorithm>
#include <cmath>

namespace impm
{
  /**
   * The energy (J) that a run with inertia has against that which it was given:
   * kinetic, stored and dissipated at the points, less what was there at the
   * start, external work, and what splitting and merging changed. Dissipation
   * by integrators, transfers and stabilization makes the gain negative;
   * nothing in nature makes it positive.
   */
  class EnergyBudget
  {
  public:
    /** With the energy at the start. */
    void
    begin(const double energy)
    {
      start = largest = energy;
    }

    /** Takes the energy as it is now, and what the run was given so far, give
     * or take something. */
    void
    update(const double energy, const double given, const double uncertain)
    {
      gain         = energy - start - given;
      certain_gain = gain - uncertain;
      of_steps     = 0;
      largest      = std::max({largest, energy, std::abs(given)});
    }

    /** A step that was made gained so much for certain, as seen by the grid. */
    void
    add_step(const double step_gain)
    {
      of_steps += step_gain;
    }

    /**
     * Whether a step that gains so much goes beyond a tolerance (a share of the
     * largest energy), and not by a trifle, which a shorter step would not
     * mend. `energy` is what there is in the step at least.
     */
    bool
    forbids(const double step_gain,
            const double energy,
            const double tolerance) const
    {
      const double scale = std::max(largest, energy);
      return tolerance > 0 && step_gain > 0.1 * tolerance * scale &&
             certain_gain + of_steps + step_gain > tolerance * scale;
    }

    /** Over the largest energy so far. */
    double
    relative(const double energy) const
    {
      return largest > 0 ? energy / largest : 0.;
    }

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &start &largest &gain &certain_gain &of_steps;
    }

    double gain         = 0; ///< at the last update (J)
    double certain_gain = 0; ///< likewise, whatever the work was

  private:
    double start = 0, largest = 0;
    double of_steps = 0; ///< since the last update
  };
} // namespace impm

#endif
