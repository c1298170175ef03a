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
    /** Whether some pair follows the surface of a deformable body. */
    bool
    meets_others(const ContactSpec &contact, const unsigned int body)
    {
      return std::any_of(
        contact.pairs.begin(), contact.pairs.end(), [&](const auto &pair) {
          return pair.body == body ||
                 (pair.partner_kind == PartnerKind::deformable &&
                  pair.kind != ContactKind::bonded && pair.partner == body);
        });
    }

    /** A bit for each load that acts on a place of the surface of a body. */
    template <int dim>
    std::uint64_t
    loads_at(const std::vector<SurfaceLoadSpec<dim>> &loads,
             const unsigned int                       body,
             const Point<dim>                        &place)
    {
      std::uint64_t bits = 0;
      for (unsigned int l = 0; l < loads.size(); ++l)
        if (loads[l].body == body &&
            (!loads[l].where || loads[l].where->value(place) > 0))
          bits |= std::uint64_t(1) << l;
      return bits;
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

    /**
     * The surface in a box, of one piece or one for each side. Where an edge
     * has been cut off, which leaves the middle of a piece off the surface, and
     * this is to be better, so often in halves of the box.
     */
    template <int dim>
    void
    add_pieces(const Shape<dim>               &shape,
               const Point<dim>               &lower,
               const Tensor<1, dim>           &extents,
               const unsigned int              n_halvings,
               std::vector<SurfacePiece<dim>> &pieces)
    {
      std::array<unsigned int, dim> one;
      one.fill(1);
      auto       found  = surface_in_box<dim>(shape, lower, extents, one);
      const auto is_off = [&](const SurfacePiece<dim> &piece) {
        return std::abs(shape.proximity(piece.position).distance) >
               0.05 * std::pow(piece.area.norm(), 1. / (dim - 1));
      };
      if (n_halvings == 0 || std::none_of(found.begin(), found.end(), is_off))
        {
          for (auto &piece : found)
            put_onto_surface(shape, piece);
          pieces.insert(pieces.end(), found.begin(), found.end());
          return;
        }
      for (unsigned int v = 0; v < (1u << dim); ++v)
        {
          Point<dim> corner = lower;
          for (unsigned int d = 0; d < dim; ++d)
            corner[d] += (v >> d) % 2 * 0.5 * extents[d];
          add_pieces(shape, corner, 0.5 * extents, n_halvings - 1, pieces);
        }
    }

    /** The surface in a box of the size of a cell, by what points stand for. */
    template <int dim>
    std::vector<SurfacePiece<dim>>
    surface_by_points(const BodySpec<dim>  &body,
                      const Point<dim>     &lower,
                      const Tensor<1, dim> &extents,
                      const unsigned int    n_halvings)
    {
      if (n_halvings == 0)
        {
          auto pieces = surface_in_box<dim>(*body.shape,
                                            lower,
                                            extents,
                                            body.points_per_cell);
          for (auto &piece : pieces)
            put_onto_surface(*body.shape, piece);
          return pieces;
        }
      std::vector<SurfacePiece<dim>> pieces;
      unsigned int                   n_parts = 1;
      Tensor<1, dim>                 part;
      for (unsigned int d = 0; d < dim; ++d)
        {
          n_parts *= body.points_per_cell[d];
          part[d] = extents[d] / body.points_per_cell[d];
        }
      for (unsigned int i = 0; i < n_parts; ++i)
        {
          Point<dim>   corner = lower;
          unsigned int rest   = i;
          for (unsigned int d = 0; d < dim; ++d)
            {
              corner[d] += rest % body.points_per_cell[d] * part[d];
              rest /= body.points_per_cell[d];
            }
          add_pieces(*body.shape, corner, part, n_halvings, pieces);
        }
      return pieces;
    }

    /** The surface of a body in a cell, and that at the cell on faces of the
     * domain which the body meets, or which let it through while it has loads.
     */
    template <int dim, typename Cell>
    std::vector<SurfacePiece<dim>>
    surface_in_cell(const Scene<dim>  &scene,
                    const unsigned int b,
                    const Cell        &cell)
    {
      const auto    &body = scene.bodies[b];
      Tensor<1, dim> extents;
      for (unsigned int d = 0; d < dim; ++d)
        extents[d] = cell_extent(cell, d);
      const auto &pairs = scene.contact.pairs;
      const auto &loads = scene.loads.on_surfaces;
      const bool  has_loads =
        std::any_of(loads.begin(), loads.end(), [&](const auto &load) {
          return load.body == b;
        });
      // Loads count on the area.
      const unsigned int n_halvings = !has_loads ? 0 : dim == 2 ? 6 : 3;
      auto               pieces =
        surface_by_points(body, cell->vertex(0), extents, n_halvings);
      for (unsigned int f = 0; f < 2 * dim; ++f)
        if (cell->at_boundary(f) &&
            ((has_loads && !scene.faces[f].constrained[f / 2]) ||
             std::any_of(pairs.begin(), pairs.end(), [&](const auto &pair) {
               return pair.body == b &&
                      pair.partner_kind == PartnerKind::face &&
                      pair.partner == f;
             })))
          {
            // The box outside, of which the plane of the face is a part.
            const unsigned int d     = f / 2;
            const bool         upper = f % 2 == 1;
            Point<dim>         lower = cell->vertex(0);
            const double       plane = lower[d] + (upper ? extents[d] : 0);
            lower[d] += (upper ? 1 : -1) * extents[d];
            for (auto piece :
                 surface_by_points(body, lower, extents, n_halvings))
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
  SurfacePoints<dim>::SurfacePoints(const Scene<dim>          &scene,
                                    const BackgroundGrid<dim> &grid)
    : offset_loads(scene.contact.pairs.empty() ? offset_pair : offset_gap + 1)
    , offset_initial_edges(offset_loads + 1)
    , offset_initial_position(offset_initial_edges + dim * (dim - 1))
    , n_fields(scene.loads.on_surfaces.empty() ? offset_loads :
                                                 offset_initial_position + dim)
    , sorted(grid, n_fields)
    , geometry(scene.geometry)
    , sees_others(std::any_of(scene.contact.pairs.begin(),
                              scene.contact.pairs.end(),
                              [](const auto &pair) {
                                return pair.partner_kind ==
                                         PartnerKind::deformable &&
                                       pair.kind != ContactKind::bonded;
                              }))
    , communicator(grid.communicator)
    , scene(scene)
    , grid(grid)
  {
    const bool has_pairs = !scene.contact.pairs.empty();
    const bool has_loads = !scene.loads.on_surfaces.empty();
    for (unsigned int b = 0; b < scene.bodies.size(); ++b)
      {
        const bool meets = meets_others(scene.contact, b);
        if (scene.bodies[b].rigid || (!meets && !has_loads))
          continue;
        std::vector<Seed<dim>>     seeds;
        std::vector<Edges>         edges;
        std::vector<std::uint64_t> loads;
        for (const auto &cell : grid.triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
            for (const auto &piece : surface_in_cell<dim>(scene, b, cell))
              {
                const auto bits =
                  loads_at(scene.loads.on_surfaces, b, piece.position);
                if (!meets && bits == 0)
                  continue;
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
                edges.push_back(edges_of(piece.area));
                loads.push_back(bits);
              }
        unsigned int next = 0;
        sorted.insert(seeds, [&](const Seed<dim> &seed, double *fields) {
          std::fill_n(fields, n_fields, 0.);
          fields[0] = b;
          for (unsigned int k = 0; k < dim - 1; ++k)
            std::copy_n(edges[next][k].begin_raw(),
                        dim,
                        fields + offset_edges + k * dim);
          if (has_pairs)
            fields[offset_pair] =
              find_bond(scene.contact, scene.bodies, b, seed);
          if (has_loads)
            {
              fields[offset_loads] = loads[next];
              std::copy_n(fields + offset_edges,
                          dim * (dim - 1),
                          fields + offset_initial_edges);
              for (unsigned int d = 0; d < dim; ++d)
                fields[offset_initial_position + d] = seed.position[d];
            }
          ++next;
        });
      }
    sort();
    check_pairs();
    check_loads();
  }

  template <int dim>
  void
  SurfacePoints<dim>::check_pairs() const
  {
    const auto &pairs  = scene.contact.pairs;
    const auto &bodies = scene.bodies;
    if (pairs.empty())
      return;
    std::vector<unsigned int> n_of_body(bodies.size()), n_bonds(pairs.size());
    for (unsigned int s = 0; s < size(); ++s)
      {
        ++n_of_body[body(s)];
        if (pair(s) >= 0)
          ++n_bonds[pair(s)];
      }
    Utilities::MPI::sum(n_of_body, communicator, n_of_body);
    Utilities::MPI::sum(n_bonds, communicator, n_bonds);
    for (unsigned int q = 0; q < pairs.size(); ++q)
      {
        const auto       &pair  = pairs[q];
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
  SurfacePoints<dim>::check_loads() const
  {
    const auto               &loads = scene.loads.on_surfaces;
    std::vector<unsigned int> n_of_load(loads.size());
    for (unsigned int s = 0; s < size(); ++s)
      for (unsigned int l = 0; l < loads.size(); ++l)
        n_of_load[l] += carries(s, l);
    Utilities::MPI::sum(n_of_load, communicator, n_of_load);
    for (unsigned int l = 0; l < loads.size(); ++l)
      if (n_of_load[l] == 0)
        throw InputError("Loads/" + loads[l].name + "/Where",
                         "found no part of the surface of body '" +
                           scene.bodies[loads[l].body].name +
                           "' where the expression is positive (what lies on a "
                           "face of the domain does not count where that holds "
                           "its normal)");
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
        around.push_back(circumference(particle.get_location()));
      }
  }

  template <int dim>
  Footprints<dim>
  SurfacePoints<dim>::footprints(
    FootprintBuilder<dim>     &builder,
    const PopulatedCells<dim> &populated,
    const Discretization<dim> &discretization) const
  {
    std::vector<typename FootprintBuilder<dim>::Place> places;
    unsigned int                                       s = 0;
    for (const auto &particle : sorted.particles)
      places.push_back({particle.get_location(),
                        particle.get_surrounding_cell(),
                        scene.bodies[body(s++)].layer});
    return builder.build_at(places, populated, discretization);
  }

  template <int dim>
  void
  SurfacePoints<dim>::advance(const Footprints<dim> &footprints,
                              const Vector          &increment)
  {
    std::vector<Tensor<1, dim>> ways;
    footprints.interpolate(increment, ways);
    const auto   deformations = footprints.deformations(increment);
    unsigned int s            = 0;
    for (auto &particle : sorted.particles)
      {
        auto edges_at_end = edges(s);
        for (auto &edge : edges_at_end)
          edge = deformations[s] * edge;
        set_edges(s, edges_at_end);
        particle.set_location(particle.get_location() + ways[s]);
        ++s;
      }
  }

  template <int dim>
  void
  SurfacePoints<dim>::split()
  {
    std::vector<Seed<dim>>           seeds;
    std::vector<std::vector<double>> children;
    const bool   has_loads = !scene.loads.on_surfaces.empty();
    unsigned int s         = 0;
    for (auto &particle : sorted.particles)
      {
        const unsigned int point = s++;
        const auto         cell  = particle.get_surrounding_cell();
        const double longest = 1.1 / scene.bodies[body(point)].points_across;
        auto         parts   = edges(point);
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
        // The i-th part lies beside the middle, by so many of its own edges.
        const auto from_middle = [&](unsigned int i, const double *edges) {
          Tensor<1, dim> way;
          for (unsigned int k = 0; k < dim - 1; ++k)
            {
              for (unsigned int d = 0; d < dim; ++d)
                way[d] += (i % n[k] + 0.5 - 0.5 * n[k]) * edges[k * dim + d];
              i /= n[k];
            }
          return way;
        };
        double    *fields = data[point];
        Point<dim> initial_middle;
        if (has_loads)
          {
            initial_middle = initial_position(point);
            for (unsigned int k = 0; k < dim - 1; ++k)
              for (unsigned int d = 0; d < dim; ++d)
                fields[offset_initial_edges + k * dim + d] /= n[k];
          }
        for (unsigned int i = n_parts; i-- > 0;)
          {
            const Point<dim> place =
              middle + from_middle(i, fields + offset_edges);
            if (has_loads)
              set_vector(point,
                         offset_initial_position,
                         initial_middle +
                           from_middle(i, fields + offset_initial_edges));
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

  template <int dim>
  typename SurfacePoints<dim>::Edges
  SurfacePoints<dim>::edges_of(const Tensor<1, dim> &area)
  {
    Edges edges;
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

  template <int dim>
  std::vector<std::string>
  SurfacePoints<dim>::field_names() const
  {
    std::vector<std::string> names     = {"body"};
    const auto               add_edges = [&](const std::string &name) {
      for (unsigned int k = 1; k < dim; ++k)
        names.insert(names.end(), dim, name + std::to_string(k));
    };
    add_edges("edge_");
    names.insert(names.end(), dim, "beyond_face");
    if (!scene.contact.pairs.empty())
      {
        names.emplace_back("pair");
        names.insert(names.end(), dim, "slip");
        names.insert(names.end(), {"contact_pressure", "gap"});
      }
    if (!scene.loads.on_surfaces.empty())
      {
        names.emplace_back("loads");
        add_edges("initial_edge_");
        names.insert(names.end(), dim, "initial_position");
      }
    return names;
  }

  template class SurfacePoints<2>;
  template class SurfacePoints<3>;
} // namespace impm
