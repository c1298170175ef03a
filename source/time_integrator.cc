#include <impm/time_integrator.h>

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

      void
      known_acceleration(double, const Vector &, Vector &known) const override
      {
        known = 0;
      }

      void
      end_velocity(double,
                   const Vector &,
                   const Vector &,
                   Vector &) const override
      {}
    };

    /**
     * Sulsky & Kaul (2004), eq. 2.4.1 with u = dt v^L (eq. 2.3.2): positions
     * move with the velocity at the end of the step whatever theta is.
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

      void
      known_acceleration(const double  dt,
                         const Vector &velocity,
                         Vector       &known) const override
      {
        known.equ(1 / dt, velocity);
      }

      void
      end_velocity(const double  dt,
                   const Vector &u,
                   const Vector &,
                   Vector &velocity) const override
      {
        velocity.equ(1 / dt, u);
      }

    private:
      const double theta;
    };
  } // namespace

  std::unique_ptr<TimeIntegrator>
  make_time_integrator(const TimeSpec &spec)
  {
    if (spec.integrator == "theta")
      return std::make_unique<Theta>(spec.theta);
    return std::make_unique<QuasiStatic>();
  }
} // namespace impm
