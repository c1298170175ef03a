#include <deal.II/base/bounding_box.h>

#include <deal.II/grid/grid_tools.h>

#include <deal.II/numerics/rtree.h>

#include <impm/base/exceptions.h>
#include <impm/grid/criterion_tools.h>
#include <impm/points/point_domains.h>
#include <impm/points/point_fields.h>

#include <boost/geometry/algorithms/intersects.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    BoundingBox<dim>
    box_of(const ActiveCell<dim> &cell)
    {
      return BoundingBox<dim>({cell->vertex(0), cell->vertex((1u << dim) - 1)});
    }

    /** Half of a box around the domain of a point (m). */
    template <int dim>
    Tensor<1, dim>
    half_box(const MaterialPoints<dim>              &points,
             const unsigned int                      p,
             const Point<dim>                       &place,
             const std::optional<PointDomains<dim>> &domains)
    {
      Tensor<1, dim> half;
      for (unsigned int d = 0; d < dim; ++d)
        if (domains)
          for (unsigned int axis = 0; axis < dim; ++axis)
            half[d] += 0.5 * std::abs(domains->edge(points.fields(p), axis)[d]);
        else
          half[d] = 0.5 * std::pow(present_measure(points, p, place), 1. / dim);
      return half;
    }

    template <int dim>
    void
    raise_at_points(const CriterionSpec<dim> &criterion,
                    const GridState<dim>     &state,
                    std::vector<int>         &levels)
    {
      for_points(state, [&](const unsigned int p, const auto &particle) {
        const auto cell  = particle.get_surrounding_cell();
        double     ratio = 1;
        for (unsigned int d = 0; d < dim; ++d)
          ratio *= cell_extent(cell, d);
        ratio /= present_measure(state.points, p, particle.get_location());
        const double halvings =
          std::log2(std::pow(ratio, 1. / dim) / criterion.points_across);
        raise(levels[cell->active_cell_index()],
              state.grid.level(cell) +
                static_cast<int>(std::floor(halvings + 0.1)));
      });
    }

    /** By active index, of owned and ghost cells: whether the domain of some
     * point lies there in part. Collective. */
    template <int dim>
    std::vector<char>
    find_material(const GridState<dim> &state)
    {
      const auto &triangulation = state.grid.triangulation;
      const auto  neighbors     = GridTools::vertex_to_cell_map(triangulation);
      std::optional<PointDomains<dim>> domains;
      if (state.points.layout.find("initial_domain"))
        domains.emplace(state.points);
      Vector touched(
        triangulation.global_active_cell_index_partitioner().lock());
      for_points(state, [&](const unsigned int p, const auto &particle) {
        const auto cell = particle.get_surrounding_cell();
        const auto x    = particle.get_location();
        const auto half = half_box(state.points, p, x, domains);
        touched(cell->global_active_cell_index()) = 1;
        bool inside                               = true;
        for (unsigned int d = 0; d < dim; ++d)
          inside = inside && x[d] - half[d] >= cell->vertex(0)[d] &&
                   x[d] + half[d] <= cell->vertex((1u << dim) - 1)[d];
        if (inside)
          return;
        for (const auto v : cell->vertex_indices())
          for (const auto &other : neighbors[cell->vertex_index(v)])
            {
              bool overlaps = !other->is_artificial();
              for (unsigned int d = 0; overlaps && d < dim; ++d)
                {
                  // More than a touch.
                  const double slack = 0.05 * cell_extent(other, d);
                  overlaps =
                    x[d] + half[d] > other->vertex(0)[d] + slack &&
                    x[d] - half[d] < other->vertex((1u << dim) - 1)[d] - slack;
                }
              if (overlaps)
                touched(other->global_active_cell_index()) = 1;
            }
      });
      touched.compress(VectorOperation::max);
      touched.update_ghost_values();
      std::vector<char> material(triangulation.n_active_cells());
      for (const auto &cell : triangulation.active_cell_iterators())
        if (!cell->is_artificial())
          material[cell->active_cell_index()] =
            touched(cell->global_active_cell_index()) > 0;
      return material;
    }

    template <int dim>
    void
    raise_at_surface(const CriterionSpec<dim> &criterion,
                     const GridState<dim>     &state,
                     std::vector<int>         &levels)
    {
      const auto        material      = find_material(state);
      const auto       &triangulation = state.grid.triangulation;
      std::vector<char> is_empty_at(triangulation.n_vertices());
      for (const auto &cell : triangulation.active_cell_iterators())
        if (!cell->is_artificial() && !material[cell->active_cell_index()])
          for (const auto v : cell->vertex_indices())
            is_empty_at[cell->vertex_index(v)] = 1;
      for_owned_cells<dim>(state, [&](const auto &cell) {
        if (material[cell->active_cell_index()])
          for (const auto v : cell->vertex_indices())
            if (is_empty_at[cell->vertex_index(v)])
              raise(levels[cell->active_cell_index()], criterion.level);
      });
    }

    /** Boxes around the points of a body in each cell, of all ranks.
     * Collective. */
    template <int dim>
    std::vector<BoundingBox<dim>>
    boxes_of_body(const std::string &name, const GridState<dim> &state)
    {
      std::vector<BoundingBox<dim>> boxes;
      ActiveCell<dim>               last;
      const auto                    add = [&](const auto &particle) {
        const auto cell = particle.get_surrounding_cell();
        if (boxes.empty() || cell != last)
          boxes.emplace_back(
            std::make_pair(particle.get_location(), particle.get_location()));
        else
          boxes.back().merge_with(BoundingBox<dim>(
            std::make_pair(particle.get_location(), particle.get_location())));
        last = cell;
      };
      for (const auto &body : state.rigid.bodies)
        if (body.spec->name == name)
          for (const auto &particle : body.points->particles)
            add(particle);
      for_points(state, [&](const unsigned int p, const auto &particle) {
        if (state.points.name_of_body(p) == name)
          add(particle);
      });
      std::vector<BoundingBox<dim>> all;
      for (const auto &some :
           Utilities::MPI::all_gather(state.grid.communicator, boxes))
        all.insert(all.end(), some.begin(), some.end());
      return all;
    }

    template <int dim>
    void
    raise_nearby(const CriterionSpec<dim> &criterion,
                 const GridState<dim>     &state,
                 std::vector<int>         &levels)
    {
      const auto face =
        std::find(face_names().begin(), face_names().end(), criterion.of);
      if (face != face_names().end())
        {
          const unsigned int f     = face - face_names().begin();
          const double       place = state.grid.face_position(f);
          for_owned_cells<dim>(state, [&](const auto &cell) {
            const auto near = cell->vertex(f % 2 == 0 ? 0 : (1u << dim) - 1);
            if (std::abs(near[f / 2] - place) <= criterion.distance)
              raise(levels[cell->active_cell_index()], criterion.level);
          });
          return;
        }
      for (const auto &body : state.rigid.bodies)
        if (body.spec->name == criterion.of && body.spec->meets_surfaces)
          {
            const auto motion = body.since_start(state.time);
            for_owned_cells<dim>(state, [&](const auto &cell) {
              const auto   box    = box_of<dim>(cell);
              const double radius = box.center().distance(box.vertex(0));
              if (std::abs(
                    body.spec->shape->proximity(motion.inverse(box.center()))
                      .distance) <= criterion.distance + radius)
                raise(levels[cell->active_cell_index()], criterion.level);
            });
            return;
          }
      const auto tree = pack_rtree(boxes_of_body(criterion.of, state));
      for_owned_cells<dim>(state, [&](const auto &cell) {
        auto box = box_of<dim>(cell);
        box.extend(criterion.distance);
        if (tree.qbegin(boost::geometry::index::intersects(box)) != tree.qend())
          raise(levels[cell->active_cell_index()], criterion.level);
      });
    }

    template <int dim>
    void
    raise_by_expression(const CriterionSpec<dim> &criterion,
                        const GridState<dim>     &state,
                        std::vector<int>         &levels)
    {
      criterion.expression->set_time(state.time);
      std::string flaw;
      for_owned_cells<dim>(state, [&](const auto &cell) {
        const double level = criterion.expression->value(cell->center());
        if (std::isnan(level))
          {
            std::ostringstream where;
            where << "is not a number at " << cell->center()
                  << ", t = " << state.time;
            flaw = where.str();
          }
        else
          raise(levels[cell->active_cell_index()],
                static_cast<int>(std::floor(std::clamp(level, 0., 100.))));
      });
      const std::string entry =
        "Grid/Adaptation/" + criterion.name + "/Expression";
      for (const auto &one :
           Utilities::MPI::all_gather(state.grid.communicator, flaw))
        if (one.empty())
          continue;
        else if (state.time == 0)
          throw InputError(entry, "found an expression that " + one);
        else
          throw ComputationError("entry '" + entry + "' " + one);
    }
  } // namespace

  template <int dim>
  void
  raise_levels(const CriterionSpec<dim> &criterion,
               const GridState<dim>     &state,
               std::vector<int>         &levels)
  {
    using Kind = typename CriterionSpec<dim>::Kind;
    switch (criterion.kind)
      {
        case Kind::points:
          return raise_at_points(criterion, state, levels);
        case Kind::free_surface:
          return raise_at_surface(criterion, state, levels);
        case Kind::distance:
          return raise_nearby(criterion, state, levels);
        case Kind::stress_error:
          return raise_by_error(criterion, state, levels);
        case Kind::size:
          return raise_by_size(criterion, state, levels);
        case Kind::gradient:
          return raise_by_gradient(criterion, state, levels);
        case Kind::expression:
          return raise_by_expression(criterion, state, levels);
      }
  }

  template void
  raise_levels(const CriterionSpec<2> &,
               const GridState<2> &,
               std::vector<int> &);
  template void
  raise_levels(const CriterionSpec<3> &,
               const GridState<3> &,
               std::vector<int> &);
} // namespace impm
