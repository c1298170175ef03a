#include <impm/rigid_bodies.h>
#include <impm/seeding.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  RigidBodies<dim>::RigidBodies(const Scene<dim>          &scene,
                                const BackgroundGrid<dim> &grid)
  {
    for (const auto &spec : scene.bodies)
      if (spec.rigid)
        {
          auto points = std::make_unique<SortedParticles<dim>>(grid, 0);
          points->insert(seed_body(scene, spec, grid));
          points->sort();
          bodies.push_back({&spec, std::move(points)});
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
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto shift = displacement(b, from, to);
        for (auto &particle : bodies[b].points->particles)
          particle.set_location(particle.get_location() + shift);
      }
    sort();
  }

  template <int dim>
  void
  RigidBodies<dim>::sort()
  {
    for (auto &body : bodies)
      body.points->sort();
  }

  template class RigidBodies<2>;
  template class RigidBodies<3>;
} // namespace impm
