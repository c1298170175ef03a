#include <impm/base/exceptions.h>
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

    /** A square with this outward normal times area. */
    template <int dim>
    typename SurfacePoints<dim>::Edges
    edges_of(const Tensor<1, dim> &area)
    {
      typename SurfacePoints<dim>::Edges edges;
      if constexpr (dim == 2)
        {
          edges[0][0] = -area[1];
          edges[0][1] = area[0];
        }
      else
        {
          const auto   n = area / area.norm();
          unsigned int d = 0; // the axis that is the most along the surface
          for (unsigned int e = 1; e < dim; ++e)
            if (std::abs(n[e]) < std::abs(n[d]))
              d = e;
          Tensor<1, dim> axis;
          axis[d]  = 1;
          edges[1] = cross_product_3d(n, axis);
          edges[1] *= std::sqrt(area.norm()) / edges[1].norm();
          edges[0] = cross_product_3d(edges[1], n);
        }
      return edges;
    }

    /** Moves the middle of a piece, which lies on a chord of a curved surface,
     * off it by more than layers that touch give way. */
    template <int dim>
    void
    put_onto_surface(const Shape<dim> &shape, SurfacePiece<dim> &piece)
    {
      const auto   proximity = shape.proximity(piece.position);
      const double size      = std::pow(piece.area.norm(), 1. / (dim - 1));
      if (std::abs(proximity.distance) < 0.25 * size)
        piece.position -= proximity.distance * proximity.normal;
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
      for (auto &piece : pieces)
        put_onto_surface(*body.shape, piece);
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
    , bodies(bodies)
    , grid(grid)
  {
    std::vector<Seed<dim>> seeds;
    std::vector<Edges>     edges;
    for (const unsigned int b : bodies_with_surface(contact, bodies))
      {
        seeds.clear();
        edges.clear();
        for (const auto &cell : grid.triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
            for (const auto &piece :
                 surface_in_cell<dim>(contact, bodies[b], b, cell))
              {
                Seed<dim> seed{};
                seed.position = piece.position;
                seed.cell     = cell;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    seed.domain[d] = cell_extent(cell, d);
                    seed.unit_position[d] =
                      (seed.position[d] - cell->vertex(0)[d]) / seed.domain[d];
                  }
                seeds.push_back(seed);
                edges.push_back(edges_of<dim>(piece.area));
              }
        unsigned int next = 0;
        sorted.insert(seeds, [&](const Seed<dim> &seed, double *fields) {
          std::fill_n(fields, n_fields, 0.);
          fields[0] = b;
          fields[1] = find_bond(contact, bodies, b, seed);
          for (unsigned int k = 0; k < dim - 1; ++k)
            for (unsigned int d = 0; d < dim; ++d)
              fields[offset_edges + k * dim + d] = edges[next][k][d];
          ++next;
        });
      }
    sort();
    check_pairs(contact, bodies);
  }

  template <int dim>
  void
  SurfacePoints<dim>::check_pairs(const ContactSpec &contact,
                                  const Bodies<dim> &bodies) const
  {
    std::vector<unsigned int> n_of_body(bodies.size()),
      n_bonds(contact.pairs.size());
    for (unsigned int s = 0; s < size(); ++s)
      {
        ++n_of_body[body(s)];
        if (pair(s) >= 0)
          ++n_bonds[pair(s)];
      }
    Utilities::MPI::sum(n_of_body, communicator, n_of_body);
    Utilities::MPI::sum(n_bonds, communicator, n_bonds);
    for (unsigned int q = 0; q < contact.pairs.size(); ++q)
      {
        const auto       &pair  = contact.pairs[q];
        const std::string entry = "Contact/" + pair.name + "/Bodies";
        if (n_of_body[pair.body] == 0)
          throw InputError(entry,
                           "found '" + bodies[pair.body].name +
                             "', which has no surface within the grid: it "
                             "fills the grid, or is thinner than its points "
                             "are apart");
        if (pair.kind == ContactKind::bonded && n_bonds[q] == 0)
          throw InputError(entry,
                           "found '" + bodies[pair.body].name + "' and '" +
                             bodies[pair.partner].name +
                             "', whose surfaces do not touch at the start: "
                             "allowed for bonded bodies are such as do");
      }
  }

  template <int dim>
  void
  SurfacePoints<dim>::sort()
  {
    const double most = 0.25 * grid.discretization()->smallest_cell_extent;
    for (auto &particle : sorted.particles)
      {
        const auto fields = particle.get_properties();
        Point<dim> kept   = particle.get_location();
        for (unsigned int d = 0; d < dim; ++d)
          {
            double      &beyond = fields[offset_beyond + d];
            const double lower  = grid.face_of_vertices(2 * d);
            const double upper  = grid.face_of_vertices(2 * d + 1);
            const double place  = kept[d] + beyond;
            kept[d]             = place;
            if (place < lower && place > lower - most)
              kept[d] = lower;
            if (place > upper && place < upper + most)
              kept[d] = upper;
            beyond = place - kept[d];
          }
        particle.set_location(kept);
      }
    sorted.sort();
    if (sees_others)
      sorted.particles.exchange_ghost_particles();
    data.clear();
    around.clear();
    for (auto &particle : sorted.particles)
      {
        data.push_back(particle.get_properties().data());
        around.push_back(geometry == GeometryKind::axisymmetric ?
                           2 * numbers::PI * particle.get_location()[0] :
                           1.);
      }
  }

  template <int dim>
  void
  SurfacePoints<dim>::split()
  {
    std::vector<Seed<dim>>           seeds;
    std::vector<std::vector<double>> children;
    unsigned int                     s = 0;
    for (auto &particle : sorted.particles)
      {
        const unsigned int point   = s++;
        const auto         cell    = particle.get_surrounding_cell();
        const double       longest = 1.1 / bodies[body(point)].points_across;
        auto               parts   = edges(point);
        std::array<unsigned int, dim - 1> n;
        unsigned int                      n_parts = 1;
        for (unsigned int k = 0; k < dim - 1; ++k)
          {
            double share = 0; // of the cell
            for (unsigned int d = 0; d < dim; ++d)
              share =
                std::max(share, std::abs(parts[k][d]) / cell_extent(cell, d));
            n[k] = share > longest ? std::ceil(share / longest) : 1;
            n_parts *= n[k];
            parts[k] /= n[k];
          }
        if (n_parts == 1)
          continue;
        set_edges(point, parts);
        const Point<dim> middle = particle.get_location();
        for (unsigned int i = 0; i < n_parts; ++i)
          {
            Point<dim>   place = middle;
            unsigned int rest  = i;
            for (unsigned int k = 0; k < dim - 1; ++k)
              {
                place += (rest % n[k] + 0.5 - 0.5 * n[k]) * parts[k];
                rest /= n[k];
              }
            if (i == 0)
              {
                particle.set_location(place);
                continue;
              }
            Seed<dim> seed{};
            seed.cell     = cell;
            seed.position = place;
            for (unsigned int d = 0; d < dim; ++d)
              seed.unit_position[d] = 0.5; // until they are sorted
            seeds.push_back(seed);
            children.emplace_back(data[point], data[point] + n_fields);
          }
      }
    if (Utilities::MPI::max<unsigned int>(seeds.size(), communicator) == 0)
      return;
    unsigned int child = 0;
    sorted.insert(seeds, [&](const Seed<dim> &, double *fields) {
      const auto &from = children[child++];
      std::copy(from.begin(), from.end(), fields);
    });
    sort();
  }

  template <>
  Tensor<1, 2>
  SurfacePoints<2>::normal_of(const double *edges)
  {
    Tensor<1, 2> normal;
    normal[0] = edges[1];
    normal[1] = -edges[0];
    return normal;
  }

  template <>
  Tensor<1, 3>
  SurfacePoints<3>::normal_of(const double *edges)
  {
    Tensor<1, 3> first, second;
    for (unsigned int d = 0; d < 3; ++d)
      {
        first[d]  = edges[d];
        second[d] = edges[3 + d];
      }
    return cross_product_3d(first, second);
  }

  template <int dim>
  std::vector<std::string>
  SurfacePoints<dim>::field_names()
  {
    std::vector<std::string> names = {"body", "pair"};
    for (unsigned int k = 1; k < dim; ++k)
      names.insert(names.end(), dim, "edge_" + std::to_string(k));
    names.insert(names.end(), dim, "slip");
    names.insert(names.end(), {"contact_pressure", "gap"});
    names.insert(names.end(), dim, "beyond_face");
    return names;
  }

  template class SurfacePoints<2>;
  template class SurfacePoints<3>;
} // namespace impm
