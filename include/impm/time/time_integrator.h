#ifndef impm_time_time_integrator_h
#define impm_time_time_integrator_h

#include <impm/base/vector.h>
#include <impm/input/sections/time.h>

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

    virtual bool
    has_inertia() const = 0;

    /** Whether the forces at the start alone give the step. */
    bool
    is_explicit() const
    {
      return has_inertia() && force_factor() == 0;
    }

    /** Whether a step asks for the forces at its start, f(0). */
    virtual bool
    needs_start_forces() const
    {
      return force_factor() < 1;
    }

    /**
     * The longest step (s) in which an undamped oscillation of a circular
     * frequency (1/s) does not grow; infinite if it never does.
     */
    virtual double
    stable_step(double frequency) const = 0;

    /** Whether the points carry their acceleration from step to step. */
    virtual bool
    keeps_acceleration() const
    {
      return false;
    }

    /** (1/s^2) */
    virtual double
    mass_factor(double dt) const = 0;

    virtual double
    force_factor() const = 0;

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
  };

  /** The integrator that a scene names: every one stands in here. */
  std::unique_ptr<TimeIntegrator>
  make_time_integrator(const TimeSpec &spec);
} // namespace impm

#endif
