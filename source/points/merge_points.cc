#include <deal.II/base/mpi.h>

#include <impm/points/adapt_points.h>
#include <impm/points/point_domains.h>

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
        // History is compared with the largest that any point has.
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
                  merge(bodies[b], extents_of<dim>(cell), some);
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

      /** Of what two points have in a field of the history, or its size. */
      double
      distance(const PointLayout::Field &field,
               const unsigned int        p,
               const unsigned int        q) const
      {
        double sum = 0;
        for (unsigned int i = 0; i < field.n_components; ++i)
          {
            const unsigned int k = points.offset_history + field.offset + i;
            const double       difference =
              points.fields(p)[k] - (q == no_point ? 0 : points.fields(q)[k]);
            sum += difference * difference;
          }
        return std::sqrt(sum);
      }

      bool
      have_same_state(const unsigned int p,
                      const unsigned int q,
                      const double       tolerance) const
      {
        if ((deformation_gradient(points, p) - deformation_gradient(points, q))
              .norm() > tolerance)
          return false;
        for (unsigned int i = 0; i < scales.size(); ++i)
          if (distance(points.history_layout.fields()[i], p, q) >
              tolerance * scales[i])
            return false;
        return true;
      }

      /** Whether two points make one box. */
      bool
      fit(const BodySpec<dim>  &body,
          const Tensor<1, dim> &cell,
          const unsigned int    axis,
          const unsigned int    p,
          const unsigned int    q) const
      {
        const double *first = points.fields(p), *second = points.fields(q);
        const auto    edge =
          0.5 * (fields.edge(first, axis) + fields.edge(second, axis));
        // Well below the length at which points are split.
        if (span<dim>(2 * edge, cell) > 0.8 / body.points_across)
          return false;
        auto gap = particles[q]->get_location() - particles[p]->get_location();
        gap -= (gap * edge < 0 ? -1 : 1) * edge;
        for (unsigned int d = 0; d < dim; ++d)
          {
            double extent = 0;
            for (unsigned int a = 0; a < dim; ++a)
              extent = std::max(extent, std::abs(fields.edge(first, a)[d]));
            if (std::abs(gap[d]) > 0.25 * extent)
              return false;
            if (d != axis &&
                std::abs(first[fields.domain + d] - second[fields.domain + d]) >
                  0.1 * first[fields.domain + d])
              return false;
          }
        return have_same_state(p, q, body.merge_tolerance);
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
              const auto energy =
                points.material(p).energy(deformation_gradient(points, p),
                                          points.fields(p) +
                                            points.offset_history);
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
            const Tensor<1, dim>     &cell,
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
        unsigned int n   = some.size();
        bool         any = false;
        for (unsigned int axis = 0; axis < dim; ++axis)
          {
            // Whatever the order in which the points stand in their cell.
            std::sort(some.begin(), some.end(), [&](auto p, auto q) {
              const auto x = place(p), y = place(q);
              for (unsigned int d = 0; d < dim; ++d)
                if (const auto a = (axis + d) % dim; x[a] != y[a])
                  return x[a] < y[a];
              return particles[p]->get_id() < particles[q]->get_id();
            });
            for (unsigned int i = 0; i < some.size(); ++i)
              for (unsigned int j = i + 1; j < some.size(); ++j)
                if (n > dim + 1 && !gone[some[i]] && !gone[some[j]] &&
                    fit(body, cell, axis, some[i], some[j]))
                  {
                    if (!any)
                      count_energies(some, -1);
                    any = true;
                    spin += join(axis, some[i], some[j]);
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

      /** Makes one of two points; returns the angular momentum of their
       * relative motion. */
      Tensor<1, 3>
      join(const unsigned int axis, unsigned int p, unsigned int q)
      {
        if (particles[p]->get_id() > particles[q]->get_id())
          std::swap(p, q);
        gone[q] = 1;
        ++changes.merges;
        double       *to   = points.fields(p);
        const double *from = points.fields(q);
        const double  whole =
          points.initial_volume(p) + points.initial_volume(q);
        const double part = points.initial_volume(q) / whole;
        Tensor<1, 3> spin;
        if (points.offset_velocity > 0)
          spin = points.mass(p) * part *
                 cross_product_3d(in_space(place(q) - place(p)),
                                  velocity(q) - velocity(p));
        const auto volume = [&](const unsigned int r) {
          return points.initial_volume(r) *
                 determinant(deformation_gradient(points, r));
        };
        const double present = volume(p) + volume(q);
        particles[p]->set_location(particles[p]->get_location() +
                                   part * (place(q) - place(p)));
        for (const auto i : fields.common)
          to[i] += part * (from[i] - to[i]);
        for (const auto i : fields.shared)
          to[i] += from[i];
        for (unsigned int d = 0; d < dim; ++d)
          {
            double &extent = to[fields.domain + d];
            extent += d == axis ? from[fields.domain + d] :
                                  part * (from[fields.domain + d] - extent);
          }
        // The mean of F has less volume.
        auto         F     = deformation_gradient(points, p);
        const double scale = std::pow(present / volume(p), 1. / dim);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            F[i][j] *= scale;
        points.layout.store_tensor(F, to + points.offset_deformation);
        return spin;
      }

      const Bodies<dim>         &bodies;
      const BackgroundGrid<dim> &grid;
      const PointDomains<dim>    fields;
      MaterialPoints<dim>       &points;
      std::vector<char>          gone;
      std::vector<double>        scales; ///< of the fields of the history
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
