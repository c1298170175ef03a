#include <impm/time/time_integrator.h>

#include <cmath>
#include <limits>

namespace impm
{
  namespace
  {
    class QuasiStatic : public TimeIntegrator
    {
    public:
      bool
      has_inertia() const override
      {
        return false;
      }

      double
      mass_factor(double) const override
      {
        return 0;
      }

      double
      force_factor() const override
      {
        return 1;
      }

      double
      stable_step(double) const override
      {
        return std::numeric_limits<double>::infinity();
      }

      void
      known_acceleration(double,
                         const Vector &,
                         const Vector &,
                         Vector &known) const override
      {
        known = 0;
      }

      void
      end_motion(double,
                 const Vector &,
                 const Vector &,
                 const Vector &,
                 Vector &,
                 Vector &) const override
      {}
    };

    /**
     * Sulsky & Kaul (2004), eq. 2.4.1 with u = dt v^L (eq. 2.3.2): positions
     * move with the velocity at the end of the step whatever theta is. Explicit
     * with theta = 0 (section 2.3.1).
     */
    class Theta : public TimeIntegrator
    {
    public:
      explicit Theta(const double theta)
        : theta(theta)
      {}

      bool
      has_inertia() const override
      {
        return true;
      }

      double
      mass_factor(const double dt) const override
      {
        return 1 / (dt * dt);
      }

      double
      force_factor() const override
      {
        return theta;
      }

      /**
       * With d = 1 + theta (omega dt)^2, (x, dt v) is multiplied by a matrix of
       * determinant 1 / d and trace (d + 1 - (omega dt)^2) / d: the eigenvalue
       * -1 is passed where (1 - 2 theta) (omega dt)^2 = 4.
       */
      double
      stable_step(const double frequency) const override
      {
        return theta >= 0.5 ? std::numeric_limits<double>::infinity() :
                              2 / (std::sqrt(1 - 2 * theta) * frequency);
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

    private:
      const double theta;
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
      Newmark(const double beta, const double gamma, const bool keeps)
        : beta(beta)
        , gamma(gamma)
        , keeps(keeps)
      {}

      bool
      has_inertia() const override
      {
        return true;
      }

      bool
      keeps_acceleration() const override
      {
        return keeps;
      }

      double
      mass_factor(const double dt) const override
      {
        return (keeps ? 1 / beta : 2) / (dt * dt);
      }

      double
      force_factor() const override
      {
        return keeps ? 1 : 2 * beta;
      }

      /** For the acceleration, whatever the factor is. */
      bool
      needs_start_forces() const override
      {
        return !keeps;
      }

      /**
       * (gamma / 2 - beta) (omega dt)^2 <= 1 (Hughes 1987, section 9.1, without
       * damping). With forces at both ends, too: a = -f(0) / m is a_end of the
       * step before wherever mass and forces are still the same, so that the
       * same matrix multiplies (x, v).
       */
      double
      stable_step(const double frequency) const override
      {
        return 2 * beta >= gamma ?
                 std::numeric_limits<double>::infinity() :
                 1 / (std::sqrt(gamma / 2 - beta) * frequency);
      }

      void
      known_acceleration(const double  dt,
                         const Vector &velocity,
                         const Vector &acceleration,
                         Vector       &known) const override
      {
        if (keeps)
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

    private:
      const double beta, gamma;
      const bool   keeps;
    };
  } // namespace

  std::unique_ptr<TimeIntegrator>
  make_time_integrator(const TimeSpec &spec)
  {
    switch (spec.integrator)
      {
        case Integrator::quasi_static:
          return std::make_unique<QuasiStatic>();
        case Integrator::newmark:
          return std::make_unique<Newmark>(spec.beta,
                                           spec.gamma,
                                           spec.keeps_acceleration);
        default:
          return std::make_unique<Theta>(spec.theta);
      }
  }
} // namespace impm
