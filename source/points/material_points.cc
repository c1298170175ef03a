#include <deal.II/base/mpi.h>

#include <impm/balance/terms/loads.h>
#include <impm/base/exceptions.h>
#include <impm/points/material_points.h>
#include <impm/scene/seeding.h>

#include <algorithm>
#include <sstream>

namespace impm
{
  using namespace dealii;

  template <int dim>
  SortedParticles<dim>::SortedParticles(const BackgroundGrid<dim> &grid,
                                        const unsigned int n_doubles_per_point)
    : particles(grid.triangulation, *grid.mapping, n_doubles_per_point)
    , grid(grid)
  {
    particles.signals.particle_lost.connect(
      [this](const typename Particles::ParticleIterator<dim> &particle,
             const typename Triangulation<dim>::active_cell_iterator &) {
        std::ostringstream place;
        place << "point " << particle->get_id() << " at "
              << particle->get_location();
        lost = place.str();
      });
  }

  template <int dim>
  void
  SortedParticles<dim>::insert(
    const std::vector<Seed<dim>>                           &seeds,
    const std::function<void(const Seed<dim> &, double *)> &fill)
  {
    const unsigned int n     = seeds.size();
    unsigned int       first = 0;
    const int          error =
      MPI_Exscan(&n, &first, 1, MPI_UNSIGNED, MPI_SUM, grid.communicator);
    AssertThrowMPI(error);
    auto id = particles.get_next_free_particle_index() + first;

    std::vector<double> values(particles.n_properties_per_particle());
    for (const auto &seed : seeds)
      {
        if (fill)
          fill(seed, values.data());
        particles.insert_particle(seed.position,
                                  seed.unit_position,
                                  id++,
                                  seed.cell,
                                  ArrayView<const double>(values.data(),
                                                          values.size()));
      }
    particles.update_cached_numbers();
  }

  template <int dim>
  void
  SortedParticles<dim>::sort()
  {
    // Gauss points stay in their cells wherever these go.
    if (grid.is_lagrangian)
      return;
    const auto before = particles.n_global_particles();
    particles.sort_particles_into_subdomains_and_cells();
    const auto missing = before - particles.n_global_particles();
    if (missing == 0)
      return;
    // Some rank knows a name for one of them, or none does: a particle that
    // vanished on its way between ranks gives no signal.
    const auto  names = Utilities::MPI::all_gather(grid.communicator, lost);
    std::string named = "none of them was seen leaving";
    for (const auto &name : names)
      if (!name.empty())
        named = name + " is one of them";
    throw ComputationError(std::to_string(missing) +
                           " points have left the domain: " + named);
  }

  namespace
  {
    unsigned int
    offset_or_zero(const PointLayout &layout, const std::string &name)
    {
      return layout.has(name) ? layout.offset(name) : 0;
    }
  } // namespace

  template <int dim>
  MaterialPoints<dim>::MaterialPoints(const PointLayout         &layout,
                                      const PointLayout         &history,
                                      const Bodies<dim>         &bodies,
                                      const Tractions<dim>      &tractions,
                                      const BackgroundGrid<dim> &grid)
    : layout(layout)
    , sorted(grid, layout.size())
    , offset_deformation(layout.offset("deformation_gradient"))
    , offset_history(layout.size() - history.size())
    , offset_velocity(offset_or_zero(layout, "velocity"))
    , offset_acceleration(offset_or_zero(layout, "acceleration"))
    , offset_affine(offset_or_zero(layout, "velocity_gradient_x"))
    , offset_stress(offset_or_zero(layout, "stress"))
    , offset_initial_position(offset_or_zero(layout, "initial_position"))
    , history_layout(history)
    , communicator(grid.communicator)
  {
    Tensor<2, 3> identity;
    for (unsigned int d = 0; d < 3; ++d)
      identity[d][d] = 1;

    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto &body = bodies[b];
        materials.push_back(body.material);
        if (body.rigid)
          continue;
        sorted.insert(
          seed_body(bodies, body, layout.geometry, grid),
          [&](const Seed<dim> &seed, double *values) {
            std::fill_n(values, layout.size(), 0.);
            values[layout.offset("body")]           = b;
            values[layout.offset("initial_volume")] = seed.volume;
            layout.store_tensor(identity, values + offset_deformation);
            if (offset_velocity > 0)
              {
                dealii::Vector<double> velocity(dim);
                if (body.velocity)
                  body.velocity->vector_value(seed.position, velocity);
                std::copy(velocity.begin(),
                          velocity.end(),
                          values + offset_velocity);
                // Without it the grid would get less spin than the points have.
                if (body.velocity && offset_affine > 0)
                  for (unsigned int c = 0; c < dim; ++c)
                    {
                      const auto gradient =
                        body.velocity->gradient(seed.position, c);
                      std::copy_n(gradient.begin_raw(),
                                  dim,
                                  values + offset_affine + dim * c);
                    }
              }
            for (unsigned int d = 0; d < dim; ++d)
              {
                if (layout.has("initial_position"))
                  values[layout.offset("initial_position") + d] =
                    seed.position[d];
                if (layout.has("initial_domain"))
                  values[layout.offset("initial_domain") + d] = seed.domain[d];
              }
            for (const auto &traction : tractions)
              if (traction.body == body.name)
                values[layout.offset(traction_field(traction))] =
                  traction_area(traction, seed);
            body.material->initialize_history(values + offset_history);
          });
      }
    sort();
    count_points_under_tractions(tractions, *this);
  }

  template <int dim>
  bool
  MaterialPoints<dim>::have_temperature() const
  {
    return std::all_of(materials.begin(),
                       materials.end(),
                       [](const auto &material) {
                         return !material || material->specific_heat > 0;
                       });
  }

  template <int dim>
  void
  MaterialPoints<dim>::sort()
  {
    sorted.sort();
    data.clear();
    for (auto &particle : sorted.particles)
      data.push_back(particle.get_properties().data());
  }

  template class SortedParticles<2>;
  template class SortedParticles<3>;
  template <int dim>
  double
  largest_speed(const MaterialPoints<dim> &points)
  {
    double wave = 0, square = 0;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        wave = std::max(wave, points.material(p).wave_speed());
        if (points.offset_velocity == 0)
          continue;
        double sum = 0;
        for (unsigned int d = 0; d < dim; ++d)
          sum += std::pow(points.fields(p)[points.offset_velocity + d], 2);
        square = std::max(square, sum);
      }
    wave   = Utilities::MPI::max(wave, points.communicator);
    square = Utilities::MPI::max(square, points.communicator);
    return wave + std::sqrt(square);
  }

  template double
  largest_speed(const MaterialPoints<2> &);
  template double
  largest_speed(const MaterialPoints<3> &);
  template class MaterialPoints<2>;
  template class MaterialPoints<3>;
} // namespace impm
