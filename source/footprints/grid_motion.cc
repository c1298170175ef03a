#include <impm/footprints/grid_motion.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Tensor<1, dim>
    load_vector(const double *values)
    {
      Tensor<1, dim> vector;
      for (unsigned int d = 0; d < dim; ++d)
        vector[d] = values[d];
      return vector;
    }

    /**
     * Momentum of the affine part: m_p S_I C_p (x_I - x_p), where x_p is what
     * the footprint makes of the nodes' places, so that its sum is zero.
     */
    template <int dim>
    void
    add_affine_momentum(const MaterialPoints<dim> &points,
                        const Footprints<dim>     &footprints,
                        const BackgroundGrid<dim> &grid,
                        Vector                    &momentum)
    {
      const auto                 &nodes = grid.node_positions();
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
  } // namespace

  template <int dim>
  void
  gather_motion(const MaterialPoints<dim>  &points,
                const Footprints<dim>      &footprints,
                const StepConstraints<dim> &constraints,
                const BackgroundGrid<dim>  &grid,
                Vector                     &mass,
                Vector                     &velocity,
                Vector                     &acceleration)
  {
    // Lumped; hanging nodes hand theirs to their masters, so that the sums
    // over all nodes stay those over all points.
    std::vector<Tensor<1, dim>> at_points(points.size());
    const auto gather = [&](const auto &quantity, Vector &vector) {
      for (unsigned int p = 0; p < points.size(); ++p)
        at_points[p] = points.mass(p) * quantity(p);
      vector = 0;
      footprints.spread(at_points, vector);
    };
    const auto finish = [&](Vector &vector) {
      vector.compress(VectorOperation::add);
      constraints.condense_hanging(vector);
    };
    const auto divide_by_mass = [&](Vector &vector) {
      for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
        if (mass.local_element(i) > 0)
          vector.local_element(i) /= mass.local_element(i);
    };

    Tensor<1, dim> ones;
    for (unsigned int d = 0; d < dim; ++d)
      ones[d] = 1;
    gather([&](const unsigned int) { return ones; }, mass);
    finish(mass);
    gather(
      [&](const unsigned int p) {
        return load_vector<dim>(points.fields(p) + points.offset_velocity);
      },
      velocity);
    if (points.offset_affine > 0)
      add_affine_momentum(points, footprints, grid, velocity);
    finish(velocity);
    divide_by_mass(velocity);
    constraints.stop_held(velocity);
    if (points.offset_acceleration > 0)
      {
        gather(
          [&](const unsigned int p) {
            return load_vector<dim>(points.fields(p) +
                                    points.offset_acceleration);
          },
          acceleration);
        finish(acceleration);
        divide_by_mass(acceleration);
        constraints.stop_held(acceleration);
      }
  }

  template <int dim>
  void
  interpolate_initial_velocity(const Bodies<dim>          &bodies,
                               const MaterialPoints<dim>  &points,
                               const Footprints<dim>      &footprints,
                               const StepConstraints<dim> &constraints,
                               const BackgroundGrid<dim>  &grid,
                               const Vector               &mass,
                               Vector                     &velocity)
  {
    // Weighed by mass where bodies meet.
    velocity = 0;
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
              body.velocity->vector_value(grid.node_positions()[cell.nodes[n]],
                                          value);
              for (unsigned int c = 0; c < dim; ++c)
                velocity.local_element(dim * cell.nodes[n] + c) +=
                  points.mass(p) * footprints.value(e)[n] * value[c];
            }
        }
    velocity.compress(VectorOperation::add);
    constraints.condense_hanging(velocity);
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      if (mass.local_element(i) > 0)
        velocity.local_element(i) /= mass.local_element(i);
  }

  template void
  gather_motion(const MaterialPoints<2> &,
                const Footprints<2> &,
                const StepConstraints<2> &,
                const BackgroundGrid<2> &,
                Vector &,
                Vector &,
                Vector &);
  template void
  interpolate_initial_velocity(const Bodies<2> &,
                               const MaterialPoints<2> &,
                               const Footprints<2> &,
                               const StepConstraints<2> &,
                               const BackgroundGrid<2> &,
                               const Vector &,
                               Vector &);
  template void
  gather_motion(const MaterialPoints<3> &,
                const Footprints<3> &,
                const StepConstraints<3> &,
                const BackgroundGrid<3> &,
                Vector &,
                Vector &,
                Vector &);
  template void
  interpolate_initial_velocity(const Bodies<3> &,
                               const MaterialPoints<3> &,
                               const Footprints<3> &,
                               const StepConstraints<3> &,
                               const BackgroundGrid<3> &,
                               const Vector &,
                               Vector &);
} // namespace impm
