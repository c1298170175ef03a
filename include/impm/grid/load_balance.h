#ifndef impm_grid_load_balance_h
#define impm_grid_load_balance_h

#include <impm/points/material_points.h>

#include <boost/signals2/connection.hpp>

namespace impm
{
  /**
   * What cells cost, for as long as it lives: whenever cells are sent to other
   * ranks, each gets its share of the cost.
   */
  template <int dim>
  class LoadBalance
  {
  public:
    LoadBalance(const BackgroundGrid<dim> &grid,
                const MaterialPoints<dim> &points);

    /** Cost of the busiest rank over the mean. Collective. */
    double
    imbalance() const;

    /** Number of cells of each rank. Collective. */
    std::vector<unsigned int>
    shares() const;

    /** From now on ranks get these numbers of cells in the order in which p4est
     * keeps them, if each gets some; as they cost if empty. Collective. */
    void
    impose(const std::vector<unsigned int> &shares);

  private:
    using CellIterator = typename dealii::Triangulation<dim>::cell_iterator;

    /** Of a cell, or of the children that it has. */
    unsigned int
    cost(const CellIterator &cell) const;

    /** Of the next cell, in the order of p4est, when shares are imposed. */
    unsigned int
    imposed_cost();

    const BackgroundGrid<dim>         &grid;
    const MaterialPoints<dim>         &points;
    std::vector<unsigned int>          imposed;
    unsigned int                       next_cell = 0;
    boost::signals2::scoped_connection connection;
  };
} // namespace impm

#endif
