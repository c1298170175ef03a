#include <impm/balance/step_problem.h>
#include <impm/footprints/transfer.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Divides what points have spread, times their masses, by the lumped mass
     * of the nodes. */
    template <int dim>
    void
    average_over_mass(const Discretization<dim> &discretization,
                      const Vector              &mass,
                      Vector                    &vector)
    {
      vector.compress(VectorOperation::add);
      discretization.condense_hanging(vector);
      for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
        if (mass.local_element(i) > 0)
          vector.local_element(i) /= mass.local_element(i);
    }

    /**
     * Adds `factor` times the part of the points' acceleration that the grid
     * does not see, since the change of its velocity counts but what it does.
     * It has no momentum.
     */
    template <int dim>
    void
    add_unseen_acceleration(const StepProblem<dim> &problem,
                            const double            factor,
                            MaterialPoints<dim>    &points)
    {
      const auto                 &discretization = *problem.discretization;
      std::vector<Tensor<1, dim>> own(points.size()), seen;
      for (unsigned int p = 0; p < points.size(); ++p)
        own[p] = points.mass(p) * points.vector(p, points.offset_acceleration);
      Vector mean;
      if (problem.footprints.are_moved())
        mean = problem.motion.acceleration; // which nodes have kept
      else
        {
          discretization.initialize(mean);
          problem.footprints.spread(own, mean);
          average_over_mass(discretization, problem.motion.mass, mean);
        }
      discretization.interpolate_hanging(mean);
      problem.footprints.interpolate(mean, seen);
      for (unsigned int p = 0; p < points.size(); ++p)
        points.set_vector(p,
                          points.offset_velocity,
                          points.velocity(p) +
                            factor * (own[p] / points.mass(p) - seen[p]));
    }

    /** Velocities of the points at the end of the step. */
    template <int dim>
    std::vector<Tensor<1, dim>>
    end_velocities(const StepProblem<dim>    &problem,
                   const TransferKind         kind,
                   const Vector              &end_velocity,
                   const MaterialPoints<dim> &points)
    {
      std::vector<Tensor<1, dim>> at_points;
      if (kind != TransferKind::flip)
        {
          problem.footprints.interpolate(end_velocity, at_points);
          return at_points;
        }
      Vector change = end_velocity;
      change -= problem.motion.velocity;
      problem.discretization->interpolate_hanging(change);
      problem.footprints.interpolate(change, at_points);
      for (unsigned int p = 0; p < points.size(); ++p)
        at_points[p] += points.velocity(p);
      return at_points;
    }

    /** Points take the gradient of the grid's velocity. */
    template <int dim>
    void
    take_gradients(const Footprints<dim> &footprints,
                   const Vector          &velocity,
                   MaterialPoints<dim>   &points)
    {
      for (unsigned int p = 0; p < points.size(); ++p)
        std::fill_n(points.fields(p) + points.offset_gradient, dim * dim, 0.);
      for (const auto &cell : footprints.cells)
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            double *C =
              points.fields(footprints.point[e]) + points.offset_gradient;
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  C[dim * c + d] +=
                    velocity.local_element(dim * cell.nodes[n] + c) *
                    footprints.gradient(e)[dim * n + d];
          }
    }

    /**
     * Adds m_p S_I and m_p S_I v_p(x_I) of the points to the lumped mass and to
     * what becomes the velocity, in one pass. `velocity` makes of a point its
     * v_p, a function of the place of a node.
     */
    template <int dim, typename Velocity>
    void
    add_mass_and_momentum(const MaterialPoints<dim> &points,
                          const Footprints<dim>     &footprints,
                          const Discretization<dim> &discretization,
                          const Velocity            &velocity,
                          NodalMotion               &motion)
    {
      constexpr unsigned int          n_nodes = Footprints<dim>::n_nodes;
      std::array<Point<dim>, n_nodes> places;
      for (const auto &cell : footprints.cells)
        {
          for (unsigned int n = 0; n < n_nodes; ++n)
            places[n] = discretization.node_positions[cell.nodes[n]];
          std::array<double, n_nodes>         mass{};
          std::array<Tensor<1, dim>, n_nodes> momentum{};
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            {
              const unsigned int p     = footprints.point[e];
              const double       m     = points.mass(p);
              const double      *value = footprints.value(e);
              const auto         v     = velocity(p);
              for (unsigned int n = 0; n < n_nodes; ++n)
                {
                  const double share = m * value[n];
                  mass[n] += share;
                  momentum[n] += share * v(places[n]);
                }
            }
          for (unsigned int n = 0; n < n_nodes; ++n)
            for (unsigned int c = 0; c < dim; ++c)
              {
                const unsigned int i = dim * cell.nodes[n] + c;
                motion.mass.local_element(i) += mass[n];
                motion.velocity.local_element(i) += momentum[n][c];
              }
        }
    }
  } // namespace

  template <int dim>
  Vector
  gather_mass(const MaterialPoints<dim> &points,
              const Footprints<dim>     &footprints,
              const Discretization<dim> &discretization)
  {
    // Lumped; hanging nodes hand theirs to their masters, so that the sums
    // over all nodes stay those over all points.
    Vector                      mass;
    std::vector<Tensor<1, dim>> at_points(points.size());
    for (unsigned int p = 0; p < points.size(); ++p)
      for (unsigned int d = 0; d < dim; ++d)
        at_points[p][d] = points.mass(p);
    discretization.initialize(mass);
    footprints.spread(at_points, mass);
    mass.compress(VectorOperation::add);
    discretization.condense_hanging(mass);
    return mass;
  }

  template <int dim>
  NodalMotion
  gather_motion(const MaterialPoints<dim> &points,
                const Bodies<dim>         &bodies,
                const Footprints<dim>     &footprints,
                const BackgroundGrid<dim> &grid,
                const Discretization<dim> &discretization)
  {
    NodalMotion motion;
    if (const auto &state = grid.nodal_state(); state.velocity.size() > 0)
      {
        motion.mass = gather_mass(points, footprints, discretization);
        motion.mass.update_ghost_values();
        motion.velocity     = state.velocity;
        motion.acceleration = state.acceleration;
        return motion;
      }
    discretization.initialize(motion.mass);
    discretization.initialize(motion.velocity);
    const auto gather = [&](const auto &velocity) {
      add_mass_and_momentum(
        points, footprints, discretization, velocity, motion);
      motion.mass.compress(VectorOperation::add);
      discretization.condense_hanging(motion.mass);
      average_over_mass(discretization, motion.mass, motion.velocity);
      motion.mass.update_ghost_values();
    };

    if (grid.is_lagrangian)
      {
        // Weighed by mass where bodies meet.
        gather([&](const unsigned int p) {
          return
            [&velocity = bodies[points.body(p)].velocity](const Point<dim> &x) {
              Tensor<1, dim> v;
              for (unsigned int c = 0; velocity && c < dim; ++c)
                v[c] = velocity->value(x, c);
              return v;
            };
        });
        return motion;
      }
    motion.is_of_points = true;
    std::vector<Tensor<1, dim>> at_points(
      points.offset_acceleration > 0 ? points.size() : 0);
    if (points.offset_acceleration > 0)
      {
        for (unsigned int p = 0; p < points.size(); ++p)
          at_points[p] =
            points.mass(p) * points.vector(p, points.offset_acceleration);
        discretization.initialize(motion.acceleration);
        footprints.spread(at_points, motion.acceleration);
      }
    if (points.offset_affine > 0)
      {
        // v_p + C_p (x_I - x_p), where x_p is what the footprint makes of the
        // nodes' places, so that the sum of the latter is zero.
        Vector places;
        discretization.initialize(places);
        for (unsigned int i = 0; i < places.locally_owned_size(); ++i)
          places.local_element(i) =
            discretization.node_positions[i / dim][i % dim];
        places.update_ghost_values();
        footprints.interpolate(places, at_points);
        gather([&](const unsigned int p) {
          Tensor<2, dim> C;
          for (unsigned int d = 0; d < dim; ++d)
            C[d] = points.vector(p, points.offset_affine + d * dim);
          return [C, v = points.velocity(p), x_p = at_points[p]](
                   const Point<dim> &x) { return v + C * (x - x_p); };
        });
      }
    else
      gather([&](const unsigned int p) {
        return [v = points.velocity(p)](const Point<dim> &) { return v; };
      });
    if (points.offset_acceleration > 0)
      average_over_mass(discretization, motion.mass, motion.acceleration);
    return motion;
  }

  template <int dim>
  void
  advance_points(const StepProblem<dim>            &problem,
                 const StepResult                  &result,
                 const std::vector<Tensor<1, dim>> &increments,
                 const TimeSpec                    &time,
                 MaterialPoints<dim>               &points)
  {
    const auto        &layout = points.layout;
    const unsigned int n_stress =
      points.offset_stress > 0 ?
        layout.n_components(PointLayout::Kind::symmetric_tensor) :
        0;
    const bool move = points.offset_velocity > 0;
    const auto velocities =
      move ? end_velocities(problem, time.transfer, result.velocity, points) :
             std::vector<Tensor<1, dim>>();
    unsigned int p = 0;
    for (auto &particle : points.sorted.particles)
      {
        particle.set_location(particle.get_location() + increments[p]);
        double *fields      = points.fields(p);
        double *deformation = fields + points.offset_deformation;
        layout.store_tensor(problem.response.increment(p) *
                              layout.load_tensor(deformation),
                            deformation);
        if (n_stress > 0)
          std::copy_n(problem.response.end_stress(p),
                      n_stress,
                      fields + points.offset_stress);
        std::copy_n(problem.response.trial_history(p),
                    points.history_size(),
                    fields + points.offset_history);
        if (move)
          points.set_vector(p, points.offset_velocity, velocities[p]);
        if (points.offset_rate > 0)
          points.set_vector(p, points.offset_rate, increments[p] / problem.dt);
        ++p;
      }
    if (points.offset_gradient > 0)
      take_gradients(problem.footprints, result.velocity, points);
    if (points.offset_acceleration > 0)
      {
        if (time.transfer == TransferKind::flip)
          add_unseen_acceleration(problem,
                                  (1 - time.gamma) * problem.dt,
                                  points);
        std::vector<Tensor<1, dim>> at_points;
        problem.footprints.interpolate(result.acceleration, at_points);
        for (unsigned int q = 0; q < points.size(); ++q)
          points.set_vector(q, points.offset_acceleration, at_points[q]);
      }
  }

  template decltype(gather_mass<2>)    gather_mass<2>;
  template decltype(gather_mass<3>)    gather_mass<3>;
  template decltype(gather_motion<2>)  gather_motion<2>;
  template decltype(gather_motion<3>)  gather_motion<3>;
  template decltype(advance_points<2>) advance_points<2>;
  template decltype(advance_points<3>) advance_points<3>;
} // namespace impm
