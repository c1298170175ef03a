#include <deal.II/base/bounding_box.h>

#include <deal.II/numerics/rtree.h>

#include <impm/base/exceptions.h>
#include <impm/grid/criteria.h>
#include <impm/grid/populated_cells.h>
#include <impm/points/point_domains.h>
#include <impm/points/point_fields.h>

#include <boost/geometry/algorithms/intersects.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using Cell = typename Triangulation<dim>::active_cell_iterator;

    template <int dim>
    BoundingBox<dim>
    box_of(const Cell<dim> &cell)
    {
      return BoundingBox<dim>({cell->vertex(0), cell->vertex((1u << dim) - 1)});
    }

    template <int dim>
    void
    for_owned_cells(const GridState<dim>                         &state,
                    const std::function<void(const Cell<dim> &)> &action)
    {
      for (const auto &cell : state.grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          action(cell);
    }

    void
    raise(int &level, const int wanted)
    {
      level = std::max(level, wanted);
    }

    /** Calls an action with number and particle of each point. */
    template <int dim, typename Action>
    void
    for_points(const GridState<dim> &state, const Action &action)
    {
      unsigned int p = 0;
      for (const auto &particle : state.points.sorted.particles)
        action(p++, particle);
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
      Cell<dim>                     last;
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
      const auto tree = pack_rtree(boxes_of_body(criterion.of, state));
      for_owned_cells<dim>(state, [&](const auto &cell) {
        auto box = box_of<dim>(cell);
        box.extend(criterion.distance);
        if (tree.qbegin(boost::geometry::index::intersects(box)) != tree.qend())
          raise(levels[cell->active_cell_index()], criterion.level);
      });
    }

    template <int dim>
    PointField<dim>
    find_field(const std::string        &name,
               const CriterionSpec<dim> &criterion,
               const GridState<dim>     &state)
    {
      const auto  field   = make_point_field(name, state.points);
      std::string problem = field ? "" : "the points of this scene do not have";
      if (field && criterion.component &&
          *criterion.component >= field->n_components)
        problem = "which has no component " +
                  std::to_string(static_cast<int>(*criterion.component));
      if (!problem.empty())
        throw InputError("Grid/Adaptation/" + criterion.name + "/Field",
                         "found '" + name + "', " + problem);
      field->prepare();
      return *field;
    }

    /** Of a field at a point: a component, or the norm. */
    template <int dim>
    double
    value_of(const PointField<dim>    &field,
             const CriterionSpec<dim> &criterion,
             const unsigned int        p,
             const Point<dim>         &place)
    {
      double values[9] = {};
      field.evaluate(p, place, values);
      if (criterion.component)
        return values[static_cast<unsigned int>(*criterion.component)];
      if (field.n_components == 1)
        return values[0];
      double square = 0;
      for (unsigned int c = 0; c < field.n_components; ++c)
        square += values[c] * values[c];
      return std::sqrt(square);
    }

    template <int dim>
    void
    raise_by_size(const CriterionSpec<dim> &criterion,
                  const GridState<dim>     &state,
                  std::vector<int>         &levels)
    {
      const auto field = find_field(criterion.field, criterion, state);
      for_points(state, [&](const unsigned int p, const auto &particle) {
        if (std::abs(value_of(field, criterion, p, particle.get_location())) >
            criterion.above)
          raise(levels[particle.get_surrounding_cell()->active_cell_index()],
                criterion.level);
      });
    }

    template <int dim>
    void
    raise_by_gradient(const CriterionSpec<dim> &criterion,
                      const GridState<dim>     &state,
                      std::vector<int>         &levels)
    {
      const auto          field = find_field(criterion.field, criterion, state);
      const auto         &triangulation = state.grid.triangulation;
      std::vector<double> mean(triangulation.n_active_cells()),
        n(triangulation.n_active_cells());
      for_points(state, [&](const unsigned int p, const auto &particle) {
        const auto c = particle.get_surrounding_cell()->active_cell_index();
        mean[c] += value_of(field, criterion, p, particle.get_location());
        n[c] += 1;
      });
      for (unsigned int c = 0; c < mean.size(); ++c)
        if (n[c] > 0)
          mean[c] /= n[c];
      const auto discretization = state.grid.discretization();
      exchange_cell_data(*discretization, mean);
      exchange_cell_data(*discretization, n);
      const auto neighbors = GridTools::vertex_to_cell_map(triangulation);
      for_owned_cells<dim>(state, [&](const auto &cell) {
        const auto c = cell->active_cell_index();
        for (const auto v : cell->vertex_indices())
          for (const auto &other : neighbors[cell->vertex_index(v)])
            if (const auto o = other->active_cell_index();
                n[c] > 0 && n[o] > 0 &&
                std::abs(mean[c] - mean[o]) >
                  criterion.above * cell->center().distance(other->center()))
              raise(levels[c], criterion.level);
      });
    }

    /**
     * The stresses of the points, averaged at the nodes with their shape
     * functions and interpolated back, are better than themselves (Zienkiewicz
     * & Zhu 1987). Cells may have as much of the error as others.
     */
    template <int dim>
    void
    raise_by_error(const CriterionSpec<dim> &criterion,
                   const GridState<dim>     &state,
                   std::vector<int>         &levels)
    {
      if (!state.has_stresses)
        return for_owned_cells<dim>(state, [&](const auto &cell) {
          raise(levels[cell->active_cell_index()], state.grid.level(cell));
        });
      const auto &points = state.points;
      const auto  field =
        find_field("cauchy_stress", CriterionSpec<dim>(), state);
      const auto discretization = state.grid.discretization();
      // Components of the tensor, then the weight, in vectors of `dim` each.
      constexpr unsigned int               weight = 9;
      std::array<Vector, weight / dim + 1> averages;
      for (auto &average : averages)
        discretization->initialize(average);
      const auto for_nodes = [&](const auto &particle, const auto &action) {
        const auto cell = particle.get_surrounding_cell();
        const auto nodes =
          discretization->nodes_of(discretization->with_dofs(cell));
        Point<dim> unit;
        for (unsigned int d = 0; d < dim; ++d)
          unit[d] = (particle.get_location()[d] - cell->vertex(0)[d]) /
                    cell_extent(cell, d);
        for (const auto v : cell->vertex_indices())
          action(nodes[v], GeometryInfo<dim>::d_linear_shape_function(unit, v));
      };
      const auto entry = [&](const unsigned int node,
                             const unsigned int c) -> double & {
        return averages[c / dim].local_element(dim * node + c % dim);
      };
      const auto volume = [&](const unsigned int p) {
        return points.initial_volume(p) *
               determinant(deformation_gradient(points, p));
      };
      std::vector<std::array<double, weight>> stresses(points.size());
      for_points(state, [&](const unsigned int p, const auto &particle) {
        field.evaluate(p, particle.get_location(), stresses[p].data());
        for_nodes(particle, [&](const unsigned int node, const double shape) {
          for (unsigned int c = 0; c < weight; ++c)
            entry(node, c) += volume(p) * shape * stresses[p][c];
          entry(node, weight) += volume(p) * shape;
        });
      });
      for (auto &average : averages)
        {
          average.compress(VectorOperation::add);
          discretization->condense_hanging(average);
        }
      const unsigned int n_nodes = averages[0].locally_owned_size() / dim;
      for (unsigned int node = 0; node < n_nodes; ++node)
        for (unsigned int c = 0; c < weight; ++c)
          if (entry(node, weight) > 0)
            entry(node, c) /= entry(node, weight);
      for (auto &average : averages)
        discretization->interpolate_hanging(average);

      std::vector<double> squares(levels.size());
      double              sums[3] = {}; // of errors, stresses, cells
      for_points(state, [&](const unsigned int p, const auto &particle) {
        std::array<double, weight> difference = stresses[p];
        for_nodes(particle, [&](const unsigned int node, const double shape) {
          for (unsigned int c = 0; c < weight; ++c)
            difference[c] -= shape * entry(node, c);
        });
        const double factor = volume(p) / points.material(p).stiffness();
        double      &square =
          squares[particle.get_surrounding_cell()->active_cell_index()];
        for (unsigned int c = 0; c < weight; ++c)
          {
            square += factor * difference[c] * difference[c];
            sums[0] += factor * difference[c] * difference[c];
            sums[1] += factor * stresses[p][c] * stresses[p][c];
          }
      });
      for (const double square : squares)
        sums[2] += square > 0;
      Utilities::MPI::sum(sums, state.grid.communicator, sums);
      const double permitted = criterion.tolerance * criterion.tolerance *
                               (sums[0] + sums[1]) / std::max(sums[2], 1.);
      for_owned_cells<dim>(state, [&](const auto &cell) {
        const auto   c     = cell->active_cell_index();
        const double ratio = std::sqrt(squares[c] / permitted);
        if (!(permitted > 0) || squares[c] == 0)
          return;
        // Cells twice as large have about four times as much.
        raise(levels[c],
              state.grid.level(cell) + (ratio > 1   ? 1 :
                                        ratio < 0.2 ? -1 :
                                                      0));
      });
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
          criterion.expression->set_time(state.time);
          for_owned_cells<dim>(state, [&](const auto &cell) {
            const double level = criterion.expression->value(cell->center());
            if (!std::isnan(level))
              raise(levels[cell->active_cell_index()],
                    static_cast<int>(std::floor(std::clamp(level, 0., 100.))));
          });
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
