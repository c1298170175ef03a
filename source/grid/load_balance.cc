#include <impm/grid/load_balance.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    // Measured in seconds of a step by phase, in parts of an empty cell: blocks
    // of 40,000 points in the plane and 64,000 in space, GIMP, CG with AMG.
    constexpr unsigned int empty_cell = 50, populated_cell = 1000, point = 200;
  } // namespace

  template <int dim>
  LoadBalance<dim>::LoadBalance(const BackgroundGrid<dim> &grid,
                                const MaterialPoints<dim> &points)
    : grid(grid)
    , points(points)
    , connection(grid.triangulation.signals.weight.connect(
        [this](const CellIterator &cell, const auto) { return cost(cell); }))
  {}

  template <int dim>
  unsigned int
  LoadBalance<dim>::cost(const CellIterator &cell) const
  {
    if (cell->is_active())
      {
        const unsigned int n =
          points.sorted.particles.n_particles_in_cell(cell);
        return empty_cell + (n > 0 ? populated_cell + n * point : 0);
      }
    unsigned int sum = 0;
    for (const auto &child : cell->child_iterators())
      sum += cost(child);
    return sum;
  }

  template <int dim>
  double
  LoadBalance<dim>::imbalance() const
  {
    double sum = 0;
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        sum += cost(cell);
    const auto costs = Utilities::MPI::min_max_avg(sum, grid.communicator);
    return costs.max / costs.avg;
  }

  template class LoadBalance<2>;
  template class LoadBalance<3>;
} // namespace impm
