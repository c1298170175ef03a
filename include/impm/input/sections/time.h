#ifndef impm_input_sections_time_h
#define impm_input_sections_time_h

#include <impm/input/sections/section.h>

#include <string>
#include <vector>

namespace impm
{
  enum class Integrator
  {
    quasi_static, ///< no inertia, and thus no velocity
    explicit_euler,
    theta,
    newmark,
    generalised_alpha,
    energy_momentum
  };

  /** How velocities come from the grid to the points. */
  enum class TransferKind
  {
    flip,
    pic,
    apic
  };

  /** What says how long the next step is. */
  enum class StepControlKind
  {
    fixed,
    iterations, ///< of Newton's method
    error       ///< of the time integrator
  };

  struct TimeSpec
  {
    Integrator integrator;
    double     theta = 1;
    double     beta = 0.25, gamma = 0.5;   ///< of Newmark's method
    double     spectral_radius    = 1;     ///< of the generalised-alpha method
    bool       keeps_acceleration = false; ///< at the points
    /** Strain from a velocity that has been through the points. */
    bool            momentum_formulation = false;
    double          cfl_number           = 0; ///< 0: `step` is given
    TransferKind    transfer             = TransferKind::flip;
    StepControlKind step_control         = StepControlKind::fixed;
    double          end, step, growth, largest_step, smallest_step;
    double          error_tolerance   = 0; ///< over the way that points go
    unsigned int    wanted_iterations = 0; ///< a step
    double          energy_tolerance  = 0; ///< 0: none
    unsigned int    largest_number_of_steps;

    bool
    has_inertia() const
    {
      return integrator != Integrator::quasi_static;
    }

    bool
    is_explicit() const
    {
      return integrator == Integrator::explicit_euler;
    }
  };

  void
  add_time(const Section            &top,
           TimeSpec                 &time,
           bool                      lagrangian,
           std::vector<std::string> &warnings);

  /** Whether there is no inertia for sure, before the section is added. */
  bool
  is_quasi_static(const Chosen &chosen);
} // namespace impm

#endif
