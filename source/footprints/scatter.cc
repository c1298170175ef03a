#include <impm/footprints/scatter.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
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
      std::vector<Tensor<1, dim>> own(points.size()), seen;
      for (unsigned int p = 0; p < points.size(); ++p)
        own[p] = points.mass(p) * points.vector(p, points.offset_acceleration);
      Vector mean;
      problem.discretization->initialize(mean);
      problem.footprints.spread(own, mean);
      mean.compress(VectorOperation::add);
      problem.discretization->condense_hanging(mean);
      const Vector &mass = problem.motion.mass;
      for (unsigned int i = 0; i < mean.locally_owned_size(); ++i)
        if (mass.local_element(i) > 0)
          mean.local_element(i) /= mass.local_element(i);
      problem.discretization->interpolate_hanging(mean);
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
    if (points.offset_acceleration > 0 && time.transfer == TransferKind::flip)
      add_unseen_acceleration(problem, (1 - time.gamma) * problem.dt, points);
    if (points.offset_acceleration > 0)
      {
        problem.footprints.interpolate(result.acceleration, motion);
        for (unsigned int q = 0; q < points.size(); ++q)
          points.set_vector(q, points.offset_acceleration, motion[q]);
      }
  }

  template void
  advance_points(const StepProblem<2> &,
                 const StepResult &,
                 const TimeSpec &,
                 MaterialPoints<2> &);
  template void
  advance_points(const StepProblem<3> &,
                 const StepResult &,
                 const TimeSpec &,
                 MaterialPoints<3> &);
} // namespace impm
