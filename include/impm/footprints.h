#ifndef impm_footprints_h
#define impm_footprints_h

#include <impm/background_grid.h>
#include <impm/material_points.h>

#include <array>
#include <vector>

namespace impm
{
  /**
   * Where each point touches the grid in this step: entries of (point, values
   * and gradients of the shape functions of one cell), sorted by cell and
   * stored as structure-of-arrays. A point of plain MPM has one entry. What
   * follows never asks where the entries come from.
   */
  template <int dim>
  class Footprints
  {
  public:
    static constexpr unsigned int n_nodes = 1u << dim; ///< of a cell

    struct Cell
    {
      typename BackgroundGrid<dim>::CellIterator cell;
      std::array<unsigned int, n_nodes>          nodes;
      unsigned int                               begin, end; ///< its entries
      double                                     extent;     ///< smallest (m)
    };

    void
    build(const MaterialPoints<dim> &points, const BackgroundGrid<dim> &grid);

    const double *
    value(const unsigned int entry) const
    {
      return &values[entry * n_nodes];
    }

    /** d N_node / d x_d at [node * dim + d] (1/m). */
    const double *
    gradient(const unsigned int entry) const
    {
      return &gradients[entry * n_nodes * dim];
    }

    std::vector<Cell>         cells; ///< those that points touch
    std::vector<unsigned int> point; ///< of every entry
    /** 1/r of every point, if axisymmetric (1/m). */
    std::vector<double> inverse_radius;

  private:
    std::vector<double> values, gradients;
  };
} // namespace impm

#endif
