#include <impm/footprints/footprint_builder.h>
#include <impm/points/point_domains.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Part of a cell, less than which is not much material. */
    constexpr double little = 0.1;

    /** Whether cells share more than a face in a direction. */
    template <typename Cell>
    bool
    overlap(const Cell &one, const Cell &other, const unsigned int d)
    {
      const double start          = one->vertex(0)[d],
                   start_of_other = other->vertex(0)[d];
      const double common         = std::min(start + cell_extent(one, d),
                                     start_of_other + cell_extent(other, d)) -
                            std::max(start, start_of_other);
      return common > 1e-9 * cell_extent(one, d);
    }

    /** Where a place in a unit cell is in an axis-aligned one (m). */
    template <typename Cell, int dim>
    Point<dim>
    place_in(const Cell &cell, const Tensor<1, dim> &unit)
    {
      Point<dim> place = cell->vertex(0);
      for (unsigned int d = 0; d < dim; ++d)
        place[d] += unit[d] * cell_extent(cell, d);
      return place;
    }

    /** Appends the part of a box [lower, upper] in a cell; returns its weight.
     */
    template <int dim>
    double
    cut(const typename CellsAtVertices<dim>::CellIterator &cell,
        const Discretization<dim>                         &discretization,
        const unsigned int                                 p,
        const unsigned int                                 layer,
        const Point<dim>                                  &lower,
        const Point<dim>                                  &upper,
        std::vector<typename Footprints<dim>::Piece>      &pieces)
    {
      // Where box and cell only touch, round-off decides.
      const double sliver = 1e-9;
      double       weight = 1;
      Point<dim>   centroid;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double start  = cell->vertex(0)[d];
          const double extent = cell_extent(cell, d);
          const double from   = std::max(lower[d], start);
          const double to     = std::min(upper[d], start + extent);
          const double share  = (to - from) / (upper[d] - lower[d]);
          if (!(share > sliver))
            return 0;
          weight *= share;
          centroid[d] = (0.5 * (from + to) - start) / extent;
        }
      pieces.push_back(
        {p, layer, discretization.with_dofs(cell), weight, centroid});
      return weight;
    }
  } // namespace

  template <int dim>
  void
  FootprintBuilder<dim>::add_fields(const GridSpec<dim> &spec,
                                    PointLayout         &layout)
  {
    if (!spec.keeps_motion() || spec.is_lagrangian())
      return;
    layout.add("unit_position", PointLayout::Kind::vector);
    if (spec.method == GridMethod::gimp)
      layout.add("half_extents", PointLayout::Kind::vector);
  }

  template <int dim>
  void
  FootprintBuilder<dim>::remember(MaterialPoints<dim> &points) const
  {
    if (!keeps_motion)
      return;
    const auto  &layout   = points.layout;
    const auto   position = layout.offset("unit_position");
    const auto   half     = layout.find("half_extents");
    unsigned int p        = 0;
    for (const auto &particle : points.sorted.particles)
      {
        points.set_vector(p, position, particle.get_reference_location());
        if (half)
          points.set_vector(p,
                            *half,
                            half_extents(points,
                                         p,
                                         layout.offset("initial_domain"),
                                         boxes_stretch));
        ++p;
      }
  }

  template <int dim>
  void
  FootprintBuilder<dim>::sort(MaterialPoints<dim>       &points,
                              const BackgroundGrid<dim> &grid) const
  {
    // The field will be filled anew: until then it travels with the points.
    const auto   end     = points.layout.offset("unit_position");
    double       longest = 0;
    unsigned int p       = 0;
    for (auto &particle : points.sorted.particles)
      {
        const auto goal = particle.get_location();
        const auto start =
          place_in(particle.get_surrounding_cell(), points.vector(p, end));
        for (unsigned int d = 0; d < dim; ++d)
          longest = std::max(longest, std::abs(goal[d] - start[d]));
        particle.set_location(start);
        points.set_vector(p++, end, goal);
      }
    const unsigned int n_places =
      1 + Utilities::MPI::max(longest, grid.communicator) /
            (0.9 * grid.discretization()->smallest_cell_extent);
    for (unsigned int n = n_places; n > 0; --n)
      {
        p = 0;
        for (auto &particle : points.sorted.particles)
          {
            const Point<dim> goal(points.vector(p++, end));
            const auto       x = particle.get_location();
            particle.set_location(n == 1 ? goal : x + (goal - x) / n);
          }
        points.sort();
      }
  }

  template <int dim>
  void
  FootprintBuilder<dim>::find_surroundings(
    const CellIterator        &cell,
    const Discretization<dim> &discretization,
    Surroundings              &result)
  {
    if (epoch != discretization.numbering->epoch)
      {
        epoch = discretization.numbering->epoch;
        cells_at_vertices.emplace(discretization.numbering->triangulation);
      }
    cells_at_vertices->find_around(cell, result.cells);
    for (unsigned int d = 0; d < dim; ++d)
      {
        result.start[d] = cell->vertex(0)[d];
        result.end[d]   = result.start[d] + cell_extent(cell, d);
        result.reach[d] = std::numeric_limits<double>::max();
        for (const auto &other : result.cells)
          result.reach[d] = std::min(result.reach[d], cell_extent(other, d));
      }
  }

  template <int dim>
  Footprints<dim>
  FootprintBuilder<dim>::build(const MaterialPoints<dim> &points,
                               const BackgroundGrid<dim> &grid,
                               const Discretization<dim> &discretization)
  {
    Footprints<dim>                              footprints;
    std::vector<typename Footprints<dim>::Piece> pieces, middles;
    pieces.reserve(points.size());
    const auto &layout        = points.layout;
    const auto  offset_domain = has_boxes ? layout.offset("initial_domain") : 0;
    const auto  offset_position =
      keeps_motion ? layout.offset("unit_position") : 0;
    const auto offset_half =
      keeps_motion && has_boxes ? layout.offset("half_extents") : 0;
    unsigned int p = 0;
    Surroundings around;
    CellIterator current; ///< which they are of
    for (const auto &particle : points.sorted.particles)
      {
        const auto cell =
          discretization.with_dofs(particle.get_surrounding_cell());
        // What a particle has as its own is its handler's to change.
        const Point<dim> unit =
          keeps_motion ? Point<dim>(points.vector(p, offset_position)) :
                         particle.get_reference_location();
        const auto x =
          keeps_motion ? place_in(cell, unit) : particle.get_location();
        double             radius = x[0];
        const unsigned int first  = pieces.size();
        const unsigned int layer  = points.layer(p);
        if (has_boxes)
          {
            if (around.cells.empty() || cell != current)
              {
                current = cell;
                find_surroundings(cell, discretization, around);
              }
            const auto &[cells, reach, start, end] = around;
            const auto half =
              keeps_motion ?
                points.vector(p, offset_half) :
                half_extents(points, p, offset_domain, boxes_stretch);
            Point<dim>     lower = x - half, upper = x + half;
            Tensor<1, dim> middle = half; // half of what is symmetric
            bool           inside = true, limited = false, at_face = false;
            for (unsigned int d = 0; d < dim; ++d)
              {
                lower[d] = std::max(lower[d], grid.face_of_vertices(2 * d));
                upper[d] = std::min(upper[d], grid.face_of_vertices(2 * d + 1));
                middle[d] =
                  std::min({half[d], x[d] - lower[d], upper[d] - x[d]});
                // Round-off is no cut.
                at_face = at_face || middle[d] < (1 - 1e-9) * half[d];
                // Other ranks see no further than one cell.
                const double slack = 1e-9 * reach[d];
                const double below = start[d] - reach[d],
                             above = end[d] + reach[d];
                limited            = limited || lower[d] < below - slack ||
                          upper[d] > above + slack;
                lower[d] = std::max(lower[d], below);
                upper[d] = std::min(upper[d], above);
                inside   = inside && lower[d] >= start[d] && upper[d] <= end[d];
              }
            footprints.n_limited_boxes += limited;
            radius     = (lower[0] + upper[0]) / 2;
            double sum = 0;
            if (inside)
              sum =
                cut<dim>(cell, discretization, p, layer, lower, upper, pieces);
            else
              for (const auto &other : cells)
                sum +=
                  cut(other, discretization, p, layer, lower, upper, pieces);
            for (unsigned int i = first; i < pieces.size(); ++i)
              pieces[i].weight /= sum;
            if (at_face)
              {
                const unsigned int begin = middles.size();
                double             total = 0;
                for (const auto &other : cells)
                  total += cut(other,
                               discretization,
                               p,
                               layer,
                               x - middle,
                               x + middle,
                               middles);
                for (unsigned int i = begin; i < middles.size(); ++i)
                  middles[i].weight /= total;
                if (middles.size() == begin)
                  middles.push_back({p, layer, cell, 1., unit});
              }
          }
        // A box without extent, too, is a point.
        if (pieces.size() == first)
          pieces.push_back({p, layer, cell, 1., unit});
        if (points.layout.geometry == GeometryKind::axisymmetric)
          footprints.inverse_radius.push_back(1 / radius);
        ++p;
      }
    footprints.build(pieces, p, discretization, grid.is_lagrangian);
    if (!middles.empty())
      {
        footprints.middles = std::make_shared<Footprints<dim>>();
        footprints.middles->build(middles, p, discretization, false);
      }
    return footprints;
  }

  template <int dim>
  Footprints<dim>
  FootprintBuilder<dim>::build_at(const std::vector<Place>  &places,
                                  const PopulatedCells<dim> &populated,
                                  const Discretization<dim> &discretization)
  {
    std::vector<typename Footprints<dim>::Piece> pieces;
    Surroundings                                 around;
    for (unsigned int p = 0; p < places.size(); ++p)
      {
        const auto &[x, place_cell, layer] = places[p];
        if (!layer)
          continue;
        auto        cell      = discretization.with_dofs(place_cell);
        const auto &stiffness = populated.stiffness[*layer];
        const auto  beyond    = [&x = x](const auto &other, const auto d) {
          const double from = other->vertex(0)[d] - x[d];
          return std::max({0., from, -from - cell_extent(other, d)});
        };
        const auto square_to = [&](const auto &other) {
          double square = 0;
          for (unsigned int d = 0; d < dim; ++d)
            square += beyond(other, d) * beyond(other, d);
          return square;
        };
        const auto go_to_nearest = [&](const auto &is_allowed) {
          double nearest = std::numeric_limits<double>::max();
          for (const auto &other : around.cells)
            if (const auto index = other->active_cell_index();
                stiffness[index] > 0 && is_allowed(index))
              if (const double square = square_to(other); square < nearest)
                {
                  nearest = square;
                  cell    = discretization.with_dofs(other);
                }
        };
        if (stiffness[cell->active_cell_index()] == 0 || square_to(cell) > 0)
          {
            find_surroundings(cell, discretization, around);
            go_to_nearest([](const unsigned int) { return true; });
          }
        else if (!populated.filling.empty())
          {
            // Where material lacks, nodes that little of it reaches give way
            // to what presses there until it does so no more.
            const auto  &filling = populated.filling[*layer];
            const double here    = filling[cell->active_cell_index()];
            if (here < little)
              {
                find_surroundings(cell, discretization, around);
                // If the material of another cell went on as far as the place.
                const auto expected = [&](const auto &other) {
                  double part = filling[other->active_cell_index()];
                  for (unsigned int d = 0; d < dim; ++d)
                    if (!overlap(place_cell, other, d))
                      part *= beyond(other, d) / cell_extent(place_cell, d);
                  return part;
                };
                if (std::any_of(around.cells.begin(),
                                around.cells.end(),
                                [&](const auto &other) {
                                  return expected(other) > 10 * here;
                                }))
                  go_to_nearest([&](const unsigned int index) {
                    return filling[index] >= little;
                  });
              }
          }
        Point<dim> unit;
        for (unsigned int d = 0; d < dim; ++d)
          unit[d] = (x[d] - cell->vertex(0)[d]) / cell_extent(cell, d);
        pieces.push_back({p, *layer, cell, 1., unit});
      }
    Footprints<dim> footprints;
    footprints.build(pieces, places.size(), discretization, false);
    return footprints;
  }

  template class FootprintBuilder<2>;
  template class FootprintBuilder<3>;
} // namespace impm
