#include <impm/grid/rigid_bodies.h>
#include <impm/scene/seeding.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  RigidBodies<dim>::RigidBodies(const Bodies<dim>         &specs,
                                const GeometryKind         geometry,
                                const BackgroundGrid<dim> &grid)
  {
    std::vector<BoundingBox<dim>> boxes;
    for (const auto &spec : specs)
      if (spec.rigid)
        {
          auto points = std::make_unique<SortedParticles<dim>>(grid, 0);
          if (grid.is_lagrangian)
            boxes.push_back(*spec.shape->bounding_box);
          else
            points->insert(seed_body(specs, spec, geometry, grid));
          points->sort();
          bodies.push_back({&spec, std::move(points)});
        }
    if (!boxes.empty())
      {
        contact.emplace(grid, boxes);
        contact->stick(displacements(0));
      }
  }

  template <int dim>
  Tensor<1, dim>
  RigidBodies<dim>::displacement(const unsigned int body,
                                 const double       from,
                                 const double       to) const
  {
    Tensor<1, dim> displacement;
    if (const auto &function = bodies[body].spec->displacement)
      for (unsigned int d = 0; d < dim; ++d)
        displacement[d] =
          function->value(Point<1>(to), d) - function->value(Point<1>(from), d);
    return displacement;
  }

  template <int dim>
  void
  RigidBodies<dim>::move(const double from, const double to)
  {
    if (contact)
      contact->stick(displacements(to));
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto shift = displacement(b, from, to);
        for (auto &particle : bodies[b].points->particles)
          particle.set_location(particle.get_location() + shift);
      }
    sort();
  }

  template <int dim>
  typename NodeContact<dim>::Shifts
  RigidBodies<dim>::displacements(const double time) const
  {
    typename NodeContact<dim>::Shifts shifts;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      shifts.push_back(displacement(b, 0, time));
    return shifts;
  }

  template <int dim>
  double
  RigidBodies<dim>::first_touch(const Vector            &u,
                                const std::vector<char> &constrained,
                                const double             from,
                                const double             to) const
  {
    return contact ? contact->first_touch(u,
                                          constrained,
                                          displacements(from),
                                          displacements(to)) :
                     1.;
  }

  template <int dim>
  void
  RigidBodies<dim>::sort()
  {
    for (auto &body : bodies)
      body.points->sort();
  }

  template <int dim>
  void
  RigidBodies<dim>::prepare_for_adaptation()
  {
    for (auto &body : bodies)
      body.points->particles.prepare_for_coarsening_and_refinement();
  }

  template <int dim>
  void
  RigidBodies<dim>::unpack_after_adaptation()
  {
    for (auto &body : bodies)
      body.points->particles.unpack_after_coarsening_and_refinement();
  }

  template class RigidBodies<2>;
  template class RigidBodies<3>;
} // namespace impm
