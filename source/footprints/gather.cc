#include <impm/footprints/gather.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /**
     * Momentum of the affine part: m_p S_I C_p (x_I - x_p), where x_p is what
     * the footprint makes of the nodes' places, so that its sum is zero.
     */
    template <int dim>
    void
    add_affine_momentum(const MaterialPoints<dim> &points,
                        const Footprints<dim>     &footprints,
                        const Discretization<dim> &discretization,
                        Vector                    &momentum)
    {
      const auto                 &nodes = discretization.node_positions;
      std::vector<Tensor<1, dim>> centre(points.size());
      for (const auto &cell : footprints.cells)
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
            centre[footprints.point[e]] +=
              footprints.value(e)[n] * Tensor<1, dim>(nodes[cell.nodes[n]]);
      for (const auto &cell : footprints.cells)
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            const unsigned int p = footprints.point[e];
            const double      *C = points.fields(p) + points.offset_affine;
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              {
                const double share = points.mass(p) * footprints.value(e)[n];
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int d = 0; d < dim; ++d)
                    momentum.local_element(dim * cell.nodes[n] + c) +=
                      share * C[dim * c + d] *
                      (nodes[cell.nodes[n]][d] - centre[p][d]);
              }
          }
    }
    /** The same of a Lagrangian grid before its first step. */
    template <int dim>
    void
    interpolate_initial_velocity(const Bodies<dim>         &bodies,
                                 const MaterialPoints<dim> &points,
                                 const Footprints<dim>     &footprints,
                                 const Discretization<dim> &discretization,
                                 Vector                    &momentum)
    {
      // Weighed by mass where bodies meet.
      dealii::Vector<double> value(dim);
      for (const auto &cell : footprints.cells)
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            const unsigned int p    = footprints.point[e];
            const auto        &body = bodies[points.body(p)];
            if (!body.velocity)
              continue;
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              {
                body.velocity->vector_value(
                  discretization.node_positions[cell.nodes[n]], value);
                for (unsigned int c = 0; c < dim; ++c)
                  momentum.local_element(dim * cell.nodes[n] + c) +=
                    points.mass(p) * footprints.value(e)[n] * value[c];
              }
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
    // Lumped; hanging nodes hand theirs to their masters, so that the sums
    // over all nodes stay those over all points.
    NodalMotion motion;
    for (Vector *vector :
         {&motion.mass, &motion.velocity, &motion.acceleration})
      discretization.initialize(*vector);
    std::vector<Tensor<1, dim>> at_points(points.size());
    const auto gather = [&](const auto &quantity, Vector &vector) {
      for (unsigned int p = 0; p < points.size(); ++p)
        at_points[p] = points.mass(p) * quantity(p);
      footprints.spread(at_points, vector);
    };
    const auto finish = [&](Vector &vector) {
      vector.compress(VectorOperation::add);
      discretization.condense_hanging(vector);
    };
    const auto divide_by_mass = [&](Vector &vector) {
      for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
        if (motion.mass.local_element(i) > 0)
          vector.local_element(i) /= motion.mass.local_element(i);
    };

    Tensor<1, dim> ones;
    for (unsigned int d = 0; d < dim; ++d)
      ones[d] = 1;
    gather([&](const unsigned int) { return ones; }, motion.mass);
    finish(motion.mass);
    if (grid.nodes_have_motion())
      {
        motion.velocity     = grid.nodal_state().velocity;
        motion.acceleration = grid.nodal_state().acceleration;
        return motion;
      }
    if (grid.is_lagrangian)
      {
        interpolate_initial_velocity(
          bodies, points, footprints, discretization, motion.velocity);
        finish(motion.velocity);
        divide_by_mass(motion.velocity);
        return motion;
      }
    gather([&](const unsigned int p) { return points.velocity(p); },
           motion.velocity);
    if (points.offset_affine > 0)
      add_affine_momentum(points, footprints, discretization, motion.velocity);
    finish(motion.velocity);
    divide_by_mass(motion.velocity);
    constraints.stop_held(motion.velocity);
    if (points.offset_acceleration > 0)
      {
        gather(
          [&](const unsigned int p) {
            return points.vector(p, points.offset_acceleration);
          },
          motion.acceleration);
        finish(motion.acceleration);
        divide_by_mass(motion.acceleration);
        constraints.stop_held(motion.acceleration);
      }
    return motion;
  }

  template NodalMotion
  gather_motion(const MaterialPoints<2> &,
                const Bodies<2> &,
                const Footprints<2> &,
                const StepConstraints<2> &,
                const BackgroundGrid<2> &,
                const Discretization<2> &);
  template NodalMotion
  gather_motion(const MaterialPoints<3> &,
                const Bodies<3> &,
                const Footprints<3> &,
                const StepConstraints<3> &,
                const BackgroundGrid<3> &,
                const Discretization<3> &);
} // namespace impm
