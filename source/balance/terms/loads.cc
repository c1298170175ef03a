#include <impm/balance/terms/face_traction.h>
#include <impm/balance/terms/loads.h>
#include <impm/balance/terms/point_traction.h>

namespace impm
{
  using namespace dealii;

  double
  Loads::energy(const Vector &u) const
  {
    double sum = 0;
    for (unsigned int i = 0; i < at_end.locally_owned_size(); ++i)
      sum += at_end.local_element(i) * u.local_element(i);
    return sum;
  }

  namespace
  {
    template <int dim>
    void
    add_body_force(const LoadsSpec<dim>      &spec,
                   const MaterialPoints<dim> &points,
                   const Footprints<dim>     &footprints,
                   const double               instant,
                   Vector                    &load)
    {
      spec.body_force->set_time(instant);
      dealii::Vector<double>      value(dim);
      std::vector<Tensor<1, dim>> forces(points.size());
      unsigned int                p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          spec.body_force->vector_value(spec.body_force_is_initial ?
                                          points.initial_position(p) :
                                          particle.get_location(),
                                        value);
          for (unsigned int c = 0; c < dim; ++c)
            forces[p][c] = -points.mass(p) * value[c];
          ++p;
        }
      footprints.spread(forces, load);
    }
  } // namespace

  template <int dim>
  Vector
  gather_loads(const LoadsSpec<dim>      &spec,
               const Faces<dim>          &faces,
               const MaterialPoints<dim> &points,
               const Footprints<dim>     &footprints,
               const BackgroundGrid<dim> &grid,
               const Discretization<dim> &discretization,
               const PopulatedCells<dim> &populated,
               const double               instant)
  {
    Vector load;
    discretization.initialize(load);
    if (spec.body_force)
      add_body_force(spec, points, footprints, instant, load);
    add_point_tractions(spec.tractions, points, footprints, instant, -1., load);
    if (grid.is_lagrangian)
      add_face_tractions(
        faces, points.layout.geometry, grid, populated, instant, -1., load);
    load.compress(VectorOperation::add);
    discretization.condense_hanging(load);
    return load;
  }

  template Vector
  gather_loads(const LoadsSpec<2> &,
               const Faces<2> &,
               const MaterialPoints<2> &,
               const Footprints<2> &,
               const BackgroundGrid<2> &,
               const Discretization<2> &,
               const PopulatedCells<2> &,
               double);
  template Vector
  gather_loads(const LoadsSpec<3> &,
               const Faces<3> &,
               const MaterialPoints<3> &,
               const Footprints<3> &,
               const BackgroundGrid<3> &,
               const Discretization<3> &,
               const PopulatedCells<3> &,
               double);
} // namespace impm
