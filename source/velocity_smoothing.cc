#include <impm/velocity_smoothing.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  VelocitySmoothing<dim>::VelocitySmoothing(
    const MaterialPoints<dim>  &points,
    const Footprints<dim>      &footprints,
    const StepConstraints<dim> &constraints,
    const BackgroundGrid<dim>  &grid)
    : points(points)
    , footprints(footprints)
    , constraints(constraints)
    , grid(grid)
  {
    grid.initialize(inverse_mass);
    grid.initialize(change);
  }

  template <int dim>
  void
  VelocitySmoothing<dim>::begin_step(const Vector &mass)
  {
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      {
        const double m                = mass.local_element(i);
        inverse_mass.local_element(i) = m > 0 ? 1 / m : 0.;
      }
  }

  template <int dim>
  void
  VelocitySmoothing<dim>::apply_derivative(const Vector &u,
                                           Vector       &result) const
  {
    change = u;
    constraints.interpolate_hanging(change);
    footprints.interpolate(change, at_points);
    for (unsigned int p = 0; p < points.size(); ++p)
      at_points[p] *= points.mass(p);
    change = 0;
    footprints.spread(at_points, change);
    change.compress(VectorOperation::add);
    constraints.condense_hanging(change);
    for (unsigned int i = 0; i < result.locally_owned_size(); ++i)
      result.local_element(i) =
        constraints.is_constrained[i] ?
          u.local_element(i) :
          inverse_mass.local_element(i) * change.local_element(i);
    constraints.interpolate_hanging(result);
  }

  template <int dim>
  void
  VelocitySmoothing<dim>::apply(const Vector &u,
                                const Vector &start,
                                Vector       &result) const
  {
    result = u;
    result -= start;
    apply_derivative(result, result);
    for (unsigned int i = 0; i < result.locally_owned_size(); ++i)
      result.local_element(i) =
        constraints.is_constrained[i] ?
          u.local_element(i) :
          result.local_element(i) + start.local_element(i);
    constraints.interpolate_hanging(result);
  }

  template class VelocitySmoothing<2>;
  template class VelocitySmoothing<3>;
} // namespace impm
