#include <impm/grid/rigid_bodies.h>
#include <impm/scene/seeding.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** How far a place is outside of a box, across the side that is furthest
     * from it (m). */
    template <int dim>
    double
    gap(const BoundingBox<dim> &box, const Point<dim> &place)
    {
      double largest = -std::numeric_limits<double>::max();
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max({largest,
                            box.lower_bound(d) - place[d],
                            place[d] - box.upper_bound(d)});
      return largest;
    }
  } // namespace

  template <int dim>
  RigidBodies<dim>::RigidBodies(const Bodies<dim>         &specs,
                                const GeometryKind         geometry,
                                const BackgroundGrid<dim> &grid)
    : grid(grid)
    , tolerance(1e-4 * grid.discretization()->smallest_cell_extent)
  {
    for (const auto &spec : specs)
      if (spec.rigid)
        {
          auto points = std::make_unique<SortedParticles<dim>>(grid, 0);
          BoundingBox<dim> box;
          if (grid.is_lagrangian)
            box = *spec.shape->bounding_box;
          else if (!spec.meets_surfaces)
            points->insert(seed_body(specs, spec, geometry, grid));
          points->sort();
          double radius = 0;
          for (const auto &particle : points->particles)
            radius =
              std::max(radius, particle.get_location().distance(spec.centre));
          bodies.push_back({&spec,
                            std::move(points),
                            box,
                            Utilities::MPI::max(radius, grid.communicator),
                            {}});
          auto &state              = bodies.back().state;
          state.since_start.centre = spec.centre;
          state.velocity           = spec.free_velocity;
          state.spin               = spec.free_spin;
        }
    if (grid.is_lagrangian)
      holders_of_nodes.resize(grid.discretization()->node_positions.size());
    stick(0);
  }

  template <int dim>
  double
  RigidBodies<dim>::Body::angle(const double time) const
  {
    return spec->rotation ? spec->rotation->value(Point<1>(time)) : 0.;
  }

  template <int dim>
  RigidMotion<dim>
  RigidBodies<dim>::Body::motion(const double from, const double to) const
  {
    Tensor<1, dim> shift;
    Point<dim>     centre = spec->centre;
    if (const auto &function = spec->displacement)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double start = function->value(Point<1>(from), d);
          shift[d]           = function->value(Point<1>(to), d) - start;
          centre[d] += start;
        }
    return {centre, shift, (angle(to) - angle(from)) * spec->axis};
  }

  template <int dim>
  RigidMotion<dim>
  RigidBodies<dim>::Body::since_start(const double time) const
  {
    return spec->is_free ? state.since_start : motion(0, time);
  }

  template <int dim>
  RigidMotion<dim>
  RigidBodies<dim>::Body::in_step(const double time, const double dt) const
  {
    if (!spec->is_free)
      return motion(time, time + dt);
    const auto &now = state.since_start;
    return {now.centre + now.shift,
            dt * state.velocity,
            dt * state.angular_velocity()};
  }

  template <int dim>
  double
  RigidBodies<dim>::largest_speed() const
  {
    double largest = 0;
    for (const auto &body : bodies)
      if (body.spec->is_free)
        largest = std::max(largest, body.state.velocity.norm());
    return largest;
  }

  template <int dim>
  void
  RigidBodies<dim>::move(const double from, const double to)
  {
    stick(to);
    for (const auto &body : bodies)
      {
        const auto motion = body.motion(from, to);
        for (auto &particle : body.points->particles)
          particle.set_location(motion(particle.get_location()));
        body.points->sort();
      }
  }

  template <int dim>
  void
  RigidBodies<dim>::sort()
  {
    for (const auto &body : bodies)
      body.points->sort();
  }

  template <int dim>
  double
  RigidBodies<dim>::largest_displacement(const double from,
                                         const double to) const
  {
    double largest = 0;
    for (const auto &body : bodies)
      {
        const double turn  = std::abs(body.angle(to) - body.angle(from));
        const auto   way   = std::min(turn, 2.) * body.radius;
        const auto   shift = body.motion(from, to).shift;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, std::abs(shift[d]) + way);
      }
    return largest;
  }

  template <int dim>
  void
  RigidBodies<dim>::stick(const double time)
  {
    const auto discretization = grid.discretization();
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto shift = bodies[b].motion(0, time).shift;
        for (unsigned int n = 0; n < holders_of_nodes.size(); ++n)
          if (holders_of_nodes[n] == 0 &&
              gap(bodies[b].box, discretization->node_positions[n] - shift) <=
                tolerance)
            holders_of_nodes[n] = b + 1;
      }
  }

  template <int dim>
  double
  RigidBodies<dim>::first_touch(const Vector            &u,
                                const std::vector<char> &constrained,
                                const double             from,
                                const double             to) const
  {
    if (!grid.is_lagrangian || bodies.empty())
      return 1;
    const auto discretization = grid.discretization();
    double     part           = 1;
    for (const auto &body : bodies)
      {
        const auto start = body.motion(0, from).shift,
                   end   = body.motion(0, to).shift;
        for (unsigned int n = 0; n < holders_of_nodes.size(); ++n)
          {
            const auto first = constrained.begin() + dim * n;
            if (holders_of_nodes[n] > 0 ||
                std::find(first, first + dim, 0) == first + dim)
              continue;
            Point<dim>   place  = discretization->node_positions[n];
            const double before = gap(body.box, place - start);
            for (unsigned int d = 0; d < dim; ++d)
              place[d] += u.local_element(dim * n + d);
            const double after = gap(body.box, place - end);
            if (after < -tolerance)
              part = std::min(part, before / (before - after));
          }
      }
    return Utilities::MPI::min(part, grid.communicator);
  }

  template class RigidBodies<2>;
  template class RigidBodies<3>;
} // namespace impm
