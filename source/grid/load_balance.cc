#include <impm/grid/load_balance.h>

#include <algorithm>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    // From run times: see doc/adaptive_grids.md.
    constexpr unsigned int empty_cell = 50, populated_cell = 1000, point = 40;
  } // namespace

  template <int dim>
  LoadBalance<dim>::LoadBalance(const BackgroundGrid<dim> &grid,
                                const MaterialPoints<dim> &points)
    : grid(grid)
    , points(points)
    , connection(grid.triangulation.signals.weight.connect(
        [this](const CellIterator &cell, const auto) {
          return imposed.empty() ? cost(cell) : imposed_cost();
        }))
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
  std::vector<unsigned int>
  LoadBalance<dim>::shares() const
  {
    return Utilities::MPI::all_gather(
      grid.communicator, grid.triangulation.n_locally_owned_active_cells());
  }

  template <int dim>
  void
  LoadBalance<dim>::impose(const std::vector<unsigned int> &shares)
  {
    const auto rank = Utilities::MPI::this_mpi_process(grid.communicator);
    const auto now  = this->shares();
    const bool fits = shares.size() == now.size() &&
                      std::count(shares.begin(), shares.end(), 0u) == 0 &&
                      std::accumulate(shares.begin(), shares.end(), 0u) ==
                        std::accumulate(now.begin(), now.end(), 0u);
    imposed   = fits ? shares : std::vector<unsigned int>();
    next_cell = std::accumulate(now.begin(), now.begin() + rank, 0u);
  }

  template <int dim>
  unsigned int
  LoadBalance<dim>::imposed_cost()
  {
    // The first and the last cell of each rank have all of its weight, so that
    // ranks change just where the sum passes what one of them gets.
    const unsigned int half = 1000, cell = next_cell++;
    unsigned int       weight = 0, begin = 0;
    for (const unsigned int n : imposed)
      {
        weight +=
          (cell == begin ? half : 0) + (cell + 1 == begin + n ? half : 0);
        begin += n;
      }
    return weight;
  }

  template <int dim>
  double
  LoadBalance<dim>::imbalance() const
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator) == 1)
      return 1;
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
