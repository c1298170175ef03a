#ifndef impm_grid_cells_at_vertices_h
#define impm_grid_cells_at_vertices_h

#include <deal.II/grid/tria.h>

#include <utility>
#include <vector>

namespace impm
{
  /**
   * The active cells around every vertex, those with a hanging vertex on a face
   * or an edge of theirs included, in one list: a set for each vertex, as
   * deal.II has it, takes six times the memory. As long as the cells stay the
   * same.
   */
  template <int dim>
  class CellsAtVertices
  {
  public:
    using CellIterator =
      typename dealii::Triangulation<dim>::active_cell_iterator;

    explicit CellsAtVertices(const dealii::Triangulation<dim> &triangulation);

    /** Makes `cells` those that this rank knows around a cell, itself included,
     * by level and index. */
    void
    find_around(const CellIterator        &cell,
                std::vector<CellIterator> &cells) const;

  private:
    /** Calls take(vertex, cell) for all pairs; for some of hanging vertices
     * more than once. */
    template <typename Take>
    void
    for_all_pairs(const Take &take) const;

    const dealii::Triangulation<dim> &triangulation;
    /** Those of vertex v: cells[first[v]] to cells[first[v + 1]]. */
    std::vector<unsigned int>        first;
    std::vector<std::pair<int, int>> cells; ///< level and index
  };
} // namespace impm

#endif
