#include <impm/solve/bfgs.h>

namespace impm
{
  void
  Bfgs::add(const Vector &change, const Vector &residual_change)
  {
    const double product = change * residual_change;
    if (product > 1e-10 * change.l2_norm() * residual_change.l2_norm())
      pairs.push_back({change, residual_change, product});
  }

  void
  Bfgs::apply(Vector &dst, const Vector &src, const LinearMap &inverse) const
  {
    Vector              work = src;
    std::vector<double> factors(pairs.size());
    for (unsigned int i = pairs.size(); i-- > 0;)
      {
        const auto &pair = pairs[i];
        factors[i]       = (pair.change * work) / pair.product;
        work.add(-factors[i], pair.residual_change);
      }
    inverse.vmult(dst, work);
    for (unsigned int i = 0; i < pairs.size(); ++i)
      {
        const auto  &pair = pairs[i];
        const double seen = (pair.residual_change * dst) / pair.product;
        dst.add(factors[i] - seen, pair.change);
      }
  }
} // namespace impm
