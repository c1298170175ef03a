#ifndef impm_time_time_integrator_h
#define impm_time_time_integrator_h

#include <impm/base/vector.h>
#include <impm/input/sections/time.h>

#include <limits>
#include <memory>

namespace impm
{
  /**
   * What one step makes of inertia: in the balance
   *
   *   m (mass_factor u - known) + force_factor f(u)
   *     + (1 - force_factor) f(0) = 0,
   *
   * u is the grid's increment, f internal minus external forces, `known` comes
   * from velocity and acceleration at the start.
   */
  class TimeIntegrator
  {
  public:
    virtual ~TimeIntegrator() = default;

    bool
    has_inertia() const
    {
      return mass > 0;
    }

    /** Whether the forces at the start alone give the step. */
    bool
    is_explicit() const
    {
      return force == 0;
    }

    /** Whether a step asks for the forces at its start, f(0). */
    bool
    needs_start_forces() const
    {
      return start_forces;
    }

    /** Whether the points carry their acceleration from step to step. */
    bool
    keeps_acceleration() const
    {
      return acceleration_kept;
    }

    /**
     * Whether the mean of the stresses at both ends acts in the middle of the
     * step, instead of each where it is.
     */
    bool
    has_stress_in_the_middle() const
    {
      return stress_in_the_middle;
    }

    /**
     * The longest step (s) in which an undamped oscillation of a circular
     * frequency (1/s) does not grow; infinite if it never does.
     */
    double
    stable_step(const double frequency) const
    {
      return stable_angle / frequency;
    }

    /** (1/s^2) */
    double
    mass_factor(const double dt) const
    {
      return mass / (dt * dt);
    }

    double
    force_factor() const
    {
      return force;
    }

    /**
     * The known part of the acceleration (m/s^2). `acceleration` is that at
     * the start where the integrator keeps it or needs the forces there.
     */
    virtual void
    known_acceleration(double        dt,
                       const Vector &velocity,
                       const Vector &acceleration,
                       Vector       &known) const = 0;

    /** Velocity (m/s) and acceleration (m/s^2) at the end of the step. */
    virtual void
    end_motion(double        dt,
               const Vector &u,
               const Vector &velocity,
               const Vector &acceleration,
               Vector       &end_velocity,
               Vector       &end_acceleration) const = 0;

    /** What the displacement of a step loses goes with this power of its
     * length, and one more. */
    virtual unsigned int
    order() const = 0;

    /** Displacement (m) of the step less what it should be, as its leading
     * term. */
    virtual void
    displacement_error(double        dt,
                       const Vector &velocity,
                       const Vector &acceleration,
                       const Vector &end_velocity,
                       const Vector &end_acceleration,
                       Vector       &error) const = 0;

  protected:
    double mass  = 1; ///< mass_factor dt^2
    double force = 1; ///< force_factor
    double stable_angle =
      std::numeric_limits<double>::infinity(); ///< in a step
    bool start_forces = false, acceleration_kept = false;
    bool stress_in_the_middle = false;
  };

  /** The integrator that a scene names: every one stands in here. */
  std::unique_ptr<TimeIntegrator>
  make_time_integrator(const TimeSpec &spec);
} // namespace impm

#endif
