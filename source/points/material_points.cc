#include <deal.II/base/function_parser.h>
#include <deal.II/base/mpi.h>

#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/grid_tools_cache.h>

#include <impm/balance/terms/loads.h>
#include <impm/base/exceptions.h>
#include <impm/points/material_points.h>

#include <boost/lexical_cast.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool
    is_inside(const BackgroundGrid<dim> &grid, const Point<dim> &place)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (place[d] < grid.face_of_vertices(2 * d) ||
            place[d] > grid.face_of_vertices(2 * d + 1))
          return false;
      return true;
    }
    template <int dim>
    Tensor<1, dim>
    in_plane(const Tensor<1, 3> &vector)
    {
      Tensor<1, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = vector[d];
      return result;
    }
  } // namespace

  void
  start_history(const Material &material,
                const Point<3> &place,
                double         *history)
  {
    material.initialize_history(history);
    if (const auto &prescribed = material.prescribed_temperature)
      {
        prescribed->set_time(0);
        history[material.temperature_offset] = prescribed->value(place);
      }
    if (material.conducts())
      history[material.temperature_offset] =
        material.temperature_at_start->value(place) -
        material.initial_temperature;
  }

  template <int dim>
  SortedParticles<dim>::SortedParticles(const BackgroundGrid<dim> &grid,
                                        const unsigned int n_doubles_per_point)
    : particles(grid.triangulation, *grid.mapping, n_doubles_per_point)
    , grid(grid)
  {
    particles.signals.particle_lost.connect(
      [this](const typename Particles::ParticleIterator<dim> &particle,
             const typename Triangulation<dim>::active_cell_iterator &) {
        lost = "point " + std::to_string(particle->get_id()) + " at " +
               boost::lexical_cast<std::string>(particle->get_location());
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
    auto id = next_id + first;
    next_id += Utilities::MPI::sum(n, grid.communicator);

    std::vector<double> values(particles.n_properties_per_particle());
    for (const auto &seed : seeds)
      {
        if (fill)
          fill(seed, values.data());
        particles.insert_particle(seed.position,
                                  seed.unit_position,
                                  id++,
                                  seed.cell,
                                  make_array_view(std::as_const(values)));
      }
    particles.update_cached_numbers();
  }

  template <int dim>
  void
  SortedParticles<dim>::sort()
  {
    // They stay in their cells wherever these go.
    if (grid.is_moved())
      return;
    const auto before = particles.n_global_particles();
    lost.clear();
    send_far();
    particles.sort_particles_into_subdomains_and_cells();
    const auto missing = before - particles.n_global_particles();
    if (missing == 0)
      return;
    // Some rank knows a name for one of them, or none does: a particle that
    // vanished on its way between ranks gives no signal.
    std::string named = "none of them was seen leaving";
    for (const auto &name : Utilities::MPI::all_gather(grid.communicator, lost))
      if (!name.empty())
        named = name + " is one of them";
    throw ComputationError(
      std::to_string(missing) +
      " points have left the domain or were lost between ranks: " + named);
  }

  template <int dim>
  void
  SortedParticles<dim>::send_far()
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator) == 1)
      return;
    // Beyond the neighbours, which may be half as large and whose cells a rank
    // knows.
    const auto is_far = [&](const auto &particle) {
      const auto cell  = particle->get_surrounding_cell();
      const auto place = particle->get_location();
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double lower  = cell->vertex(0)[d];
          const double extent = cell_extent(cell, d);
          if (place[d] < lower - 0.49 * extent ||
              place[d] > lower + 1.49 * extent)
            return is_inside(grid, place);
        }
      return false;
    };
    std::vector<typename Particles::ParticleHandler<dim>::particle_iterator>
                                     far;
    std::vector<Point<dim>>          places;
    std::vector<std::vector<double>> records; // fields, place, number
    for (auto particle = particles.begin(); particle != particles.end();
         ++particle)
      if (is_far(particle))
        {
          const auto fields = particle->get_properties();
          far.push_back(particle);
          // Off the faces of cells, of which more than one rank has each, or by
          // round-off none; sort() mends what that costs.
          auto place = particle->get_location();
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double lower = grid.face_of_vertices(2 * d);
              const double upper = grid.face_of_vertices(2 * d + 1);
              place[d] += 1e-9 * (lower + 0.4142 * (upper - lower) - place[d]);
            }
          places.push_back(place);
          records.emplace_back(fields.begin(), fields.end());
          for (unsigned int d = 0; d < dim; ++d)
            records.back().push_back(particle->get_location()[d]);
          records.back().push_back(particle->get_id());
        }
    if (Utilities::MPI::max<unsigned int>(far.size(), grid.communicator) == 0)
      return;
    particles.remove_particles(far);

    // The ranks that have their cells ask for them by number in `places`.
    const auto boxes = GridTools::exchange_local_bounding_boxes(
      GridTools::compute_mesh_predicate_bounding_box(
        grid.triangulation,
        std::function<bool(
          const typename Triangulation<dim>::active_cell_iterator &)>(
          IteratorFilters::LocallyOwnedCell())),
      grid.communicator);
    const GridTools::Cache<dim> cache(grid.triangulation, *grid.mapping);
    const auto                  located =
      GridTools::distributed_compute_point_locations(cache, places, boxes);
    const auto &cells   = std::get<0>(located);
    const auto &indices = std::get<2>(located);
    const auto &owners  = std::get<4>(located);
    std::map<unsigned int, std::vector<unsigned int>> wanted;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int i = 0; i < indices[c].size(); ++i)
        wanted[owners[c][i]].push_back(indices[c][i]);
    std::map<unsigned int, std::vector<std::vector<double>>> answers;
    for (const auto &[rank, some] :
         Utilities::MPI::some_to_some(grid.communicator, wanted))
      for (const unsigned int i : some)
        answers[rank].push_back(records[i]);
    const auto received =
      Utilities::MPI::some_to_some(grid.communicator, answers);
    std::map<unsigned int, unsigned int> next;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int i = 0; i < indices[c].size(); ++i)
        {
          const unsigned int owner       = owners[c][i];
          auto               fields      = received.at(owner)[next[owner]++];
          const types::particle_index id = fields.back();
          fields.pop_back();
          Point<dim> place, unit_place;
          for (unsigned int d = dim; d-- > 0; fields.pop_back())
            {
              place[d] = fields.back();
              unit_place[d] =
                (place[d] - cells[c]->vertex(0)[d]) / cell_extent(cells[c], d);
            }
          particles.insert_particle(place,
                                    unit_place,
                                    id,
                                    cells[c],
                                    make_array_view(std::as_const(fields)));
        }
    particles.update_cached_numbers();
  }

  template <int dim>
  bool
  SortedParticles<dim>::are_in_order() const
  {
    bool         are  = true;
    unsigned int last = 0;
    for (const auto &particle : particles)
      {
        const auto cell = particle.get_surrounding_cell()->active_cell_index();
        are             = are && last <= cell;
        last            = cell;
      }
    return Utilities::MPI::min(are ? 1 : 0, grid.communicator) == 1;
  }

  template <int dim>
  MaterialPoints<dim>::MaterialPoints(const PointLayout         &layout,
                                      const PointLayout         &history,
                                      const Bodies<dim>         &bodies,
                                      const Tractions<dim>      &tractions,
                                      const BackgroundGrid<dim> &grid,
                                      const bool                 is_draft)
    : layout(layout)
    , sorted(grid, layout.size())
    , offset_deformation(layout.offset("deformation_gradient"))
    , offset_history(layout.size() - history.size())
    , offset_velocity(layout.find("velocity").value_or(0))
    , offset_rate(layout.find("displacement_rate").value_or(0))
    , offset_acceleration(layout.find("acceleration").value_or(0))
    , offset_affine(layout.find("velocity_gradient_x").value_or(0))
    , offset_gradient(
        layout.find("grid_velocity_gradient_x").value_or(offset_affine))
    , offset_stress(layout.find("stress").value_or(0))
    , offset_initial_position(layout.find("initial_position").value_or(0))
    , offset_touched(layout.find("touched_faces").value_or(0))
    , offset_temperature_gradient(
        layout.find("temperature_gradient").value_or(0))
    , history_layout(history)
    , communicator(grid.communicator)
  {
    const auto copy = [](const Tensor<1, dim> &from, double *to) {
      std::copy_n(from.begin_raw(), dim, to);
    };
    for (const auto &body : bodies)
      {
        const auto fill = [&](const Seed<dim> &seed, double *values) {
          std::fill_n(values, layout.size(), 0.);
          values[layout.offset("body")]           = materials.size();
          values[layout.offset("initial_volume")] = seed.volume;
          layout.store_tensor(unit_symmetric_tensor<3>(),
                              values + offset_deformation);
          if (body.velocity && offset_velocity > 0)
            for (unsigned int c = 0; c < dim; ++c)
              {
                values[offset_velocity + c] =
                  body.velocity->value(seed.position, c);
                // Else the grid would get less spin than the points have.
                if (offset_gradient > 0)
                  copy(body.velocity->gradient(seed.position, c),
                       values + offset_gradient + dim * c);
              }
          if (offset_initial_position > 0)
            copy(seed.position, values + offset_initial_position);
          if (const auto offset = layout.find("parent"))
            values[*offset] = -1; // none
          if (const auto offset = layout.find("initial_domain"))
            copy(seed.domain, values + *offset);
          // All faces, as far as they are there.
          if (offset_touched > 0)
            values[offset_touched] = (1u << (2 * dim)) - 1;
          for (const auto &traction : tractions)
            if (traction.body == body.name)
              values[layout.offset(traction_field(traction))] =
                traction_area(traction, seed);
          Point<3> place;
          for (unsigned int d = 0; d < dim; ++d)
            place[d] = seed.position[d];
          start_history(*body.material, place, values + offset_history);
          if (body.material->conducts())
            copy(in_plane<dim>(
                   body.material->temperature_at_start->gradient(place)),
                 values + offset_temperature_gradient);
        };
        if (!body.rigid)
          sorted.insert(
            seed_body(bodies, body, layout.geometry, grid, is_draft), fill);
        materials.push_back(body.material);
        names.push_back(body.name);
        layers.push_back(body.layer);
      }
    if (sorted.are_in_order())
      take_addresses();
    else
      sort();
    if (!is_draft)
      count_points_under_tractions(tractions, *this);
  }

  template <int dim>
  void
  MaterialPoints<dim>::sort()
  {
    sorted.sort();
    take_addresses();
  }

  template <int dim>
  void
  MaterialPoints<dim>::take_addresses()
  {
    data.clear();
    ids.clear();
    data.reserve(sorted.particles.n_locally_owned_particles());
    ids.reserve(sorted.particles.n_locally_owned_particles());
    for (auto &particle : sorted.particles)
      {
        data.push_back(particle.get_properties().data());
        ids.push_back(particle.get_id());
      }
  }

  template <int dim>
  double
  MaterialPoints<dim>::largest_speed() const
  {
    double wave = 0, square = 0;
    for (unsigned int p = 0; p < size(); ++p)
      {
        wave = std::max(wave, material(p).wave_speed());
        if (offset_velocity > 0)
          square = std::max(square, velocity(p).norm_square());
      }
    return Utilities::MPI::max(wave, communicator) +
           std::sqrt(Utilities::MPI::max(square, communicator));
  }

  template class SortedParticles<2>;
  template class SortedParticles<3>;
  template class MaterialPoints<2>;
  template class MaterialPoints<3>;
} // namespace impm
