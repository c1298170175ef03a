#include <deal.II/lac/full_matrix.h>

#include <impm/balance/free_bodies.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    std::vector<unsigned int>
    unknowns_of(const unsigned int dim, const GeometryKind geometry)
    {
      if (geometry == GeometryKind::axisymmetric)
        return {1};
      if (dim == 2)
        return {0, 1, 4};
      return {0, 1, 2, 3, 4, 5};
    }

    template <int dim>
    RotationVector
    turn_in(const Tensor<1, dim + 3> &components)
    {
      RotationVector result;
      for (unsigned int d = 0; d < 3; ++d)
        result[d] = components[dim + d];
      return result;
    }

    template <int dim>
    Tensor<1, dim>
    shift_in(const Tensor<1, dim + 3> &components)
    {
      Tensor<1, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = components[d];
      return result;
    }

    template <int dim>
    Tensor<1, dim + 3>
    put_together(const Tensor<1, dim> &shift, const RotationVector &turn)
    {
      Tensor<1, dim + 3> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = shift[d];
      for (unsigned int d = 0; d < 3; ++d)
        result[dim + d] = turn[d];
      return result;
    }

    /** How the body turns further, along its axes, when the vector of its turn
     * grows. */
    Tensor<2, 3>
    growth_of_turn(const RotationVector &turn)
    {
      const double angle = turn.norm();
      const auto   K     = cross_matrix<3>(turn);
      const double half  = std::sin(angle / 2);
      const double b = angle < 1e-4 ? 0.5 : 2 * half * half / (angle * angle);
      const double c = angle < 1e-2 ?
                         1. / 6 - angle * angle / 120 :
                         (angle - std::sin(angle)) / std::pow(angle, 3);
      return Tensor<2, 3>(unit_symmetric_tensor<3>()) - b * K + c * K * K;
    }

    /** Of axes of the body at the end of a motion to those of space. */
    template <int dim>
    Tensor<2, 3>
    axes(const RigidMotion<dim> &before, const RigidMotion<dim> &motion)
    {
      if constexpr (dim == 3)
        return motion.rotation() * before.rotation();
      return unit_symmetric_tensor<3>();
    }

    constexpr double tolerance = 1e-12;
  } // namespace

  template <int dim>
  FreeBodies<dim>::FreeBodies(const RigidBodies<dim> &rigid,
                              const LoadsSpec<dim>   &loads,
                              const GeometryKind      geometry,
                              const TimeIntegrator   &integrator,
                              const double            time,
                              const double            dt)
    : unknowns(unknowns_of(dim, geometry))
    , integrator(integrator)
    , dt(dt)
    , weight(integrator.force_factor())
    , is_first_step(time == 0)
  {
    for (const auto &rigid_body : rigid.bodies)
      if (rigid_body.spec->is_free)
        {
          Body body{};
          body.spec  = rigid_body.spec;
          body.start = rigid_body.state;
          if (const auto &force = loads.body_force)
            {
              const auto &motion = body.start.since_start;
              const auto  at     = [&](const double instant) {
                force->set_time(instant);
                const Point<dim> place =
                  motion.centre +
                  (loads.body_force_is_initial ? 0. : 1.) * motion.shift;
                Components result;
                for (unsigned int d = 0; d < dim; ++d)
                  result[d] = body.spec->inertia.mass * force->value(place, d);
                return result;
              };
              body.start_force = at(time);
              body.end_force   = at(time + dt);
            }
          bodies.push_back(body);
        }
  }

  template <int dim>
  typename FreeBodies<dim>::Components
  FreeBodies<dim>::inertia(const Body &body, const Components &components) const
  {
    return put_together<dim>(body.spec->inertia.mass *
                               shift_in<dim>(components),
                             body.spec->inertia.tensor *
                               turn_in<dim>(components));
  }

  template <int dim>
  typename FreeBodies<dim>::Components
  FreeBodies<dim>::gyroscopic(const Body       &body,
                              const Components &velocity) const
  {
    if (dim == 2)
      return Components();
    const auto spin = turn_in<dim>(velocity);
    return put_together<dim>(
      {}, cross_product_3d(spin, body.spec->inertia.tensor * spin));
  }

  template <int dim>
  void
  FreeBodies<dim>::begin(const std::vector<Load> &loads)
  {
    const unsigned int n = n_components * size();
    impm::Vector       velocity(n), acceleration(n), known(n);
    for (unsigned int b = 0; b < size(); ++b)
      {
        auto       &body  = bodies[b];
        const auto &start = body.start;
        const auto  v     = put_together<dim>(start.velocity, start.spin);
        body.start_load =
          body.start_force +
          put_together<dim>(shift_in<dim>(loads[b].value),
                            turned_to_body(start.since_start,
                                           turn_in<dim>(loads[b].value))) -
          gyroscopic(body, v);
        // As the nodes have it.
        if (integrator.keeps_acceleration() && !is_first_step)
          body.start_acceleration =
            put_together<dim>(start.acceleration, start.spin_acceleration);
        else
          {
            FullMatrix<double> J(unknowns.size());
            for (unsigned int j = 0; j < unknowns.size(); ++j)
              {
                Components unit;
                unit[unknowns[j]] = 1;
                const auto column = inertia(body, unit);
                for (unsigned int i = 0; i < unknowns.size(); ++i)
                  J(i, j) = column[unknowns[i]];
              }
            J.gauss_jordan();
            for (unsigned int i = 0; i < unknowns.size(); ++i)
              for (unsigned int j = 0; j < unknowns.size(); ++j)
                body.start_acceleration[unknowns[i]] +=
                  J(i, j) * body.start_load[unknowns[j]];
          }
        for (unsigned int c = 0; c < n_components; ++c)
          {
            velocity[n_components * b + c]     = v[c];
            acceleration[n_components * b + c] = body.start_acceleration[c];
          }
      }
    integrator.known_acceleration(dt, velocity, acceleration, known);
    for (unsigned int b = 0; b < size(); ++b)
      {
        auto      &body = bodies[b];
        Components q;
        for (const unsigned int c : unknowns)
          {
            body.known[c] = known[n_components * b + c];
            q[c]          = dt * velocity[n_components * b + c];
          }
        set(body, q);
      }
  }

  template <int dim>
  void
  FreeBodies<dim>::set(Body &body, const Components &q) const
  {
    const auto &now = body.start.since_start;
    body.q          = q;
    body.motion     = {now.centre + now.shift,
                       shift_in<dim>(q),
                       turned_to_space(now, turn_in<dim>(q))};
  }

  template <int dim>
  std::pair<typename FreeBodies<dim>::Components,
            typename FreeBodies<dim>::Components>
  FreeBodies<dim>::end_motion(const Body &body) const
  {
    impm::Vector u(n_components), velocity(u), acceleration(u), end_velocity(u),
      end_acceleration(u);
    const auto v = put_together<dim>(body.start.velocity, body.start.spin);
    for (unsigned int c = 0; c < n_components; ++c)
      {
        u[c]            = body.q[c];
        velocity[c]     = v[c];
        acceleration[c] = body.start_acceleration[c];
      }
    integrator.end_motion(
      dt, u, velocity, acceleration, end_velocity, end_acceleration);
    std::pair<Components, Components> result;
    for (const unsigned int c : unknowns)
      {
        result.first[c]  = end_velocity[c];
        result.second[c] = end_acceleration[c];
      }
    return result;
  }

  template <int dim>
  typename FreeBodies<dim>::Components
  FreeBodies<dim>::residual(const Body &body, const Load &load) const
  {
    const auto moment = transpose(axes(body.start.since_start, body.motion)) *
                        turn_in<dim>(load.value);
    auto end_load =
      body.end_force + put_together<dim>(shift_in<dim>(load.value), moment);
    if (dim == 3)
      end_load -= gyroscopic(body, end_motion(body).first);
    return inertia(body, integrator.mass_factor(dt) * body.q - body.known) -
           weight * end_load - (1 - weight) * body.start_load;
  }

  template <int dim>
  typename FreeBodies<dim>::Matrix
  FreeBodies<dim>::inverse_tangent(const Body &body, const Load &load) const
  {
    const auto R      = axes(body.start.since_start, body.motion);
    const auto growth = dim == 3 ? R * growth_of_turn(turn_in<dim>(body.q)) : R;
    const auto moment = turn_in<dim>(load.value);
    const auto velocity = dim == 3 ? end_motion(body).first : Components();
    // of a velocity by an increment, which the integrator keeps to itself
    double rate = 0;
    if (dim == 3)
      {
        impm::Vector one(1), zero(1), end(1), ignored(1);
        one[0] = 1;
        integrator.end_motion(dt, one, zero, zero, end, ignored);
        rate = end[0];
      }
    const unsigned int n = unknowns.size();
    FullMatrix<double> tangent(n);
    for (unsigned int j = 0; j < n; ++j)
      {
        Components unit;
        unit[unknowns[j]]  = 1;
        const auto further = growth * turn_in<dim>(unit);
        const auto change =
          load.derivative * put_together<dim>(shift_in<dim>(unit), further);
        const auto of_moment =
          transpose(R) *
          (turn_in<dim>(change) + cross_product_3d(moment, further));
        auto column =
          inertia(body, integrator.mass_factor(dt) * unit) -
          weight * put_together<dim>(shift_in<dim>(change), of_moment);
        if (dim == 3)
          {
            const auto &J = body.spec->inertia.tensor;
            const auto  W = turn_in<dim>(velocity),
                       dW = rate * turn_in<dim>(unit);
            column += weight * put_together<dim>({},
                                                 cross_product_3d(dW, J * W) +
                                                   cross_product_3d(W, J * dW));
          }
        for (unsigned int i = 0; i < n; ++i)
          tangent(i, j) = column[unknowns[i]];
      }
    tangent.gauss_jordan();
    Matrix result;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        result[unknowns[i]][unknowns[j]] = tangent(i, j);
    return result;
  }

  template <int dim>
  typename FreeBodies<dim>::Matrix
  FreeBodies<dim>::compliance(const unsigned int b, const Load &load) const
  {
    const auto &body  = bodies[b];
    const auto  R     = axes(body.start.since_start, body.motion);
    const auto growth = dim == 3 ? R * growth_of_turn(turn_in<dim>(body.q)) : R;
    Matrix     to_space, to_body;
    for (unsigned int d = 0; d < dim; ++d)
      to_space[d][d] = to_body[d][d] = 1;
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int d = 0; d < 3; ++d)
        {
          to_space[dim + c][dim + d] = growth[c][d];
          to_body[dim + c][dim + d]  = R[d][c];
        }
    return weight * to_space * inverse_tangent(body, load) * to_body;
  }

  template <int dim>
  double
  FreeBodies<dim>::norm(const Body &body, const Components &residual) const
  {
    const auto  &inertia = body.spec->inertia;
    const double arm     = std::sqrt(trace(inertia.tensor) / inertia.mass);
    double       square  = 0;
    for (const unsigned int c : unknowns)
      square += std::pow(residual[c] / (c < dim ? 1. : arm), 2);
    return std::sqrt(square);
  }

  template <int dim>
  void
  FreeBodies<dim>::restart()
  {
    for (auto &body : bodies)
      {
        body.merit      = std::numeric_limits<double>::max();
        body.part       = 1;
        body.n_cuts     = 0;
        body.is_settled = false;
      }
  }

  template <int dim>
  bool
  FreeBodies<dim>::improve(const std::vector<Load> &loads)
  {
    unsettled.clear();
    for (unsigned int b = 0; b < size(); ++b)
      {
        auto       &body = bodies[b];
        const auto &load = loads[b];
        if (body.is_settled)
          continue;
        const auto   r     = residual(body, load);
        const double now   = norm(body, r);
        const auto   limit = [&](const double force, const double moment) {
          Components scale;
          for (unsigned int c = 0; c < n_components; ++c)
            scale[c] = c < dim ? force : moment;
          return norm(body, scale);
        };
        const double size =
          limit(load.force, load.moment) + norm(body, body.start_load) +
          norm(body, body.end_force) +
          norm(body, inertia(body, integrator.mass_factor(dt) * body.q)) +
          norm(body, inertia(body, body.known));
        const double noise    = limit(load.force_noise, load.moment_noise);
        const bool   is_worse = !(now <= (1 - 1e-4 * body.part) * body.merit);
        body.is_settled =
          now <= tolerance * size + noise || (is_worse && now <= 1e-8 * size);
        if (body.is_settled)
          continue;
        unsettled = body.spec->name;
        if (is_worse && body.n_cuts < 8)
          {
            ++body.n_cuts;
            body.part /= 2;
            set(body, body.before + body.part * body.step);
            continue;
          }
        body.merit  = now;
        body.part   = 1;
        body.n_cuts = 0;
        body.before = body.q;
        body.step   = -1. * (inverse_tangent(body, load) * r);
        set(body, body.before + body.step);
      }
    return unsettled.empty();
  }

  template <int dim>
  double
  FreeBodies<dim>::potential() const
  {
    double sum = 0;
    for (const auto &body : bodies)
      sum +=
        body.q *
          inertia(body,
                  0.5 * integrator.mass_factor(dt) * body.q - body.known) -
        body.q * (weight * body.end_force + (1 - weight) * body.start_load);
    return sum / weight;
  }

  template <int dim>
  double
  FreeBodies<dim>::work() const
  {
    double sum = 0;
    for (const auto &body : bodies)
      for (const unsigned int c : unknowns)
        if (c < dim)
          sum += 0.5 * (body.start_force[c] + body.end_force[c]) * body.q[c];
    return sum;
  }

  template <int dim>
  double
  FreeBodies<dim>::kinetic_gain() const
  {
    double sum = 0;
    for (const auto &body : bodies)
      {
        const auto v = put_together<dim>(body.start.velocity, body.start.spin),
                   w = end_motion(body).first;
        sum += 0.5 * (w * inertia(body, w) - v * inertia(body, v));
      }
    return sum;
  }

  template <int dim>
  std::string
  FreeBodies<dim>::gone_astray(const double distance) const
  {
    for (const auto &body : bodies)
      {
        const auto off =
          body.q - dt * put_together<dim>(body.start.velocity, body.start.spin);
        double radius = 0;
        if (const auto &box = body.spec->shape->bounding_box)
          for (unsigned int v = 0; v < (1u << dim); ++v)
            radius =
              std::max(radius, box->vertex(v).distance(body.spec->centre));
        if (shift_in<dim>(off).norm() + radius * turn_in<dim>(off).norm() >
            distance)
          return body.spec->name;
      }
    return "";
  }

  template <int dim>
  void
  FreeBodies<dim>::advance(RigidBodies<dim> &rigid) const
  {
    for (const auto &body : bodies)
      for (auto &rigid_body : rigid.bodies)
        if (rigid_body.spec == body.spec)
          {
            auto      &state = rigid_body.state;
            const auto end   = end_motion(body);
            state.angles +=
              turned_to_space(state.since_start, turn_in<dim>(body.q));
            state.since_start       = chain(state.since_start, body.motion);
            state.velocity          = shift_in<dim>(end.first);
            state.spin              = turn_in<dim>(end.first);
            state.acceleration      = shift_in<dim>(end.second);
            state.spin_acceleration = turn_in<dim>(end.second);
          }
  }

  template class FreeBodies<2>;
  template class FreeBodies<3>;
} // namespace impm
