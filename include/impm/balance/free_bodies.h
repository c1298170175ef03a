#ifndef impm_balance_free_bodies_h
#define impm_balance_free_bodies_h

#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/loads.h>
#include <impm/time/time_integrator.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * The rigid bodies that forces move, in one step. Unknown are the increments
   * q of each: of its centre, along the axes of space, and the vector of its
   * turn along axes that are fixed to it. With these for u, the integrator
   * makes of mass m and inertia J
   *
   *   m (mass_factor u - known) - w F - (1 - w) F_start = 0,
   *   J (mass_factor u - known) + w (W x J W - M) + (1 - w) (...)_start = 0,
   *
   * with forces F and moments M, about the centre, of contact and of the body
   * force; in the plane W x J W is none. While the nodes look for their
   * increments, a body is where its equations hold for what they try: it is
   * eliminated, and what it gives way by is a correction of their tangent.
   */
  template <int dim>
  class FreeBodies
  {
  public:
    /** Of a body: along x, y (, z), then about x, y, z. */
    static constexpr unsigned int n_components = dim + 3;
    using Components = dealii::Tensor<1, n_components>;
    using Matrix     = dealii::Tensor<2, n_components>;

    /** What contact does, in space: force (N) and moment about the centre (N m)
     * as they are now, with their derivatives by further translations and
     * rotations of the body. */
    struct Load
    {
      Components value;
      Matrix     derivative;
      /** Sums of forces, and of moments, without regard to direction, and what
       * round-off makes of them. */
      double force = 0, moment = 0, force_noise = 0, moment_noise = 0;
    };

    /** For the step from `time` to `time + dt`. */
    FreeBodies(const RigidBodies<dim> &rigid,
               const LoadsSpec<dim>   &loads,
               GeometryKind            geometry,
               const TimeIntegrator   &integrator,
               double                  time,
               double                  dt);

    /** Takes what contact does where the step begins. */
    void
    begin(const std::vector<Load> &loads);

    unsigned int
    size() const
    {
      return bodies.size();
    }

    /** As it is tried now, from the start of the step. */
    const RigidMotion<dim> &
    motion(const unsigned int body) const
    {
      return bodies[body].motion;
    }

    /** The first of the tries for what nodes do now. */
    void
    restart();

    /** Goes on with Newton's method, with the loads at the motion as it is;
     * returns whether it is settled now. */
    bool
    improve(const std::vector<Load> &loads);

    /** How a body that is settled answers to a further load of contact, in
     * space. */
    Matrix
    compliance(unsigned int body, const Load &load) const;

    /** Components that are unknown. */
    const std::vector<unsigned int> unknowns;

    /** Of inertia and of loads that are known, over w (J), where bodies are
     * settled. In space turns have none that is exact. */
    double
    potential() const;

    /** Work of the body force in the step (J), by the trapezoidal rule. */
    double
    work() const;

    /** What the kinetic energy gains in the step (J). */
    double
    kinetic_gain() const;

    /** Why a body must not go where it goes, if it is further than this (m)
     * from where its surface was looked for; else empty. */
    std::string
    gone_astray(double distance) const;

    /** Of a body that did not settle in the last try; else empty. */
    std::string unsettled;

    /** Moves the bodies to the end of the step. */
    void
    advance(RigidBodies<dim> &rigid) const;

  private:
    struct Body
    {
      const BodySpec<dim> *spec;
      RigidState<dim>      start;
      Components start_load, start_force, end_force, known, start_acceleration;
      Components q;
      RigidMotion<dim> motion;

      // Newton's method.
      Components   before, step;
      double       merit, part;
      unsigned int n_cuts;
      bool         is_settled;
    };

    /** Mass and inertia times components. */
    Components
    inertia(const Body &body, const Components &components) const;

    /** W x J W, with zeros before it. */
    Components
    gyroscopic(const Body &body, const Components &velocity) const;

    /** Velocity and acceleration at the end of the step. */
    std::pair<Components, Components>
    end_motion(const Body &body) const;

    Components
    residual(const Body &body, const Load &load) const;

    /** Its inverse derivative, from residuals to unknowns. */
    Matrix
    inverse_tangent(const Body &body, const Load &load) const;

    /** Takes the increments. */
    void
    set(Body &body, const Components &q) const;

    /** A component of a residual, as a force (N). */
    double
    norm(const Body &body, const Components &residual) const;

    const TimeIntegrator &integrator;
    const double          dt, weight;
    bool                  is_first_step;
    std::vector<Body>     bodies;
  };
} // namespace impm

#endif
