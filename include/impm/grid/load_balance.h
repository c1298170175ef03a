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

  private:
    using CellIterator = typename dealii::Triangulation<dim>::cell_iterator;

    /** Of a cell, or of the children that it has. */
    unsigned int
    cost(const CellIterator &cell) const;

    const BackgroundGrid<dim>         &grid;
    const MaterialPoints<dim>         &points;
    boost::signals2::scoped_connection connection;
  };
} // namespace impm

#endif
