#include <impm/footprints/transfer.h>

#include <sstream>

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

    template <int dim>
    void
    store_vector(const Tensor<1, dim> &vector, double *values)
    {
      for (unsigned int d = 0; d < dim; ++d)
        values[d] = vector[d];
    }

    /**
     * Adds `factor` times the part of the points' acceleration that the grid
     * does not see, since the change of its velocity counts but what it does.
     * It has no momentum.
     */
    template <int dim>
    void
    add_unseen_acceleration(const MomentumBalance<dim> &balance,
                            const double                factor,
                            MaterialPoints<dim>        &points)
    {
      std::vector<Tensor<1, dim>> own(points.size()), seen;
      const auto                 &footprints = balance.footprints();
      for (unsigned int p = 0; p < points.size(); ++p)
        own[p] = points.mass(p) * load_vector<dim>(points.fields(p) +
                                                   points.offset_acceleration);
      Vector mean;
      balance.grid.initialize(mean);
      footprints.spread(own, mean);
      mean.compress(VectorOperation::add);
      balance.constraints.condense_hanging(mean);
      for (unsigned int i = 0; i < mean.locally_owned_size(); ++i)
        if (balance.mass.local_element(i) > 0)
          mean.local_element(i) /= balance.mass.local_element(i);
      balance.constraints.interpolate_hanging(mean);
      footprints.interpolate(mean, seen);
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          double *velocity = points.fields(p) + points.offset_velocity;
          store_vector<dim>(load_vector<dim>(velocity) +
                              factor * (own[p] / points.mass(p) - seen[p]),
                            velocity);
        }
    }

    template <int dim>
    void
    advance_velocities(const MomentumBalance<dim> &balance,
                       const TransferKind          kind,
                       const Vector               &end_velocity,
                       MaterialPoints<dim>        &points)
    {
      const auto                 &footprints = balance.footprints();
      std::vector<Tensor<1, dim>> at_points;
      if (kind == TransferKind::flip)
        {
          Vector change = end_velocity;
          change -= balance.velocity;
          balance.constraints.interpolate_hanging(change);
          footprints.interpolate(change, at_points);
          for (unsigned int p = 0; p < points.size(); ++p)
            at_points[p] +=
              load_vector<dim>(points.fields(p) + points.offset_velocity);
        }
      else
        footprints.interpolate(end_velocity, at_points);
      for (unsigned int p = 0; p < points.size(); ++p)
        store_vector<dim>(at_points[p],
                          points.fields(p) + points.offset_velocity);
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
  advance_points(const MomentumBalance<dim> &balance,
                 const TimeSpec             &time,
                 const double                dt,
                 const Vector               &u,
                 const Vector               &end_velocity,
                 const Vector               &end_acceleration,
                 MaterialPoints<dim>        &points)
  {
    std::vector<Tensor<1, dim>> motion;
    balance.footprints().interpolate(u, motion);
    unsigned int p = 0;
    for (auto &particle : points.sorted.particles)
      {
        particle.set_location(particle.get_location() + motion[p]);
        double *fields      = points.fields(p);
        double *deformation = fields + points.offset_deformation;
        points.layout.store_tensor(balance.response.increment(p) *
                                     points.layout.load_tensor(deformation),
                                   deformation);
        if (points.offset_stress > 0)
          std::copy_n(balance.response.end_stress(p),
                      points.layout.n_components(
                        PointLayout::Kind::symmetric_tensor),
                      fields + points.offset_stress);
        std::copy_n(balance.response.trial_history(p),
                    points.history_size(),
                    fields + points.offset_history);
        ++p;
      }
    if (points.offset_velocity > 0)
      advance_velocities(balance, time.transfer, end_velocity, points);
    if (points.offset_acceleration > 0 && time.transfer == TransferKind::flip)
      add_unseen_acceleration(balance, (1 - time.gamma) * dt, points);
    if (points.offset_acceleration > 0)
      {
        balance.footprints().interpolate(end_acceleration, motion);
        for (unsigned int q = 0; q < points.size(); ++q)
          store_vector<dim>(motion[q],
                            points.fields(q) + points.offset_acceleration);
      }
  }

  template <int dim>
  double
  largest_motion(
    const MomentumBalance<dim>                              &balance,
    const Vector                                            &u,
    const MaterialPoints<dim>                               &points,
    const std::function<Tensor<1, dim>(const Point<dim> &)> &grid_motion)
  {
    std::vector<Tensor<1, dim>> motion;
    balance.footprints().interpolate(u, motion);
    double       largest = 0;
    unsigned int p       = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto relative =
          motion[p++] - grid_motion(particle.get_location());
        const auto cell = particle.get_surrounding_cell();
        for (unsigned int d = 0; d < dim; ++d)
          largest =
            std::max(largest, std::abs(relative[d]) / cell_extent(cell, d));
      }
    return Utilities::MPI::max(largest, balance.grid.communicator);
  }

  template <int dim>
  std::string
  find_point_outside(const MomentumBalance<dim>        &balance,
                     const Vector                      &u,
                     const MaterialPoints<dim>         &points,
                     const std::array<double, 2 * dim> &faces)
  {
    std::vector<Tensor<1, dim>> motion;
    balance.footprints().interpolate(u, motion);
    std::string  outside;
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto x = particle.get_location() + motion[p++];
        for (unsigned int f = 0; f < 2 * dim && outside.empty(); ++f)
          if (f % 2 == 0 ? x[f / 2] < faces[f] : x[f / 2] > faces[f])
            {
              std::ostringstream text;
              text << "point " << particle.get_id() << " at "
                   << particle.get_location()
                   << " would leave the domain through its " << face_names()[f]
                   << " face";
              outside = text.str();
            }
      }
    for (const auto &text :
         Utilities::MPI::all_gather(balance.grid.communicator, outside))
      if (!text.empty())
        return text;
    return outside;
  }

  template void
  advance_points(const MomentumBalance<2> &,
                 const TimeSpec &,
                 double,
                 const Vector &,
                 const Vector &,
                 const Vector &,
                 MaterialPoints<2> &);
  template double
  largest_motion(const MomentumBalance<2> &,
                 const Vector &,
                 const MaterialPoints<2> &,
                 const std::function<Tensor<1, 2>(const Point<2> &)> &);
  template std::string
  find_point_outside(const MomentumBalance<2> &,
                     const Vector &,
                     const MaterialPoints<2> &,
                     const std::array<double, 4> &);
  template void
  advance_points(const MomentumBalance<3> &,
                 const TimeSpec &,
                 double,
                 const Vector &,
                 const Vector &,
                 const Vector &,
                 MaterialPoints<3> &);
  template double
  largest_motion(const MomentumBalance<3> &,
                 const Vector &,
                 const MaterialPoints<3> &,
                 const std::function<Tensor<1, 3>(const Point<3> &)> &);
  template std::string
  find_point_outside(const MomentumBalance<3> &,
                     const Vector &,
                     const MaterialPoints<3> &,
                     const std::array<double, 6> &);
} // namespace impm
