#include <deal.II/base/mpi.h>

#include <impm/points/adapt_points.h>
#include <impm/points/point_domains.h>
#include <impm/points/point_shape.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Merges points, cell by cell. */
    template <int dim>
    class Merger
    {
    public:
      Merger(const Bodies<dim>         &bodies,
             const BackgroundGrid<dim> &grid,
             MaterialPoints<dim>       &points)
        : bodies(bodies)
        , grid(grid)
        , fields(points)

        , points(points)
        , gone(points.size(), 0)
      {
        for (auto particle = points.sorted.particles.begin();
             particle != points.sorted.particles.end();
             ++particle)
          particles.push_back(particle);
        // History is compared with the most that any point has gathered.
        for (const auto &body : bodies)
          {
            fresh.emplace_back(points.history_size());
            if (body.material)
              start_history(*body.material, {}, fresh.back().data());
          }
        for (const auto &field : points.history_layout.fields())
          {
            double largest = 0;
            for (unsigned int p = 0; p < points.size(); ++p)
              largest = std::max(largest, distance(field, p, no_point));
            scales.push_back(largest);
          }
        Utilities::MPI::max(scales, grid.communicator, scales);
      }

      PointChanges
      run()
      {
        for (unsigned int begin = 0, end; begin < points.size(); begin = end)
          {
            const auto cell = particles[begin]->get_surrounding_cell();
            end             = begin;
            while (end < points.size() &&
                   particles[end]->get_surrounding_cell() == cell)
              ++end;
            for (unsigned int b = 0; b < bodies.size(); ++b)
              if (bodies[b].adaptation == PointAdaptation::split_and_merge)
                {
                  std::vector<unsigned int> some;
                  for (unsigned int p = begin; p < end; ++p)
                    if (points.body(p) == b)
                      some.push_back(p);
                  merge(bodies[b],
                        {extents_of<dim>(cell), bodies[b].points_across},
                        some);
                }
          }
        changes.merges = Utilities::MPI::sum(changes.merges, grid.communicator);
        if (changes.merges == 0)
          return changes;
        changes.kinetic_energy =
          Utilities::MPI::sum(changes.kinetic_energy, grid.communicator);
        changes.internal_energy =
          Utilities::MPI::sum(changes.internal_energy, grid.communicator);
        std::vector<typename Particles::ParticleHandler<dim>::particle_iterator>
          leaving;
        for (unsigned int p = 0; p < points.size(); ++p)
          if (gone[p])
            leaving.push_back(particles[p]);
        points.sorted.particles.remove_particles(leaving);
        points.sort();
        return changes;
      }

    private:
      static constexpr unsigned int no_point = numbers::invalid_unsigned_int;

      /** Of what two points have in a field of the history; of one point, from
       * what it had at the start. */
      double
      distance(const PointLayout::Field &field,
               const unsigned int        p,
               const unsigned int        q) const
      {
        double sum = 0;
        for (unsigned int i = 0; i < field.n_components; ++i)
          {
            const unsigned int k     = points.offset_history + field.offset + i;
            const double       other = q == no_point ?
                                         fresh[points.body(p)][field.offset + i] :
                                         points.fields(q)[k];
            const double       difference = points.fields(p)[k] - other;
            sum += difference * difference;
          }
        return std::sqrt(sum);
      }

      bool
      have_same_state(const unsigned int p,
                      const unsigned int q,
                      const double       tolerance) const
      {
        const auto F = deformation_gradient(points, p),
                   G = deformation_gradient(points, q);
        if ((points.material(p).depends_on_shape() ?
               (F - G).norm() :
               std::abs(determinant(F) - determinant(G))) > tolerance)
          return false;
        if (points.offset_touched > 0 &&
            points.fields(p)[points.offset_touched] !=
              points.fields(q)[points.offset_touched])
          return false;
        for (unsigned int i = 0; i < scales.size(); ++i)
          if (distance(points.history_layout.fields()[i], p, q) >
              tolerance * scales[i])
            return false;
        return true;
      }

      PointShape<dim>
      shape(const unsigned int p) const
      {
        PointShape<dim> shape;
        shape.volume      = points.initial_volume(p);
        shape.place       = place(p);
        shape.domain      = points.vector(p, fields.domain);
        shape.deformation = deformation_gradient(points, p);
        shape.present_measure =
          present_measure(points, p, particles[p]->get_location());
        return shape;
      }

      /** Which part of its cell a point lies in: there is one for each point
       * that is wished. */
      std::array<int, dim>
      part_of_cell(const MergeRoom<dim> &room, const unsigned int p) const
      {
        const auto x = particles[p]->get_location() -
                       particles[p]->get_surrounding_cell()->vertex(0);
        std::array<int, dim> part;
        for (unsigned int d = 0; d < dim; ++d)
          part[d] = std::floor(x[d] / room.cell[d] *
                               std::max(1., std::round(room.points_across)));
        return part;
      }

      /**
       * The shape of one point for two, if there is one. Where shapes count
       * there is a pass for each axis of the start. Else points of one part of
       * a cell merge first, wherever they lie there, then neighbours.
       */
      std::optional<PointShape<dim>>
      merged_shape(const BodySpec<dim>  &body,
                   const MergeRoom<dim> &room,
                   const unsigned int    pass,
                   const unsigned int    p,
                   const unsigned int    q) const
      {
        std::optional<PointShape<dim>> result;
        if (body.material->depends_on_shape())
          result = merge_along(pass, shape(p), shape(q), room);
        else
          {
            const bool same_part =
              part_of_cell(room, p) == part_of_cell(room, q);
            if (pass > 0 || same_part)
              result = merge_to_box(shape(p), shape(q), room, !same_part);
          }
        if (result && !have_same_state(p, q, body.merge_tolerance))
          result.reset();
        return result;
      }

      Tensor<1, 3>
      velocity(const unsigned int p) const
      {
        return in_space(points.velocity(p));
      }

      static Tensor<1, 3>
      in_space(const Tensor<1, dim> &vector)
      {
        Tensor<1, 3> result;
        for (unsigned int d = 0; d < dim; ++d)
          result[d] = vector[d];
        return result;
      }

      /** Adds the energies of some points, times a factor, to the changes. */
      void
      count_energies(const std::vector<unsigned int> &some, const double factor)
      {
        for (const auto p : some)
          if (!gone[p])
            {
              const auto energy = points.material(p).energy_of_point(
                deformation_gradient(points, p),
                points.fields(p) + points.offset_history);
              changes.internal_energy += factor * points.initial_volume(p) *
                                         (energy.stored + energy.dissipated);
              changes.kinetic_energy +=
                0.5 * factor * points.mass(p) *
                square_of_velocity(points, points.fields(p));
            }
      }

      /** Mass, centre and tensor of inertia about it. */
      void
      find_inertia(const std::vector<unsigned int> &some,
                   Tensor<1, 3>                    &centre,
                   Tensor<2, 3>                    &inertia) const
      {
        double mass = 0;
        centre      = Tensor<1, 3>();
        for (const auto p : some)
          if (!gone[p])
            {
              mass += points.mass(p);
              centre += points.mass(p) * in_space(place(p));
            }
        centre /= mass;
        inertia = Tensor<2, 3>();
        for (const auto p : some)
          if (!gone[p])
            {
              const auto arm = in_space(place(p)) - centre;
              inertia +=
                points.mass(p) *
                (arm.norm_square() * Tensor<2, 3>(unit_symmetric_tensor<3>()) -
                 outer_product(arm, arm));
            }
      }

      Tensor<1, dim>
      place(const unsigned int p) const
      {
        return particles[p]->get_location() - Point<dim>();
      }

      /** Points of a body in a cell. */
      void
      merge(const BodySpec<dim>      &body,
            const MergeRoom<dim>     &room,
            std::vector<unsigned int> some)
      {
        // Fewer could not take over the angular momentum.
        if (some.size() < dim + 2)
          return;
        const bool spins = points.offset_velocity > 0 &&
                           points.layout.geometry != GeometryKind::axisymmetric;
        Tensor<1, 3> centre, spin;
        Tensor<2, 3> inertia;
        if (spins)
          {
            find_inertia(some, centre, inertia);
            if (determinant(inertia) < 1e-6 * std::pow(trace(inertia), 3))
              return;
          }
        unsigned int       n   = some.size();
        bool               any = false;
        const unsigned int n_passes =
          body.material->depends_on_shape() ? dim : 2;
        for (unsigned int pass = 0; pass < n_passes; ++pass)
          {
            // Whatever the order in which the points stand in their cell.
            std::sort(some.begin(), some.end(), [&](auto p, auto q) {
              const auto x = place(p), y = place(q);
              for (unsigned int d = 0; d < dim; ++d)
                if (const auto a = (pass + d) % dim; x[a] != y[a])
                  return x[a] < y[a];
              return particles[p]->get_id() < particles[q]->get_id();
            });
            for (unsigned int i = 0; i < some.size(); ++i)
              for (unsigned int j = i + 1; j < some.size(); ++j)
                if (n > dim + 1 && !gone[some[i]] && !gone[some[j]])
                  if (const auto shape =
                        merged_shape(body, room, pass, some[i], some[j]))
                    {
                      if (!any)
                        count_energies(some, -1);
                      any = true;
                      spin += join(*shape, some[i], some[j]);
                      --n;
                    }
          }
        if (!any)
          return;
        if (spins)
          {
            find_inertia(some, centre, inertia);
            const auto rotation = invert(inertia) * spin;
            for (const auto p : some)
              if (!gone[p])
                {
                  const auto change =
                    cross_product_3d(rotation, in_space(place(p)) - centre);
                  for (unsigned int d = 0; d < dim; ++d)
                    points.fields(p)[points.offset_velocity + d] += change[d];
                }
          }
        count_energies(some, 1);
      }

      /** Makes one of two points, of a shape; returns the angular momentum of
       * their relative motion. */
      Tensor<1, 3>
      join(const PointShape<dim> &shape, unsigned int p, unsigned int q)
      {
        if (particles[p]->get_id() > particles[q]->get_id())
          std::swap(p, q);
        gone[q] = 1;
        ++changes.merges;
        double       *to   = points.fields(p);
        const double *from = points.fields(q);
        const double  part = points.initial_volume(q) / shape.volume;
        Tensor<1, 3>  spin;
        if (points.offset_velocity > 0)
          spin = points.mass(p) * part *
                 cross_product_3d(in_space(place(q) - place(p)),
                                  velocity(q) - velocity(p));
        particles[p]->set_location(Point<dim>(shape.place));
        for (const auto i : fields.common)
          to[i] += part * (from[i] - to[i]);
        for (const auto i : fields.shared)
          to[i] += from[i];
        points.set_vector(p, fields.domain, shape.domain);
        points.layout.store_tensor(shape.deformation,
                                   to + points.offset_deformation);
        return spin;
      }

      const Bodies<dim>         &bodies;
      const BackgroundGrid<dim> &grid;
      const PointDomains<dim>    fields;
      MaterialPoints<dim>       &points;
      std::vector<char>          gone;
      /** By body, the history of an undeformed point. */
      std::vector<std::vector<double>> fresh;
      std::vector<double>              scales; ///< of the fields of the history
      std::vector<typename Particles::ParticleHandler<dim>::particle_iterator>
                   particles;
      PointChanges changes;
    };
  } // namespace

  template <int dim>
  PointChanges
  merge_points(const Bodies<dim>         &bodies,
               const BackgroundGrid<dim> &grid,
               MaterialPoints<dim>       &points)
  {
    return Merger<dim>(bodies, grid, points).run();
  }

  template PointChanges
  merge_points(const Bodies<2> &,
               const BackgroundGrid<2> &,
               MaterialPoints<2> &);
  template PointChanges
  merge_points(const Bodies<3> &,
               const BackgroundGrid<3> &,
               MaterialPoints<3> &);
} // namespace impm
