#include <impm/base/exceptions.h>
#include <impm/grid/criterion_tools.h>
#include <impm/grid/populated_cells.h>
#include <impm/points/point_fields.h>

#include <array>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
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
  } // namespace

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
    const auto field = find_field("cauchy_stress", CriterionSpec<dim>(), state);
    const auto discretization = state.grid.discretization();
    // Components of the tensor, then the weight, in vectors of `dim` each.
    constexpr unsigned int               weight = 9;
    std::array<Vector, weight / dim + 1> averages;
    for (auto &average : averages)
      discretization->initialize(average);
    const auto for_nodes =
      [&](const unsigned int p, const auto &particle, const auto &action) {
        const auto cell = particle.get_surrounding_cell();
        const auto nodes =
          discretization->nodes_of(discretization->with_dofs(cell),
                                   points.layer(p));
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
      for_nodes(p, particle, [&](const unsigned int node, const double shape) {
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
      for_nodes(p, particle, [&](const unsigned int node, const double shape) {
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

  template void
  raise_by_size(const CriterionSpec<2> &,
                const GridState<2> &,
                std::vector<int> &);
  template void
  raise_by_size(const CriterionSpec<3> &,
                const GridState<3> &,
                std::vector<int> &);
  template void
  raise_by_gradient(const CriterionSpec<2> &,
                    const GridState<2> &,
                    std::vector<int> &);
  template void
  raise_by_gradient(const CriterionSpec<3> &,
                    const GridState<3> &,
                    std::vector<int> &);
  template void
  raise_by_error(const CriterionSpec<2> &,
                 const GridState<2> &,
                 std::vector<int> &);
  template void
  raise_by_error(const CriterionSpec<3> &,
                 const GridState<3> &,
                 std::vector<int> &);
} // namespace impm
