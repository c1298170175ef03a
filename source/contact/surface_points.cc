#include <impm/contact/surface_points.h>
#include <impm/scene/surface_of_shape.h>

#include <algorithm>
#include <cmath>

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

    /** The surface of a body in a cell, and that on faces of the domain, which
     * the body meets, at the cell. */
    template <int dim, typename Cell>
    std::vector<SurfacePiece<dim>>
    surface_in_cell(const ContactSpec   &contact,
                    const BodySpec<dim> &body,
                    const unsigned int   b,
                    const Cell          &cell)
    {
      Tensor<1, dim> extents;
      for (unsigned int d = 0; d < dim; ++d)
        extents[d] = cell_extent(cell, d);
      auto pieces = surface_in_box<dim>(*body.shape,
                                        cell->vertex(0),
                                        extents,
                                        body.points_per_cell);
      for (const auto &pair : contact.pairs)
        if (pair.body == b && pair.partner_kind == PartnerKind::face &&
            cell->at_boundary(pair.partner))
          {
            // The box outside, of which the plane of the face is a part.
            const unsigned int d     = pair.partner / 2;
            const bool         upper = pair.partner % 2 == 1;
            Point<dim>         lower = cell->vertex(0);
            const double       plane = lower[d] + (upper ? extents[d] : 0);
            lower[d] += (upper ? 1 : -1) * extents[d];
            for (auto piece : surface_in_box<dim>(
                   *body.shape, lower, extents, body.points_per_cell))
              if (std::abs(piece.position[d] - plane) < 1e-6 * extents[d])
                {
                  piece.position[d] = plane;
                  pieces.push_back(piece);
                }
          }
      return pieces;
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
                   surface_in_cell<dim>(contact, bodies[b], b, cell))
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
    // Who goes further has not come to press on a face.
    const double slack = 0.5 * grid.discretization()->smallest_cell_extent;
    for (auto &particle : sorted.particles)
      {
        const auto at     = place(particle);
        auto       inside = at;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double lower = grid.face_of_vertices(2 * d);
            const double upper = grid.face_of_vertices(2 * d + 1);
            if (at[d] > lower - slack && at[d] < upper + slack)
              inside[d] = std::clamp(at[d], lower, upper);
            particle.get_properties()[offset_beyond + d] = at[d] - inside[d];
          }
        particle.set_location(inside);
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
    names.insert(names.end(), dim, "beyond");
    return names;
  }

  template class SurfacePoints<2>;
  template class SurfacePoints<3>;
} // namespace impm
