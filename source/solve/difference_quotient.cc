#include <impm/base/exceptions.h>
#include <impm/solve/difference_quotient.h>

#include <algorithm>

namespace impm
{
  double
  DifferenceQuotient::norm(Vector increment) const
  {
    if (const Vector *weight = system.weight_of_unknowns())
      increment.scale(*weight);
    return increment.l2_norm();
  }

  void
  DifferenceQuotient::linearize_at(const Vector &now)
  {
    u        = now;
    residual = system.residual();
  }

  void
  DifferenceQuotient::vmult_lift(Vector &dst, const Vector &src)
  {
    ++system.counts->operator_applications;
    direction = src;
    system.interpolate_hanging(direction);
    const double length = norm(direction);
    if (length == 0)
      {
        dst = 0;
        return;
      }
    // By no more than that part of a cell: nodes with next to no mass may go
    // far and count for little in the norm.
    const double most =
      system.length_scale() * length / direction.linfty_norm();
    const double size    = norm(u);
    const double epsilon = step * (size > 0 ? std::min(size, most) : most);
    direction.sadd(epsilon / length, 1., u);
    if (!system.evaluate(direction, false).admissible)
      throw LinearizationError(
        "the difference quotient turns a point inside out");
    dst = system.residual();
    dst -= residual;
    dst *= length / epsilon;
  }

  void
  DifferenceQuotient::vmult(Vector &dst, const Vector &src)
  {
    dst = src;
    system.set_zero(dst);
    vmult_lift(dst, dst);
    for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
      if (system.is_constrained(i))
        dst.local_element(i) = src.local_element(i);
  }
} // namespace impm
