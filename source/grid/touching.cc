#include <impm/grid/touching.h>
#include <impm/points/point_domains.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    // Cells between a point and a face that it begins or ceases to touch.
    constexpr double closest = 0.1, farthest = 0.4;

    // Of what a point carries: touches face f, or lands there in this step.
    constexpr unsigned int
    touches(const unsigned int face)
    {
      return 1u << face;
    }

    template <int dim>
    constexpr unsigned int
    lands(const unsigned int face)
    {
      return 1u << (2 * dim + face);
    }

    template <int dim>
    unsigned int
    bits_of(const MaterialPoints<dim> &points, const unsigned int p)
    {
      return static_cast<unsigned int>(points.fields(p)[points.offset_touched]);
    }

    /** Between the box of a point, at `place`, and a face at `face_position`
     * (m). */
    template <int dim>
    double
    gap_to_face(const MaterialPoints<dim> &points,
                const unsigned int         p,
                const unsigned int         face,
                const Point<dim>          &place,
                const double               face_position)
    {
      const auto half =
        half_extents(points, p, points.layout.offset("initial_domain"), true);
      return (face % 2 == 0 ? 1 : -1) * (place[face / 2] - face_position) -
             half[face / 2];
    }

    /** Calls `found` for each point that lies in the cells at a face of the
     * domain which holds by touch: with its number, place, cell and the face.
     */
    template <int dim, typename Found>
    void
    for_points_at_faces(const Faces<dim>          &faces,
                        const MaterialPoints<dim> &points,
                        const Found               &found)
    {
      unsigned int p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const auto cell = particle.get_surrounding_cell();
          if (cell->at_boundary())
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary() && faces[f].holds_by_touch)
                found(p, particle.get_location(), cell, f);
          ++p;
        }
    }
  } // namespace

  template <int dim>
  void
  add_touching_field(const Faces<dim> &faces, PointLayout &layout)
  {
    if (std::any_of(faces.begin(), faces.end(), [](const auto &face) {
          return face.holds_by_touch;
        }))
      layout.add("touched_faces", PointLayout::Kind::scalar);
  }

  template <int dim>
  void
  remember_touching(const Faces<dim>          &faces,
                    const BackgroundGrid<dim> &grid,
                    MaterialPoints<dim>       &points)
  {
    if (points.offset_touched == 0)
      return;
    std::vector<unsigned int> bits(points.size());
    for_points_at_faces(
      faces,
      points,
      [&](const unsigned int p,
          const Point<dim>  &x,
          const auto        &cell,
          const unsigned int f) {
        const double far =
          (bits_of(points, p) & touches(f)) != 0 ? farthest : closest;
        if (gap_to_face(points, p, f, x, grid.face_of_vertices(f)) <
            far * cell_extent(cell, f / 2))
          bits[p] |= touches(f);
      });
    for (unsigned int p = 0; p < points.size(); ++p)
      points.fields(p)[points.offset_touched] = bits[p];
  }

  template <int dim>
  bool
  land(const Faces<dim>                                  &faces,
       const typename BackgroundGrid<dim>::FacePositions &end,
       const std::vector<Tensor<1, dim>>                 &increments,
       MaterialPoints<dim>                               &points)
  {
    if (points.offset_touched == 0)
      return false;
    bool any = false;
    for_points_at_faces(
      faces,
      points,
      [&](const unsigned int p,
          const Point<dim>  &x,
          const auto & /*cell*/,
          const unsigned int f) {
        const unsigned int bits = bits_of(points, p);
        if ((bits & touches(f)) != 0 ||
            gap_to_face(points, p, f, x + increments[p], end[f]) >= 0)
          return;
        points.fields(p)[points.offset_touched] =
          bits | touches(f) | lands<dim>(f);
        any = true;
      });
    return Utilities::MPI::max(any ? 1 : 0, points.communicator) > 0;
  }

  template <int dim>
  void
  end_landing(const bool was_made, MaterialPoints<dim> &points)
  {
    if (points.offset_touched == 0)
      return;
    constexpr unsigned int all = (1u << 2 * dim) - 1;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const unsigned int bits = bits_of(points, p), landed = bits >> 2 * dim;
        points.fields(p)[points.offset_touched] =
          bits & all & ~(was_made ? 0u : landed);
      }
  }

  template <int dim>
  TouchedNodes<dim>::TouchedNodes(const Faces<dim>          &faces,
                                  const BackgroundGrid<dim> &grid,
                                  const Discretization<dim> &discretization,
                                  const MaterialPoints<dim> &points,
                                  const Footprints<dim>     &footprints)
    : all(points.offset_touched == 0)
  {
    if (all)
      return;
    for (unsigned int d = 0; d < dim; ++d)
      largest_gap = std::max(largest_gap,
                             grid.face_of_vertices(2 * d + 1) -
                               grid.face_of_vertices(2 * d));
    Vector waiting, reached;
    for (Vector *nodes : {&closeness, &waiting, &reached})
      discretization.initialize(*nodes);

    const auto &hanging = discretization.numbering->hanging_nodes;
    const auto  set_at  = [&](Vector            &nodes,
                            const auto        &place,
                            const unsigned int f,
                            const unsigned int p,
                            const double       value) {
      const auto cell = discretization.with_dofs(place);
      const auto set  = [&](const types::global_dof_index dof) {
        nodes(dof) = std::max(nodes(dof), value);
      };
      for (const unsigned int v : cell->face(f)->vertex_indices())
        {
          const auto dof =
            cell->face(f)->vertex_dof_index(v, dim * points.layer(p) + f / 2);
          set(dof);
          // A hanging node is held by holding its masters.
          if (hanging.is_constrained(dof))
            for (const auto &entry : *hanging.get_constraint_entries(dof))
              set(entry.first);
        }
    };

    for_points_at_faces(
      faces,
      points,
      [&](const unsigned int p,
          const Point<dim>  &x,
          const auto        &cell,
          const unsigned int f) {
        const unsigned int bits = bits_of(points, p);
        if ((bits & touches(f)) == 0)
          return set_at(waiting, cell, f, p, 1);
        // On a grid that has moved points are elsewhere than their boxes.
        const double gap =
          (bits & lands<dim>(f)) != 0 && !grid.is_moved() ?
            std::max(0.,
                     gap_to_face(points, p, f, x, grid.face_of_vertices(f))) :
            0.;
        set_at(closeness, cell, f, p, largest_gap - gap);
      });

    // Nodes that only edges of boxes reach: those of what touches hold, too, if
    // no other material lies there. Were they free, what spreads into the next
    // column would part from the face.
    for (const auto &entries : footprints.cells)
      if (entries.cell->at_boundary())
        for (const unsigned int f : entries.cell->face_indices())
          if (entries.cell->face(f)->at_boundary() && faces[f].holds_by_touch)
            for (unsigned int e = entries.begin; e < entries.end; ++e)
              {
                const unsigned int p    = footprints.point[e],
                                   bits = bits_of(points, p);
                if ((bits & touches(f)) != 0 && (bits & lands<dim>(f)) == 0)
                  set_at(reached, entries.cell, f, p, largest_gap);
              }
    for (Vector *nodes : {&closeness, &waiting, &reached})
      nodes->compress(VectorOperation::max);
    for (unsigned int i = 0; i < closeness.locally_owned_size(); ++i)
      if (closeness.local_element(i) == 0 && waiting.local_element(i) == 0)
        closeness.local_element(i) = reached.local_element(i);
    closeness.update_ghost_values();
  }

  template decltype(add_touching_field<2>) add_touching_field<2>;
  template decltype(add_touching_field<3>) add_touching_field<3>;
  template decltype(remember_touching<2>)  remember_touching<2>;
  template decltype(remember_touching<3>)  remember_touching<3>;
  template decltype(land<2>)               land<2>;
  template decltype(land<3>)               land<3>;
  template decltype(end_landing<2>)        end_landing<2>;
  template decltype(end_landing<3>)        end_landing<3>;
  template struct TouchedNodes<2>;
  template struct TouchedNodes<3>;
} // namespace impm
