#include <impm/study/curve.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  void
  WeightedNorm::add(const double weight, const double size)
  {
    // The largest of anything and not-a-number is anything.
    if (!std::isfinite(size))
      ++n_not_finite;
    weights += weight;
    sum += weight * (norm == Norm::L2 ? size * size : std::abs(size));
    largest = std::max(largest, std::abs(size));
  }

  double
  WeightedNorm::value(const MPI_Comm communicator) const
  {
    namespace MPI      = dealii::Utilities::MPI;
    const double total = MPI::sum(weights, communicator);
    const double all   = MPI::sum(sum, communicator);
    const double most  = MPI::max(largest, communicator);
    if (MPI::sum(n_not_finite, communicator) > 0 || total == 0)
      return std::numeric_limits<double>::quiet_NaN();
    switch (norm)
      {
        case Norm::L1:
          return all / total;
        case Norm::L2:
          return std::sqrt(all / total);
        default:
          return most;
      }
  }

  bool
  Curve::contains(const double at) const
  {
    if (x.empty())
      return false;
    const double slack =
      1e-9 * std::max(x.back() - x.front(), std::abs(x.back()));
    return at >= x.front() - slack && at <= x.back() + slack;
  }

  double
  Curve::value(const double at) const
  {
    if (!contains(at))
      return std::numeric_limits<double>::quiet_NaN();
    const auto right = std::upper_bound(x.begin(), x.end(), at) - x.begin();
    if (right == 0)
      return y.front();
    if (right == static_cast<long>(x.size()))
      return y.back();
    const double weight = (at - x[right - 1]) / (x[right] - x[right - 1]);
    return (1 - weight) * y[right - 1] + weight * y[right];
  }

  std::optional<Curve>
  make_curve(std::vector<double> x, std::vector<double> y)
  {
    if (std::is_sorted(x.rbegin(), x.rend()))
      {
        std::reverse(x.begin(), x.end());
        std::reverse(y.begin(), y.end());
      }
    if (x.size() != y.size() || !std::is_sorted(x.begin(), x.end()))
      return std::nullopt;
    return Curve{std::move(x), std::move(y)};
  }

  std::optional<CurveNorms>
  compare_curves(const Curve                         &curve,
                 const std::function<double(double)> &reference,
                 const std::vector<double>           &abscissas,
                 const Norm                           norm)
  {
    std::vector<double> at;
    std::copy_if(abscissas.begin(),
                 abscissas.end(),
                 std::back_inserter(at),
                 [&](const double x) { return curve.contains(x); });
    if (at.empty())
      return std::nullopt;

    WeightedNorm values(norm), references(norm), errors(norm);
    CurveNorms   norms;
    for (unsigned int i = 0; i < at.size(); ++i)
      {
        const double left = i > 0 ? at[i - 1] : at[i];
        double weight = 0.5 * ((i + 1 < at.size() ? at[i + 1] : at[i]) - left);
        if (at.back() == at.front())
          weight = 1;
        norms.last_value     = curve.value(at[i]);
        norms.last_reference = reference(at[i]);
        values.add(weight, norms.last_value);
        references.add(weight, norms.last_reference);
        errors.add(weight, norms.last_value - norms.last_reference);
      }
    norms.value     = values.value(MPI_COMM_SELF);
    norms.reference = references.value(MPI_COMM_SELF);
    norms.error     = errors.value(MPI_COMM_SELF);
    return norms;
  }
} // namespace impm
