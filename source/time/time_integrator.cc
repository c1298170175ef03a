#include <impm/time/time_integrator.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  namespace
  {
    /**
     * Sulsky & Kaul (2004), eq. 2.4.1 with u = dt v^L (eq. 2.3.2): positions
     * move with the velocity at the end of the step whatever theta is. Explicit
     * with theta = 0 (section 2.3.1). Without inertia theta is 1.
     */
    class Theta : public TimeIntegrator
    {
    public:
      /**
       * With d = 1 + theta (omega dt)^2, (x, dt v) is multiplied by a matrix of
       * determinant 1 / d and trace (d + 1 - (omega dt)^2) / d: the eigenvalue
       * -1 is passed where (1 - 2 theta) (omega dt)^2 = 4.
       */
      explicit Theta(const TimeSpec &spec)
      {
        mass         = spec.has_inertia() ? 1 : 0;
        force        = spec.theta;
        start_forces = force < 1;
        if (force < 0.5)
          stable_angle = 2 / std::sqrt(1 - 2 * force);
      }

      void
      known_acceleration(const double  dt,
                         const Vector &velocity,
                         const Vector &,
                         Vector &known) const override
      {
        known.equ(1 / dt, velocity);
      }

      void
      end_motion(const double  dt,
                 const Vector &u,
                 const Vector &,
                 const Vector &,
                 Vector &end_velocity,
                 Vector &) const override
      {
        end_velocity.equ(1 / dt, u);
      }

      unsigned int
      order() const override
      {
        return 1;
      }

      /** Of dt v_end against dt (v + v_end) / 2. */
      void
      displacement_error(const double  dt,
                         const Vector &velocity,
                         const Vector &,
                         const Vector &end_velocity,
                         const Vector &,
                         Vector &error) const override
      {
        error.equ(dt / 2, end_velocity);
        error.add(-dt / 2, velocity);
      }
    };

    /**
     * Newmark's method (Guilkey & Weiss 2003, eq. 14 to 16, for beta = 1/4,
     * gamma = 1/2):
     *
     *   u       = dt v + dt^2 ((1/2 - beta) a + beta a_end),
     *   v_end   = v + dt ((1 - gamma) a + gamma a_end),
     *   m a_end = -f(u).
     *
     * The acceleration a at the start is either what the points carry, or
     * -f(0) / m on the grid as it is: then m a_end + f(u) = 0, divided by
     * 1 / (2 beta), has no acceleration in it.
     */
    class Newmark : public TimeIntegrator
    {
    public:
      /**
       * Stable where (gamma / 2 - beta) (omega dt)^2 <= 1 (Hughes 1987, section
       * 9.1, without damping). With forces at both ends, too: a = -f(0) / m is
       * a_end of the step before wherever mass and forces are still the same,
       * so that the same matrix multiplies (x, v).
       */
      explicit Newmark(const TimeSpec &spec)
        : beta(spec.beta)
        , gamma(spec.gamma)
      {
        acceleration_kept = spec.keeps_acceleration;
        start_forces      = !acceleration_kept;
        mass              = acceleration_kept ? 1 / beta : 2;
        force             = acceleration_kept ? 1 : 2 * beta;
        if (2 * beta < gamma)
          stable_angle = 1 / std::sqrt(gamma / 2 - beta);
      }

      void
      known_acceleration(const double  dt,
                         const Vector &velocity,
                         const Vector &acceleration,
                         Vector       &known) const override
      {
        if (acceleration_kept)
          {
            known.equ(1 / (beta * dt), velocity);
            known.add(1 / (2 * beta) - 1, acceleration);
          }
        else
          known.equ(2 / dt, velocity);
      }

      void
      end_motion(const double  dt,
                 const Vector &u,
                 const Vector &velocity,
                 const Vector &acceleration,
                 Vector       &end_velocity,
                 Vector       &end_acceleration) const override
      {
        end_acceleration.equ(1 / (beta * dt * dt), u);
        end_acceleration.add(-1 / (beta * dt), velocity);
        end_acceleration.add(1 - 1 / (2 * beta), acceleration);
        end_velocity = velocity;
        end_velocity.add(dt * (1 - gamma), acceleration);
        end_velocity.add(dt * gamma, end_acceleration);
      }

      unsigned int
      order() const override
      {
        return gamma > 0.5 ? 1 : 2;
      }

      /** Zienkiewicz & Xie (1991), with what the velocity loses if it does. */
      void
      displacement_error(const double dt,
                         const Vector &,
                         const Vector &acceleration,
                         const Vector &,
                         const Vector &end_acceleration,
                         Vector       &error) const override
      {
        const double factor =
          dt * dt * (std::max(std::abs(beta - 1. / 6), 1. / 12) + gamma - 0.5);
        error.equ(factor, end_acceleration);
        error.add(-factor, acceleration);
      }

    protected:
      const double beta, gamma;
    };

    /**
     * The energy-momentum method (Simo & Tarnow 1992): with the trapezoidal
     * rule's motion, v_end = 2 u / dt - v, but the balance
     *
     *   m (v_end - v) / dt + f = 0,   f_I = sum_p V0 F S grad N_I
     *
     * with F in the middle of the step and S the mean of the second
     * Piola-Kirchhoff stresses at its ends. It keeps momenta; what f does along
     * u is S : (C_end - C) / 2, the change of an energy that is quadratic in C,
     * and of another one to third order in C_end - C, forward as backward.
     */
    class EnergyMomentum : public Newmark
    {
    public:
      explicit EnergyMomentum(const TimeSpec &spec)
        : Newmark(spec)
      {
        stress_in_the_middle = true;
      }
    };

    /**
     * The generalised-alpha method (Chung & Hulbert 1993), which damps what
     * steps do not resolve to a spectral radius rho a step and little else:
     *
     *   m ((1 - alpha_m) a_end + alpha_m a)
     *     + (1 - alpha_f) f(u) + alpha_f f(0) = 0
     *
     * with Newmark's u and v_end, and alpha_m, alpha_f, beta and gamma that
     * depend on rho alone. The acceleration a at the start is what the points
     * carry, or -f(0) / m, which damps less.
     */
    class GeneralisedAlpha : public Newmark
    {
    public:
      explicit GeneralisedAlpha(const TimeSpec &spec)
        : GeneralisedAlpha(spec,
                           (2 * spec.spectral_radius - 1) /
                             (spec.spectral_radius + 1),
                           spec.spectral_radius / (spec.spectral_radius + 1))
      {}

      void
      known_acceleration(const double  dt,
                         const Vector &velocity,
                         const Vector &acceleration,
                         Vector       &known) const override
      {
        known.equ((1 - alpha_m) / (beta * dt), velocity);
        known.add((1 - alpha_m) * (1 / (2 * beta) - 1) - alpha_m, acceleration);
      }

      /** Whatever gamma is. */
      unsigned int
      order() const override
      {
        return 2;
      }

    private:
      GeneralisedAlpha(const TimeSpec &spec,
                       const double    alpha_m,
                       const double    alpha_f)
        : Newmark(with_weights(spec, alpha_f - alpha_m))
        , alpha_m(alpha_m)
      {
        start_forces = true;
        mass         = (1 - alpha_m) / beta;
        force        = 1 - alpha_f;
      }

      static TimeSpec
      with_weights(TimeSpec spec, const double difference)
      {
        spec.beta  = 0.25 * (1 + difference) * (1 + difference);
        spec.gamma = 0.5 + difference;
        return spec;
      }

      const double alpha_m;
    };
  } // namespace

  std::unique_ptr<TimeIntegrator>
  make_time_integrator(const TimeSpec &spec)
  {
    switch (spec.integrator)
      {
        case Integrator::newmark:
          return std::make_unique<Newmark>(spec);
        case Integrator::generalised_alpha:
          return std::make_unique<GeneralisedAlpha>(spec);
        case Integrator::energy_momentum:
          return std::make_unique<EnergyMomentum>(spec);
        default:
          return std::make_unique<Theta>(spec);
      }
  }
} // namespace impm
