#include <impm/contact/surface_points.h>
#include <impm/scene/surface_of_shape.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Deformable bodies whose surface some pair follows. */
    template <int dim>
    std::vector<unsigned int>
    bodies_with_surface(const ContactSpec &contact, const Bodies<dim> &bodies)
    {
      std::vector<unsigned int> result;
      for (unsigned int b = 0; b < bodies.size(); ++b)
        if (std::any_of(contact.pairs.begin(),
                        contact.pairs.end(),
                        [&](const auto &pair) {
                          return pair.body == b ||
                                 (pair.partner_kind ==
                                    PartnerKind::deformable &&
                                  pair.kind != ContactKind::bonded &&
                                  pair.partner == b);
                        }))
          result.push_back(b);
      return result;
    }

    /** The pair by which a point on the surface of a body is bonded from the
     * start, or -1. */
    template <int dim>
    int
    find_bond(const ContactSpec &contact,
              const Bodies<dim> &bodies,
              const unsigned int body,
              const Seed<dim>   &seed)
    {
      double extent = seed.domain[0]; // of the cell
      for (unsigned int d = 1; d < dim; ++d)
        extent = std::min(extent, seed.domain[d]);
      for (unsigned int q = 0; q < contact.pairs.size(); ++q)
        if (const auto &pair = contact.pairs[q];
            pair.kind == ContactKind::bonded && pair.body == body &&
            std::abs(
              bodies[pair.partner].shape->proximity(seed.position).distance) <
              0.25 * extent)
          return q;
      return -1;
    }
  } // namespace

  template <int dim>
  SurfacePoints<dim>::SurfacePoints(const ContactSpec         &contact,
                                    const Bodies<dim>         &bodies,
                                    const GeometryKind         geometry,
                                    const BackgroundGrid<dim> &grid)
    : sorted(grid, n_fields)
    , geometry(geometry)
    , sees_others(std::any_of(contact.pairs.begin(),
                              contact.pairs.end(),
                              [](const auto &pair) {
                                return pair.partner_kind ==
                                         PartnerKind::deformable &&
                                       pair.kind != ContactKind::bonded;
                              }))
    , communicator(grid.communicator)
    , grid(grid)
  {
    std::vector<Seed<dim>>      seeds;
    std::vector<Tensor<1, dim>> areas;
    for (const unsigned int b : bodies_with_surface(contact, bodies))
      {
        seeds.clear();
        areas.clear();
        for (const auto &cell : grid.triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const Point<dim> lower = cell->vertex(0);
              Tensor<1, dim>   extents;
              for (unsigned int d = 0; d < dim; ++d)
                extents[d] = cell_extent(cell, d);
              for (const auto &piece :
                   surface_in_box<dim>(*bodies[b].shape,
                                       lower,
                                       extents,
                                       bodies[b].points_per_cell))
                {
                  Seed<dim> seed{};
                  seed.position = piece.position;
                  for (unsigned int d = 0; d < dim; ++d)
                    seed.unit_position[d] =
                      (piece.position[d] - lower[d]) / extents[d];
                  seed.cell   = cell;
                  seed.domain = extents;
                  seeds.push_back(seed);
                  areas.push_back(geometry == GeometryKind::axisymmetric ?
                                    2 * numbers::PI * piece.position[0] *
                                      piece.area :
                                    piece.area);
                }
            }
        unsigned int next = 0;
        sorted.insert(seeds, [&](const Seed<dim> &seed, double *fields) {
          std::fill_n(fields, n_fields, 0.);
          fields[0] = b;
          fields[1] = find_bond(contact, bodies, b, seed);
          std::copy_n(areas[next++].begin_raw(), dim, fields + offset_area);
        });
      }
    sort();
  }

  template <int dim>
  void
  SurfacePoints<dim>::sort()
  {
    for (auto &particle : sorted.particles)
      {
        auto place = particle.get_location();
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double lower = grid.face_of_vertices(2 * d);
            const double upper = grid.face_of_vertices(2 * d + 1);
            const double slack = 1e-9 * (upper - lower);
            if (place[d] < lower && place[d] > lower - slack)
              place[d] = lower;
            if (place[d] > upper && place[d] < upper + slack)
              place[d] = upper;
          }
        particle.set_location(place);
      }
    sorted.sort();
    if (sees_others)
      sorted.particles.exchange_ghost_particles();
    data.clear();
    data.reserve(sorted.particles.n_locally_owned_particles());
    for (auto &particle : sorted.particles)
      data.push_back(particle.get_properties().data());
  }

  template <int dim>
  std::vector<std::string>
  SurfacePoints<dim>::field_names()
  {
    std::vector<std::string> names = {"body", "pair"};
    names.insert(names.end(), dim, "area");
    names.insert(names.end(), dim, "slip");
    names.insert(names.end(), {"contact_pressure", "gap"});
    return names;
  }

  template class SurfacePoints<2>;
  template class SurfacePoints<3>;
} // namespace impm
