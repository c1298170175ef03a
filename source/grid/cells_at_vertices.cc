#include <impm/grid/cells_at_vertices.h>

#include <algorithm>
#include <numeric>

namespace impm
{
  using namespace dealii;

  template <int dim>
  CellsAtVertices<dim>::CellsAtVertices(const Triangulation<dim> &triangulation)
    : triangulation(triangulation)
    , first(triangulation.n_vertices() + 1)
  {
    for_all_pairs([&](const unsigned int vertex, const CellIterator &) {
      ++first[vertex + 1];
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    cells.resize(first.back());
    auto next = first;
    for_all_pairs([&](const unsigned int vertex, const CellIterator &cell) {
      cells[next[vertex]++] = {cell->level(), cell->index()};
    });
  }

  template <int dim>
  template <typename Take>
  void
  CellsAtVertices<dim>::for_all_pairs(const Take &take) const
  {
    const bool any_hangs =
      triangulation.Triangulation<dim>::has_hanging_nodes();
    for (const auto &cell : triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        {
          for (const unsigned int v : cell->vertex_indices())
            take(cell->vertex_index(v), cell);
          if (!any_hangs)
            continue;
          // On a face of a coarser cell, and in the middle of an edge.
          for (const unsigned int f : cell->face_indices())
            if (!cell->at_boundary(f) && cell->neighbor(f)->is_active() &&
                !cell->neighbor(f)->is_artificial())
              for (const unsigned int v : cell->face(f)->vertex_indices())
                take(cell->face(f)->vertex_index(v), cell->neighbor(f));
          if (dim == 3)
            for (unsigned int l = 0; l < cell->n_lines(); ++l)
              if (cell->line(l)->has_children())
                take(cell->line(l)->child(0)->vertex_index(1), cell);
        }
  }

  template <int dim>
  void
  CellsAtVertices<dim>::find_around(const CellIterator        &cell,
                                    std::vector<CellIterator> &around) const
  {
    around.clear();
    for (const unsigned int v : cell->vertex_indices())
      for (unsigned int i = first[cell->vertex_index(v)];
           i < first[cell->vertex_index(v) + 1];
           ++i)
        around.emplace_back(&triangulation, cells[i].first, cells[i].second);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
  }

  template class CellsAtVertices<2>;
  template class CellsAtVertices<3>;
} // namespace impm
