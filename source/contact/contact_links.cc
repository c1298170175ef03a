#include <impm/contact/contact_links.h>
#include <impm/contact/faced_surface.h>
#include <impm/grid/step_constraints.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** As seen from outside of a body that has turned. */
    template <int dim>
    Proximity<dim>
    turn(const RigidMotion<dim> &motion, Proximity<dim> proximity)
    {
      if (!motion.turns())
        return proximity;
      const auto R     = motion.rotation();
      proximity.normal = R * proximity.normal;
      proximity.curvature =
        symmetrize(R * Tensor<2, dim>(proximity.curvature) * transpose(R));
      return proximity;
    }

    template <int dim>
    Obstacle<dim>
    make_obstacle(const ContactPair         &pair,
                  const Scene<dim>          &scene,
                  const BackgroundGrid<dim> &grid,
                  const RigidBodies<dim>    &rigid,
                  const double               time,
                  const double               dt)
    {
      Obstacle<dim> obstacle;
      unsigned int  n_free = 0;
      if (pair.partner_kind == PartnerKind::rigid)
        for (const auto &body : rigid.bodies)
          {
            if (body.spec == &scene.bodies[pair.partner])
              {
                obstacle.motion = body.in_step(time, dt);
                obstacle.proximity =
                  [before = body.since_start(time),
                   &shape = *body.spec->shape](const Point<dim> &x) {
                    return turn(before, shape.proximity(before.inverse(x)));
                  };
                if (body.spec->is_free)
                  obstacle.free_body = n_free;
              }
            n_free += body.spec->is_free;
          }
      if (pair.partner_kind == PartnerKind::face)
        {
          const unsigned int face = pair.partner, d = face / 2;
          const double       side = face % 2 == 0 ? 1 : -1;
          if (const auto &spec = scene.faces[face]; spec.value)
            {
              obstacle.motion.shift[d] =
                face_motion(spec, grid, face, time, time + dt);
              // Along itself, too, it takes surfaces with it by friction.
              Point<dim> place;
              place[d]      = grid.face_position(face);
              const auto at = [&](const double instant, const unsigned int c) {
                spec.value->set_time(instant);
                return spec.value->value(place, c);
              };
              for (unsigned int c = 0; c < spec.value->n_components; ++c)
                if (spec.value->n_components == dim && c != d)
                  obstacle.motion.shift[c] = spec.is_velocity ?
                                               at(time + dt / 2, c) * dt :
                                               at(time + dt, c) - at(time, c);
            }
          obstacle.proximity = [d, side, position = grid.face_position(face)](
                                 const Point<dim> &x) {
            Proximity<dim> result{side * (x[d] - position), {}, {}};
            result.normal[d] = side;
            return result;
          };
        }
      return obstacle;
    }

    /** Of this rank, then of others where their cells touch those of this one.
     */
    template <int dim>
    std::vector<SurfacePatch<dim>>
    patches_of(const SurfacePoints<dim> &points)
    {
      std::vector<SurfacePatch<dim>> patches;
      if (!points.sees_others)
        return patches;
      const auto add = [&](const auto &particle) {
        const double *fields = particle.get_properties().data();
        const auto    x      = points.place(particle);
        const auto    area =
          points.normal_of(points.edges_in(fields + points.offset_edges));
        patches.push_back({x,
                           area / area.norm(),
                           std::pow(area.norm(), 1. / (dim - 1)),
                           static_cast<unsigned int>(fields[0])});
      };
      for (const auto &particle : points.sorted.particles)
        add(particle);
      for (auto particle = points.sorted.particles.begin_ghost();
           particle != points.sorted.particles.end_ghost();
           ++particle)
        add(*particle);
      return patches;
    }

    double
    modulus(const Material &material)
    {
      return material.density * material.wave_speed() * material.wave_speed();
    }
  } // namespace

  template <int dim>
  void
  ContactLinks<dim>::append(const Footprints<dim> &of_places,
                            const unsigned int     place,
                            const double           factor)
  {
    for (unsigned int k = of_places.first[place];
         k < of_places.first[place + 1];
         ++k)
      {
        const unsigned int e      = of_places.entries[k];
        const double      *values = of_places.value(e);
        for (unsigned int v = 0; v < Footprints<dim>::n_nodes; ++v)
          {
            nodes.push_back(of_places.nodes_of_entry(e)[v]);
            coefficients.push_back(factor * values[v]);
          }
      }
  }

  template <int dim>
  ContactLinks<dim>::ContactLinks(const Scene<dim>          &scene,
                                  const BackgroundGrid<dim> &grid,
                                  const SurfacePoints<dim>  &points,
                                  const Footprints<dim>     &prints,
                                  const RigidBodies<dim>    &rigid,
                                  const PopulatedCells<dim> &populated,
                                  const Discretization<dim> &discretization,
                                  FootprintBuilder<dim>     &builder,
                                  const double               time,
                                  const double               dt)
  {
    const auto &pairs = scene.contact.pairs;
    for (const auto &pair : pairs)
      obstacles.push_back(make_obstacle(pair, scene, grid, rigid, time, dt));
    const FacedSurface<dim> faced(patches_of(points));

    using Place = typename FootprintBuilder<dim>::Place;
    std::vector<Place> others;
    unsigned int       s = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const unsigned int body   = points.body(s);
        const auto         x      = points.place(particle);
        const auto         cell   = particle.get_surrounding_cell();
        double             extent = cell_extent(cell, 0);
        for (unsigned int d = 1; d < dim; ++d)
          extent = std::min(extent, cell_extent(cell, d));
        for (unsigned int q = 0; q < pairs.size(); ++q)
          {
            const auto &pair = pairs[q];
            const bool  is_deformable =
              pair.partner_kind == PartnerKind::deformable;
            const bool is_bond = pair.kind == ContactKind::bonded;
            // Two surfaces look at each other, for half of the area each.
            const bool is_second =
              is_deformable && !is_bond && pair.partner == body;
            const bool met = points.pair(s) == static_cast<int>(q);
            if ((pair.body != body && !is_second) || (is_bond && !met))
              continue;
            const unsigned int partner = is_second ? pair.body : pair.partner;
            const auto         area    = points.area(s);
            Place              other{particle.get_location(), cell, {}};
            ContactLink<dim>   link;
            link.point     = s;
            link.pair      = q;
            link.area      = area.norm();
            link.place     = x;
            link.is_bond   = is_bond;
            link.friction  = pair.friction;
            link.obstacle  = nullptr;
            link.thickness = scene.contact.thickness * extent;
            double softest = modulus(*scene.bodies[body].material);
            if (is_deformable)
              {
                softest =
                  std::min(softest, modulus(*scene.bodies[partner].material));
                other.layer = scene.bodies[partner].layer;
              }
            if (is_bond)
              {
                link.normal = -area / link.area;
                link.gap    = 0;
              }
            else if (is_deformable)
              {
                const auto facing =
                  faced.find(x, area / link.area, partner, extent);
                if (!facing)
                  continue;
                link.gap       = facing->gap;
                link.normal    = facing->normal;
                other.position = x - facing->gap * facing->normal;
                link.area /= 2;
              }
            else
              {
                link.obstacle        = &obstacles[q];
                const auto proximity = link.obstacle->proximity(x);
                if (std::abs(proximity.distance) >
                      extent + link.obstacle->motion.increment_to(x).norm() ||
                    proximity.normal * area > 0)
                  continue;
                link.gap    = proximity.distance;
                link.normal = proximity.normal;
              }
            link.stiffness = softest / link.thickness;
            if (met)
              {
                link.slip           = points.slip(s);
                link.friction_bound = pair.friction * points.pressure(s);
              }
            links.push_back(link);
            others.push_back(other);
          }
        ++s;
      }
    const auto of_others = builder.build_at(others, populated, discretization);
    for (unsigned int l = 0; l < links.size(); ++l)
      {
        links[l].begin = nodes.size();
        append(prints, links[l].point, 1);
        append(of_others, l, -1);
        links[l].end = nodes.size();
      }
  }

  template class ContactLinks<2>;
  template class ContactLinks<3>;
} // namespace impm
