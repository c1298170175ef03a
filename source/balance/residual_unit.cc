#include <impm/balance/residual_unit.h>

#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Stiffness times the size of a cell, Sulsky & Kaul's unit of forces. */
    template <int dim>
    double
    force_of_cell(const std::vector<BodySpec<dim>> &bodies,
                  const MaterialPoints<dim>        &points,
                  const Footprints<dim>            &footprints,
                  const Discretization<dim>        &discretization)
    {
      double stiffness = 0, volume = std::numeric_limits<double>::max();
      for (const auto &body : bodies)
        if (!body.rigid)
          stiffness = std::max(stiffness, body.material->stiffness());
      for (const auto &cell : footprints.cells)
        {
          double product = 1;
          for (unsigned int d = 0; d < dim; ++d)
            product *= cell_extent(cell.cell, d);
          volume = std::min(volume, product);
        }
      // The paper's forces around an axis are those of a radian.
      const bool axisymmetric =
        points.layout.geometry == GeometryKind::axisymmetric;
      return (axisymmetric ? 2 * numbers::PI : 1.) * stiffness *
             Utilities::MPI::min(volume, discretization.communicator);
    }
  } // namespace

  template <int dim>
  Vector
  forces_at_unit_strain(const MaterialPoints<dim> &points,
                        const Footprints<dim>     &footprints,
                        const Discretization<dim> &discretization)
  {
    Vector forces;
    discretization.initialize(forces);
    for (const auto &cell : footprints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        {
          const unsigned int p = footprints.point[e];
          const double force = footprints.weight[e] * points.initial_volume(p) *
                               points.material(p).stiffness() / cell.extent;
          for (const unsigned int node : cell.nodes)
            for (unsigned int c = 0; c < dim; ++c)
              forces.local_element(dim * node + c) += force;
        }
    forces.compress(VectorOperation::add);
    discretization.condense_hanging(forces);
    forces.update_ghost_values();
    return forces;
  }

  template <int dim>
  double
  residual_unit(const ResidualScale               scale,
                const Vector                     &unit_strain_forces,
                const double                      dt,
                const std::vector<BodySpec<dim>> &bodies,
                const MaterialPoints<dim>        &points,
                const Footprints<dim>            &footprints,
                const Discretization<dim>        &discretization)
  {
    switch (scale)
      {
        case ResidualScale::body:
          return unit_strain_forces.l2_norm();
        case ResidualScale::cell:
          return force_of_cell(bodies, points, footprints, discretization);
        default:
          return 1 / dt;
      }
  }

  template Vector
  forces_at_unit_strain(const MaterialPoints<2> &,
                        const Footprints<2> &,
                        const Discretization<2> &);
  template Vector
  forces_at_unit_strain(const MaterialPoints<3> &,
                        const Footprints<3> &,
                        const Discretization<3> &);
  template double
  residual_unit(ResidualScale,
                const Vector &,
                double,
                const std::vector<BodySpec<2>> &,
                const MaterialPoints<2> &,
                const Footprints<2> &,
                const Discretization<2> &);
  template double
  residual_unit(ResidualScale,
                const Vector &,
                double,
                const std::vector<BodySpec<3>> &,
                const MaterialPoints<3> &,
                const Footprints<3> &,
                const Discretization<3> &);
} // namespace impm
