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

    template <int dim>
    void
    advance_velocities(const StepProblem<dim> &problem,
                       const TransferKind      kind,
                       const Vector           &end_velocity,
                       MaterialPoints<dim>    &points)
    {
      const auto                 &footprints = problem.footprints;
      std::vector<Tensor<1, dim>> at_points;
      if (kind == TransferKind::flip)
        {
          Vector change = end_velocity;
          change -= problem.motion.velocity;
          problem.discretization->interpolate_hanging(change);
          footprints.interpolate(change, at_points);
          for (unsigned int p = 0; p < points.size(); ++p)
            at_points[p] += points.velocity(p);
        }
      else
        footprints.interpolate(end_velocity, at_points);
      for (unsigned int p = 0; p < points.size(); ++p)
        points.set_vector(p, points.offset_velocity, at_points[p]);
      if (kind != TransferKind::apic)
        return;
      for (unsigned int p = 0; p < points.size(); ++p)
        std::fill_n(points.fields(p) + points.offset_affine, dim * dim, 0.);
      for (const auto &cell : footprints.cells)
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            double *C =
              points.fields(footprints.point[e]) + points.offset_affine;
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  C[dim * c + d] +=
                    end_velocity.local_element(dim * cell.nodes[n] + c) *
                    footprints.gradient(e)[dim * n + d];
          }
    }
  } // namespace

  template <int dim>
  NodalMotion
  gather_motion(const MaterialPoints<dim>  &points,
                const Bodies<dim>          &bodies,
                const Footprints<dim>      &footprints,
                const StepConstraints<dim> &constraints,
                const BackgroundGrid<dim>  &grid,
                const Discretization<dim>  &discretization)
  {
    NodalMotion motion;
    for (Vector *vector :
         {&motion.mass, &motion.velocity, &motion.acceleration})
      discretization.initialize(*vector);
    std::vector<Tensor<1, dim>> at_points(points.size());
    const auto spread = [&](const unsigned int offset, Vector &vector) {
      for (unsigned int p = 0; p < points.size(); ++p)
        at_points[p] = points.mass(p) * points.vector(p, offset);
      footprints.spread(at_points, vector);
    };
    // Adds m_p S_I v_p(x_I).
    const auto add_momentum = [&](const auto &velocity) {
      for (const auto &cell : footprints.cells)
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
            {
              const unsigned int p = footprints.point[e], node = cell.nodes[n];
              const auto v = velocity(p, discretization.node_positions[node]);
              for (unsigned int c = 0; c < dim; ++c)
                motion.velocity.local_element(dim * node + c) +=
                  points.mass(p) * footprints.value(e)[n] * v[c];
            }
    };

    // Lumped; hanging nodes hand theirs to their masters, so that the sums
    // over all nodes stay those over all points.
    for (unsigned int p = 0; p < points.size(); ++p)
      for (unsigned int d = 0; d < dim; ++d)
        at_points[p][d] = points.mass(p);
    footprints.spread(at_points, motion.mass);
    motion.mass.compress(VectorOperation::add);
    discretization.condense_hanging(motion.mass);

    if (const auto &state = grid.nodal_state(); state.velocity.size() > 0)
      {
        motion.velocity     = state.velocity;
        motion.acceleration = state.acceleration;
        return motion;
      }
    if (grid.is_lagrangian)
      {
        // Weighed by mass where bodies meet.
        add_momentum([&](const unsigned int p, const Point<dim> &x) {
          Tensor<1, dim> v;
          if (const auto &velocity = bodies[points.body(p)].velocity)
            for (unsigned int c = 0; c < dim; ++c)
              v[c] = velocity->value(x, c);
          return v;
        });
        average_over_mass(discretization, motion.mass, motion.velocity);
        return motion;
      }

    spread(points.offset_velocity, motion.velocity);
    if (points.offset_affine > 0)
      {
        // C_p (x_I - x_p), where x_p is what the footprint makes of the nodes'
        // places, so that its sum is zero.
        Vector places;
        discretization.initialize(places);
        for (unsigned int i = 0; i < places.locally_owned_size(); ++i)
          places.local_element(i) =
            discretization.node_positions[i / dim][i % dim];
        places.update_ghost_values();
        footprints.interpolate(places, at_points);
        add_momentum([&](const unsigned int p, const Point<dim> &x) {
          Tensor<2, dim> C;
          for (unsigned int d = 0; d < dim; ++d)
            C[d] = points.vector(p, points.offset_affine + d * dim);
          return C * (x - at_points[p]);
        });
      }
    average_over_mass(discretization, motion.mass, motion.velocity);
    constraints.stop_held(motion.velocity);

    if (points.offset_acceleration > 0)
      {
        spread(points.offset_acceleration, motion.acceleration);
        average_over_mass(discretization, motion.mass, motion.acceleration);
        constraints.stop_held(motion.acceleration);
      }
    return motion;
  }

  template <int dim>
  void
  advance_points(const StepProblem<dim> &problem,
                 const StepResult       &result,
                 const TimeSpec         &time,
                 MaterialPoints<dim>    &points)
  {
    std::vector<Tensor<1, dim>> motion;
    problem.footprints.interpolate(result.increment, motion);
    unsigned int p = 0;
    for (auto &particle : points.sorted.particles)
      {
        particle.set_location(particle.get_location() + motion[p]);
        double *fields      = points.fields(p);
        double *deformation = fields + points.offset_deformation;
        points.layout.store_tensor(problem.response.increment(p) *
                                     points.layout.load_tensor(deformation),
                                   deformation);
        if (points.offset_stress > 0)
          std::copy_n(problem.response.end_stress(p),
                      points.layout.n_components(
                        PointLayout::Kind::symmetric_tensor),
                      fields + points.offset_stress);
        std::copy_n(problem.response.trial_history(p),
                    points.history_size(),
                    fields + points.offset_history);
        ++p;
      }
    if (points.offset_velocity > 0)
      advance_velocities(problem, time.transfer, result.velocity, points);
    if (points.offset_acceleration > 0)
      {
        if (time.transfer == TransferKind::flip)
          add_unseen_acceleration(problem,
                                  (1 - time.gamma) * problem.dt,
                                  points);
        problem.footprints.interpolate(result.acceleration, motion);
        for (unsigned int q = 0; q < points.size(); ++q)
          points.set_vector(q, points.offset_acceleration, motion[q]);
      }
  }

  template decltype(gather_motion<2>)  gather_motion<2>;
  template decltype(gather_motion<3>)  gather_motion<3>;
  template decltype(advance_points<2>) advance_points<2>;
  template decltype(advance_points<3>) advance_points<3>;
} // namespace impm
