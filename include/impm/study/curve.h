#ifndef impm_study_curve_h
#define impm_study_curve_h

#include <deal.II/base/mpi.h>

#include <functional>
#include <optional>
#include <vector>

namespace impm
{
  enum class Norm
  {
    L1,
    L2,
    max
  };

  /** Norm of a quantity with weights: its mean, its root mean square, or its
   * largest value. */
  class WeightedNorm
  {
  public:
    explicit WeightedNorm(const Norm norm)
      : norm(norm)
    {}

    void
    add(double weight, double size);

    /** Not a number if nothing, or something that is not finite, was added.
     * Collective. */
    double
    value(MPI_Comm communicator) const;

  private:
    const Norm    norm;
    double        weights = 0, sum = 0, largest = 0;
    unsigned long n_not_finite = 0;
  };

  /** A figure y over an abscissa x that does not fall; linear in between. */
  struct Curve
  {
    std::vector<double> x, y;

    /** Whether x lies in its range, but for round-off. */
    bool
    contains(double x) const;

    /** Not a number outside the range. */
    double
    value(double x) const;
  };

  /** Turns round an abscissa that falls; nothing if it does neither. */
  std::optional<Curve>
  make_curve(std::vector<double> x, std::vector<double> y);

  /** Of a curve, of its reference, and of the difference. */
  struct CurveNorms
  {
    double value, reference, error;
    double last_value, last_reference; ///< at the last abscissa
  };

  /**
   * Compares at abscissas in rising order, as far as the curve reaches; L1 and
   * L2 by the trapezoid rule, divided by the length. Nothing when no abscissa
   * lies on the curve.
   */
  std::optional<CurveNorms>
  compare_curves(const Curve                         &curve,
                 const std::function<double(double)> &reference,
                 const std::vector<double>           &abscissas,
                 Norm                                 norm);
} // namespace impm

#endif
