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
      if (pair.partner_kind == PartnerKind::rigid)
        for (const auto &body : rigid.bodies)
          if (body.spec == &scene.bodies[pair.partner])
            {
              const auto shift      = body.displacement(0, time);
              obstacle.displacement = body.displacement(time, time + dt);
              obstacle.proximity =
                [shift, &shape = *body.spec->shape](const Point<dim> &x) {
                  return shape.proximity(x - shift);
                };
            }
      if (pair.partner_kind == PartnerKind::face)
        {
          const unsigned int face = pair.partner, d = face / 2;
          const double       side = face % 2 == 0 ? 1 : -1;
          if (scene.faces[face].value)
            obstacle.displacement[d] =
              face_motion(scene.faces[face], grid, face, time, time + dt);
          obstacle.proximity = [d, side, position = grid.face_position(face)](
                                 const Point<dim> &x) {
            Proximity<dim> result{side * (x[d] - position), {}, {}};
            result.normal[d] = side;
            return result;
          };
        }
      return obstacle;
    }

    double
    modulus(const Material &material)
    {
      return material.density * material.wave_speed() * material.wave_speed();
    }
  } // namespace

  template <int dim>
  std::vector<typename ContactLinks<dim>::Touched>
  ContactLinks<dim>::touched_by(const Footprints<dim> &prints)
  {
    std::vector<Touched> result(prints.first.size() - 1);
    for (const auto &cell : prints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        result[prints.point[e]] = {cell.nodes, prints.value(e), cell.extent};
    return result;
  }

  template <int dim>
  void
  ContactLinks<dim>::append(const Touched &touched, const double factor)
  {
    for (unsigned int v = 0; v < touched.nodes.size(); ++v)
      {
        nodes.push_back(touched.nodes[v]);
        coefficients.push_back(factor * touched.values[v]);
      }
  }

  template <int dim>
  void
  ContactLinks<dim>::join(const unsigned int begin)
  {
    unsigned int end = begin;
    for (unsigned int k = begin; k < nodes.size(); ++k)
      {
        const auto found =
          std::find(nodes.begin() + begin, nodes.begin() + end, nodes[k]) -
          nodes.begin();
        if (found == end)
          {
            nodes[end]        = nodes[k];
            coefficients[end] = coefficients[k];
            ++end;
          }
        else
          coefficients[found] += coefficients[k];
      }
    nodes.resize(end);
    coefficients.resize(end);
  }

  template <int dim>
  ContactLinks<dim>::ContactLinks(const Scene<dim>          &scene,
                                  const BackgroundGrid<dim> &grid,
                                  const SurfacePoints<dim>  &points,
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

    // Of this rank, then of others where their cells touch those of this one.
    using Place = typename FootprintBuilder<dim>::Place;
    std::vector<Place>             own, other;
    std::vector<SurfacePatch<dim>> patches;
    const auto                     add =
      [&](const auto &particle, const double *fields, const unsigned int body) {
        own.push_back({particle.get_location(),
                       particle.get_surrounding_cell(),
                       scene.bodies[body].layer});
        Tensor<1, dim> area;
        std::copy_n(fields + points.offset_area, dim, area.begin_raw());
        const double size =
          points.geometry == GeometryKind::axisymmetric ?
            area.norm() / (2 * numbers::PI * particle.get_location()[0]) :
            area.norm();
        patches.push_back({particle.get_location(),
                           area / area.norm(),
                           std::pow(size, 1. / (dim - 1)),
                           body});
      };
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        add(particle, points.fields(p), points.body(p));
        other.push_back(own.back());
        other.back().layer.reset();
        if (const int q = points.pair(p);
            q >= 0 && pairs[q].kind == ContactKind::bonded)
          other.back().layer = scene.bodies[pairs[q].partner].layer;
        ++p;
      }
    const unsigned int n_own = own.size();
    if (std::any_of(pairs.begin(), pairs.end(), [](const auto &pair) {
          return pair.partner_kind == PartnerKind::deformable &&
                 pair.kind != ContactKind::bonded;
        }))
      for (auto particle = points.sorted.particles.begin_ghost();
           particle != points.sorted.particles.end_ghost();
           ++particle)
        add(*particle,
            particle->get_properties().data(),
            static_cast<unsigned int>(particle->get_properties()[0]));
    const auto all   = builder.build_at(own, populated, discretization);
    const auto bonds = builder.build_at(other, populated, discretization);
    own.resize(n_own);
    prints = builder.build_at(own, populated, discretization);
    const auto              here = touched_by(all), there = touched_by(bonds);
    const FacedSurface<dim> faced(patches);

    unsigned int s = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const Point<dim> x    = particle.get_location();
        const auto       area = points.area(s);
        for (unsigned int q = 0; q < pairs.size(); ++q)
          {
            const auto        &pair = pairs[q];
            const unsigned int body = points.body(s);
            const bool         is_second =
              pair.partner_kind == PartnerKind::deformable &&
              pair.kind != ContactKind::bonded && pair.partner == body;
            if (pair.body != body && !is_second)
              continue;
            ContactLink<dim> link;
            link.point           = s;
            link.pair            = q;
            link.area            = area.norm();
            link.place           = x;
            link.is_bond         = pair.kind == ContactKind::bonded;
            link.friction        = pair.friction;
            link.obstacle        = nullptr;
            const double extent  = here[s].extent;
            double       softest = modulus(*scene.bodies[body].material);
            link.thickness       = scene.contact.thickness * extent;
            std::optional<typename FacedSurface<dim>::Facing> facing;
            if (pair.partner_kind == PartnerKind::deformable)
              softest =
                std::min(softest,
                         modulus(
                           *scene.bodies[is_second ? pair.body : pair.partner]
                              .material));
            if (link.is_bond)
              {
                if (points.pair(s) != static_cast<int>(q))
                  continue;
                link.normal = -area / link.area;
                link.gap    = 0;
              }
            else if (pair.partner_kind == PartnerKind::deformable)
              {
                const double reach = link.thickness + extent;
                facing             = faced.find(x,
                                    area / link.area,
                                    is_second ? pair.body : pair.partner,
                                    reach);
                if (!facing || std::abs(facing->gap) > reach)
                  continue;
                link.gap    = facing->gap;
                link.normal = facing->normal;
                link.area /= 2; // as both surfaces look at each other
              }
            else
              {
                link.obstacle        = &obstacles[q];
                const auto proximity = link.obstacle->proximity(x);
                if (std::abs(proximity.distance) >
                      link.thickness + extent +
                        link.obstacle->displacement.norm() ||
                    proximity.normal * area > 0)
                  continue;
                link.gap    = proximity.distance;
                link.normal = proximity.normal;
              }
            link.stiffness = softest / link.thickness;
            if (points.pair(s) == static_cast<int>(q))
              {
                link.slip           = points.slip(s);
                link.friction_bound = pair.friction * points.pressure(s);
              }
            link.begin = nodes.size();
            append(here[s], 1);
            if (link.is_bond)
              append(there[s], -1);
            if (facing)
              for (const auto &[patch, weight] : facing->weights)
                append(here[patch], -weight);
            join(link.begin);
            link.end = nodes.size();
            links.push_back(link);
          }
        ++s;
      }
  }

  template class ContactLinks<2>;
  template class ContactLinks<3>;
} // namespace impm
