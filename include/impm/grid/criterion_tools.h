#ifndef impm_grid_criterion_tools_h
#define impm_grid_criterion_tools_h

#include <impm/grid/criteria.h>

#include <algorithm>
#include <functional>
#include <vector>

// What criteria are made of.
namespace impm
{
  template <int dim>
  using ActiveCell = typename dealii::Triangulation<dim>::active_cell_iterator;

  template <int dim>
  void
  for_owned_cells(const GridState<dim>                               &state,
                  const std::function<void(const ActiveCell<dim> &)> &action)
  {
    for (const auto &cell : state.grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        action(cell);
  }

  inline void
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

  // Those of fields of the points, in field_criteria.cc: see raise_levels().

  template <int dim>
  void
  raise_by_size(const CriterionSpec<dim> &criterion,
                const GridState<dim>     &state,
                std::vector<int>         &levels);

  template <int dim>
  void
  raise_by_gradient(const CriterionSpec<dim> &criterion,
                    const GridState<dim>     &state,
                    std::vector<int>         &levels);

  /**
   * The stresses of the points, averaged at the nodes with their shape
   * functions and interpolated back, are better than themselves (Zienkiewicz
   * & Zhu 1987). Cells may have as much of the error as others.
   */
  template <int dim>
  void
  raise_by_error(const CriterionSpec<dim> &criterion,
                 const GridState<dim>     &state,
                 std::vector<int>         &levels);
} // namespace impm

#endif
