#include <impm/base/exceptions.h>
#include <impm/solve/difference_quotient.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  DifferenceQuotient<dim>::DifferenceQuotient(MomentumBalance<dim> &balance,
                                              const double          step)
    : balance(balance)
    , step(step)
  {
    for (Vector *vector : {&u, &residual, &direction})
      balance.grid.initialize(*vector);
  }

  template <int dim>
  double
  DifferenceQuotient<dim>::norm(const Vector &increment) const
  {
    if (!balance.in_momentum())
      return increment.l2_norm();
    double squares = 0;
    for (unsigned int i = 0; i < increment.locally_owned_size(); ++i)
      squares +=
        std::pow(balance.mass.local_element(i) * increment.local_element(i), 2);
    return std::sqrt(Utilities::MPI::sum(squares, balance.grid.communicator));
  }

  template <int dim>
  void
  DifferenceQuotient<dim>::linearize_at(const Vector &now)
  {
    u        = now;
    residual = balance.residual();
  }

  template <int dim>
  void
  DifferenceQuotient<dim>::vmult_lift(Vector &dst, const Vector &src)
  {
    ++balance.n_operator_applications;
    direction = src;
    balance.constraints.interpolate_hanging(direction);
    const double length = norm(direction);
    if (length == 0)
      {
        dst = 0;
        return;
      }
    const double size = norm(u);
    const double epsilon =
      step * (size > 0 ? size :
                         balance.grid.smallest_cell_extent() * length /
                           direction.linfty_norm());
    direction.sadd(epsilon / length, 1., u);
    if (!balance.evaluate(direction, false).admissible)
      throw LinearizationError(
        "the difference quotient turns a point inside out");
    dst = balance.residual();
    dst -= residual;
    dst *= length / epsilon;
  }

  template <int dim>
  void
  DifferenceQuotient<dim>::vmult(Vector &dst, const Vector &src)
  {
    dst = src;
    balance.constraints.set_zero(dst);
    vmult_lift(dst, dst);
    for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
      if (balance.constraints.is_constrained[i])
        dst.local_element(i) = src.local_element(i);
  }

  template class DifferenceQuotient<2>;
  template class DifferenceQuotient<3>;
} // namespace impm
