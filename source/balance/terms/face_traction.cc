#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <impm/balance/terms/face_traction.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  add_face_tractions(const Faces<dim>          &faces,
                     const GeometryKind         geometry,
                     const BackgroundGrid<dim> &grid,
                     const PopulatedCells<dim> &populated,
                     const double               instant,
                     const double               factor,
                     Vector                    &force)
  {
    const FE_Q<dim>        fe(1);
    FEFaceValues<dim>      values(*grid.mapping,
                             fe,
                             QGauss<dim - 1>(3),
                             update_values | update_quadrature_points |
                               update_JxW_values);
    dealii::Vector<double> traction(dim);
    for (const auto &[cell, nodes] : populated.cells)
      if (cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          {
            if (!cell->face(f)->at_boundary())
              continue;
            const auto &spec = faces[cell->face(f)->boundary_id()];
            if (!spec.traction)
              continue;
            spec.traction->set_time(instant);
            values.reinit(
              typename Triangulation<dim>::active_cell_iterator(cell), f);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const auto &x = values.quadrature_point(q);
                spec.traction->vector_value(x, traction);
                const double around = geometry == GeometryKind::axisymmetric ?
                                        2 * numbers::PI * x[0] :
                                        1.;
                for (unsigned int v = 0; v < nodes.size(); ++v)
                  for (unsigned int c = 0; c < dim; ++c)
                    force.local_element(dim * nodes[v] + c) +=
                      factor * around * values.JxW(q) *
                      values.shape_value(v, q) * traction[c];
              }
          }
  }

  template void
  add_face_tractions(const Faces<2> &,
                     GeometryKind,
                     const BackgroundGrid<2> &,
                     const PopulatedCells<2> &,
                     double,
                     double,
                     Vector &);
  template void
  add_face_tractions(const Faces<3> &,
                     GeometryKind,
                     const BackgroundGrid<3> &,
                     const PopulatedCells<3> &,
                     double,
                     double,
                     Vector &);
} // namespace impm
