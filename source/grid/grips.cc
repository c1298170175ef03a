#include <deal.II/lac/vector.h>

#include <impm/base/exceptions.h>
#include <impm/grid/grips.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Calls `take` with the particles that a grip holds. */
    template <int dim, typename Take>
    void
    for_each_gripped(const GripSpec<dim>       &grip,
                     const MaterialPoints<dim> &points,
                     const Take                &take)
    {
      unsigned int next = 0;
      for (const auto &particle : points.sorted.particles)
        if (const unsigned int p = next++;
            points.body(p) == grip.body &&
            grip.where->value(points.initial_position(p)) > 0)
          take(particle, p);
    }

    /** The place X at the start of the run that a displacement d(X) has brought
     * to x. */
    template <int dim>
    Point<dim>
    place_at_start(const GripSpec<dim> &grip,
                   const Point<dim>    &x,
                   const double         time)
    {
      auto &displacement = *grip.value;
      displacement.set_time(time);
      dealii::Vector<double> value(dim);
      const auto             image = [&](const Point<dim> &X) {
        displacement.vector_value(X, value);
        Point<dim> result = X;
        for (unsigned int d = 0; d < dim; ++d)
          result[d] += value[d];
        return result;
      };
      // Newton's method with quotients of differences. Halved steps, since the
      // guess may be half a turn off.
      Point<dim>   X    = x;
      double       gap  = image(X).distance(x);
      const double step = 1e-6 * (gap + 1e-6 * x.norm());
      for (unsigned int i = 0; i < 100 && gap > 1e-12 * (x.norm() + gap); ++i)
        {
          Tensor<2, dim> gradient;
          const auto     before = image(X);
          for (unsigned int d = 0; d < dim; ++d)
            {
              Point<dim> beside = X;
              beside[d] += step;
              const auto change = (image(beside) - before) / step;
              for (unsigned int c = 0; c < dim; ++c)
                gradient[c][d] = change[c];
            }
          if (determinant(gradient) == 0)
            break;
          const auto way    = invert(gradient) * (x - before);
          double     part   = 1;
          Point<dim> next   = X + way;
          double     closer = image(next).distance(x);
          while (!(closer < gap) && part > 1e-3)
            {
              part /= 2;
              next   = X + part * way;
              closer = image(next).distance(x);
            }
          if (!(closer < gap))
            break;
          X   = next;
          gap = closer;
        }
      if (!(gap < 1e-8 * (x.norm() + X.distance(x))))
        throw ComputationError(
          "at t = " + std::to_string(time) + " s: grip '" + grip.name +
          "' has no place at the start whose displacement leads to where it "
          "holds a node: a displacement must be one to one, also a cell "
          "around what it grips");
      return X;
    }
  } // namespace

  template <int dim>
  void
  hold_by_grip(const GripSpec<dim>       &grip,
               const MaterialPoints<dim> &points,
               const Discretization<dim> &discretization,
               const double               number,
               Vector                    &values)
  {
    const auto &hanging_nodes = discretization.numbering->hanging_nodes;
    typename Triangulation<dim>::active_cell_iterator last;
    for_each_gripped(grip, points, [&](const auto &particle, const auto p) {
      // points of one cell come one after the other
      const auto surrounding = particle.get_surrounding_cell();
      if (surrounding == last)
        return;
      last             = surrounding;
      const auto cell  = discretization.with_dofs(surrounding);
      const auto layer = points.layer(p);
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int c = 0; c < dim; ++c)
          if (grip.constrained[c])
            {
              const auto dof = cell->vertex_dof_index(v, dim * layer + c);
              values(dof)    = number;
              // A hanging node is held by holding its masters.
              if (hanging_nodes.is_constrained(dof))
                for (const auto &entry :
                     *hanging_nodes.get_constraint_entries(dof))
                  values(entry.first) = number;
            }
    });
  }

  template <int dim>
  double
  grip_motion(const GripSpec<dim> &grip,
              const Point<dim>    &place,
              const unsigned int   component,
              const double         time,
              const double         dt)
  {
    auto &value = *grip.value;
    if (grip.is_velocity)
      {
        value.set_time(time + dt / 2);
        return dt * value.value(place, component);
      }
    const auto X = grip.varies ? place_at_start(grip, place, time) : place;
    value.set_time(time);
    const double before = value.value(X, component);
    value.set_time(time + dt);
    return value.value(X, component) - before;
  }

  template <int dim>
  void
  check_grips(const std::vector<GripSpec<dim>> &grips,
              const MaterialPoints<dim>        &points)
  {
    for (const auto &grip : grips)
      {
        unsigned int n = 0;
        for_each_gripped(grip, points, [&](const auto &, const auto) { ++n; });
        if (Utilities::MPI::sum(n, points.communicator) == 0)
          throw InputError("Boundary conditions/" + grip.name + "/Where",
                           "found no point of body '" + grip.body_name +
                             "' where the expression is positive");
      }
  }

  template decltype(hold_by_grip<2>) hold_by_grip<2>;
  template decltype(hold_by_grip<3>) hold_by_grip<3>;
  template decltype(grip_motion<2>)  grip_motion<2>;
  template decltype(grip_motion<3>)  grip_motion<3>;
  template decltype(check_grips<2>)  check_grips<2>;
  template decltype(check_grips<3>)  check_grips<3>;
} // namespace impm
