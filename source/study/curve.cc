#include <impm/study/curve.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  void
  WeightedNorm::add(const double weight, const double size)
  {
    weights += weight;
    sum += weight * (norm == Norm::L2 ? size * size : std::abs(size));
    largest = std::max(largest, std::abs(size));
  }

  double
  WeightedNorm::value(const MPI_Comm communicator) const
  {
    namespace MPI = dealii::Utilities::MPI;
    const double mean =
      MPI::sum(sum, communicator) / MPI::sum(weights, communicator);
    const double most = MPI::max(largest, communicator);
    // The largest of anything and not-a-number is anything: the mean tells.
    if (!std::isfinite(mean))
      return not_a_number;
    return norm == Norm::max ? most : norm == Norm::L2 ? std::sqrt(mean) : mean;
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
      return not_a_number;
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

  Comparison
  compare_curves(const Curve                         &curve,
                 const std::function<double(double)> &reference,
                 const std::vector<double>           &abscissas,
                 const Norm                           norm)
  {
    WeightedNorm references{norm}, errors{norm};
    Comparison   result;
    for (auto x = abscissas.begin(); x != abscissas.end(); ++x)
      {
        const double left  = x == abscissas.begin() ? *x : *(x - 1);
        const double right = x + 1 == abscissas.end() ? *x : *(x + 1);
        const double weight =
          abscissas.back() == abscissas.front() ? 1 : 0.5 * (right - left);
        result.value     = curve.value(*x);
        result.reference = reference(*x);
        references.add(weight, result.reference);
        errors.add(weight, result.value - result.reference);
      }
    result.reference_norm = references.value(MPI_COMM_SELF);
    result.error          = errors.value(MPI_COMM_SELF);
    return result;
  }
} // namespace impm
