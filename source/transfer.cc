#include <impm/transfer.h>

#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Sum of nodal values at an entry of the footprints. */
    template <int dim>
    Tensor<1, dim>
    interpolate(const typename Footprints<dim>::Cell &cell,
                const double                         *values,
                const Vector                         &vector)
    {
      Tensor<1, dim> sum;
      for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
        for (unsigned int d = 0; d < dim; ++d)
          sum[d] += values[n] * vector.local_element(dim * cell.nodes[n] + d);
      return sum;
    }
  } // namespace

  template <int dim>
  void
  advance_points(const MomentumBalance<dim> &balance,
                 const Vector               &u,
                 const Vector               &velocity_change,
                 MaterialPoints<dim>        &points)
  {
    const auto &footprints = balance.footprints();
    auto        particle   = points.sorted.particles.begin();
    for (const auto &cell : footprints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e, ++particle)
        {
          const unsigned int p      = footprints.point[e];
          double            *fields = points.fields(p);
          particle->set_location(
            particle->get_location() +
            interpolate<dim>(cell, footprints.value(e), u));

          Tensor<2, 3> increment = balance.increment_gradient(p);
          for (unsigned int d = 0; d < 3; ++d)
            increment[d][d] += 1;
          double *deformation = fields + points.offset_deformation;
          points.layout.store_tensor(increment *
                                       points.layout.load_tensor(deformation),
                                     deformation);
          std::copy_n(balance.trial_history(p),
                      points.history_size(),
                      fields + points.offset_history);
          if (points.offset_velocity > 0)
            {
              const auto change =
                interpolate<dim>(cell, footprints.value(e), velocity_change);
              for (unsigned int d = 0; d < dim; ++d)
                fields[points.offset_velocity + d] += change[d];
            }
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
    double      largest    = 0;
    const auto &footprints = balance.footprints();
    auto        particle   = points.sorted.particles.begin();
    for (const auto &cell : footprints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e, ++particle)
        {
          const auto motion = interpolate<dim>(cell, footprints.value(e), u) -
                              grid_motion(particle->get_location());
          for (unsigned int d = 0; d < dim; ++d)
            largest =
              std::max(largest,
                       std::abs(motion[d]) / cell.cell->extent_in_direction(d));
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
    std::string outside;
    auto        particle = points.sorted.particles.begin();
    for (const auto &cell : balance.footprints().cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e, ++particle)
        {
          const auto x =
            particle->get_location() +
            interpolate<dim>(cell, balance.footprints().value(e), u);
          for (unsigned int f = 0; f < 2 * dim && outside.empty(); ++f)
            if (f % 2 == 0 ? x[f / 2] < faces[f] : x[f / 2] > faces[f])
              {
                std::ostringstream text;
                text << "point " << particle->get_id() << " at "
                     << particle->get_location()
                     << " would leave the domain through its "
                     << face_names()[f] << " face";
                outside = text.str();
              }
        }
    for (const auto &text :
         Utilities::MPI::all_gather(balance.grid.communicator, outside))
      if (!text.empty())
        return text;
    return outside;
  }

  template std::string
  find_point_outside(const MomentumBalance<2> &,
                     const Vector &,
                     const MaterialPoints<2> &,
                     const std::array<double, 4> &);
  template std::string
  find_point_outside(const MomentumBalance<3> &,
                     const Vector &,
                     const MaterialPoints<3> &,
                     const std::array<double, 6> &);
  template void
  advance_points(const MomentumBalance<2> &,
                 const Vector &,
                 const Vector &,
                 MaterialPoints<2> &);
  template void
  advance_points(const MomentumBalance<3> &,
                 const Vector &,
                 const Vector &,
                 MaterialPoints<3> &);
  template double
  largest_motion(const MomentumBalance<2> &,
                 const Vector &,
                 const MaterialPoints<2> &,
                 const std::function<Tensor<1, 2>(const Point<2> &)> &);
  template double
  largest_motion(const MomentumBalance<3> &,
                 const Vector &,
                 const MaterialPoints<3> &,
                 const std::function<Tensor<1, 3>(const Point<3> &)> &);
} // namespace impm
