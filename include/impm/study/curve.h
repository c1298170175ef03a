#ifndef impm_study_curve_h
#define impm_study_curve_h

#include <deal.II/base/mpi.h>

#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace impm
{
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

  enum class Norm
  {
    L1,
    L2,
    max
  };

  /** The mean, the root mean square, or the largest size of a quantity. */
  struct WeightedNorm
  {
    Norm   norm;
    double weights = 0, sum = 0, largest = 0;

    void
    add(double weight, double size);

    /** Not a number if nothing, or something that is not finite, was added.
     * Collective. */
    double
    value(MPI_Comm communicator) const;
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

  /** How what was computed differs from its reference. */
  struct Comparison
  {
    /** Norms at the points; of a figure or a curve the (last) figures. */
    double value = not_a_number, reference = not_a_number;
    double error          = not_a_number; ///< norm of the difference
    double reference_norm = not_a_number;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &value &reference &error &reference_norm;
    }
  };

  /**
   * Compares at abscissas on the curve in rising order, of which there must be
   * one; L1 and L2 by the trapezoid rule, divided by the length.
   */
  Comparison
  compare_curves(const Curve                         &curve,
                 const std::function<double(double)> &reference,
                 const std::vector<double>           &abscissas,
                 Norm                                 norm);
} // namespace impm

#endif
