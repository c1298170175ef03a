#include <impm/footprints.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  Footprints<dim>::build(const MaterialPoints<dim> &points,
                         const BackgroundGrid<dim> &grid)
  {
    cells.clear();
    point.clear();
    const unsigned int n_points = points.size();
    values.resize(n_points * n_nodes);
    gradients.resize(n_points * n_nodes * dim);
    const bool axisymmetric =
      points.layout.geometry == GeometryKind::axisymmetric;
    inverse_radius.resize(axisymmetric ? n_points : 0);

    std::array<double, dim>                    extents{};
    unsigned int                               p = 0;
    typename Triangulation<dim>::cell_iterator current;
    for (const auto &particle : points.sorted.particles)
      {
        const auto cell = particle.get_surrounding_cell();
        if (p == 0 || cell != current)
          {
            current = cell;
            const typename BackgroundGrid<dim>::CellIterator dof_cell(
              &grid.triangulation,
              cell->level(),
              cell->index(),
              &grid.dof_handler);
            for (unsigned int d = 0; d < dim; ++d)
              extents[d] = cell->extent_in_direction(d);
            cells.push_back(
              {dof_cell,
               grid.nodes_of(dof_cell),
               p,
               p,
               *std::min_element(extents.begin(), extents.end())});
          }
        cells.back().end = p + 1;
        point.push_back(p);

        const auto &xi = particle.get_reference_location();
        for (unsigned int v = 0; v < n_nodes; ++v)
          {
            double                  value = 1;
            std::array<double, dim> factor;
            for (unsigned int d = 0; d < dim; ++d)
              {
                factor[d] = (v >> d & 1u) ? xi[d] : 1 - xi[d];
                value *= factor[d];
              }
            values[p * n_nodes + v] = value;
            for (unsigned int d = 0; d < dim; ++d)
              {
                double slope = ((v >> d & 1u) ? 1 : -1) / extents[d];
                for (unsigned int e = 0; e < dim; ++e)
                  if (e != d)
                    slope *= factor[e];
                gradients[(p * n_nodes + v) * dim + d] = slope;
              }
          }
        if (axisymmetric)
          inverse_radius[p] = 1 / particle.get_location()[0];
        ++p;
      }
  }

  template class Footprints<2>;
  template class Footprints<3>;
} // namespace impm
