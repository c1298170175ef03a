#include <deal.II/lac/vector.h>

#include <impm/base/exceptions.h>
#include <impm/grid/grips.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Tensor<1, dim>
    value_at(const GripSpec<dim> &grip,
             const Point<dim>    &place,
             const double         time)
    {
      dealii::Vector<double> value(dim);
      grip.value->set_time(time);
      grip.value->vector_value(place, value);
      return Tensor<1, dim>(make_array_view(value));
    }

    /** The place X at the start of the run that a displacement d(X) has brought
     * to x. */
    template <int dim>
    std::optional<Point<dim>>
    place_at_start(const GripSpec<dim> &grip,
                   const Point<dim>    &x,
                   const double         time)
    {
      const auto image = [&](const Point<dim> &X) {
        return X + value_at(grip, X, time);
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
      if (!(gap <= 1e-8 * (x.norm() + X.distance(x))))
        return std::nullopt;
      return X;
    }
  } // namespace

  template <int dim>
  Cells<dim>
  gripped_cells(const GripSpec<dim> &grip, const MaterialPoints<dim> &points)
  {
    Cells<dim>   cells;
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        // points of one cell come one after the other
        const auto cell    = particle.get_surrounding_cell();
        const bool is_held = points.body(p) == grip.body &&
                             (cells.empty() || cells.back() != cell) &&
                             grip.where->value(points.initial_position(p)) > 0;
        if (is_held)
          cells.push_back(cell);
        ++p;
      }
    return cells;
  }

  template <int dim>
  std::optional<Tensor<1, dim>>
  grip_motion(const GripSpec<dim> &grip,
              const Point<dim>    &place,
              const double         time,
              const double         dt)
  {
    if (grip.is_velocity)
      return dt * value_at(grip, place, time + dt / 2);
    const auto X =
      grip.varies ? place_at_start(grip, place, time) : std::optional(place);
    if (!X)
      return std::nullopt;
    return value_at(grip, *X, time + dt) - value_at(grip, *X, time);
  }

  template <int dim>
  void
  check_grips(const std::vector<GripSpec<dim>> &grips,
              const MaterialPoints<dim>        &points)
  {
    for (const auto &grip : grips)
      {
        const unsigned int n = gripped_cells(grip, points).size();
        if (Utilities::MPI::sum(n, points.communicator) == 0)
          throw InputError("Boundary conditions/" + grip.name + "/Where",
                           "found no point of body '" + grip.body_name +
                             "' where the expression is positive");
      }
  }

  template decltype(gripped_cells<2>) gripped_cells<2>;
  template decltype(gripped_cells<3>) gripped_cells<3>;
  template decltype(grip_motion<2>)   grip_motion<2>;
  template decltype(grip_motion<3>)   grip_motion<3>;
  template decltype(check_grips<2>)   check_grips<2>;
  template decltype(check_grips<3>)   check_grips<3>;
} // namespace impm
