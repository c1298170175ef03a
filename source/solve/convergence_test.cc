#include <impm/solve/convergence_test.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  void
  ConvergenceTest::begin_step()
  {
    first_residual = largest_change = 0;
    any                             = false;
  }

  void
  ConvergenceTest::set_first_residual(const double residual)
  {
    first_residual = residual;
  }

  void
  ConvergenceTest::count(const double change, const double energy)
  {
    this->change   = change;
    this->energy   = std::abs(energy);
    first_energy   = any ? first_energy : this->energy;
    largest_change = std::max(largest_change, change);
    any            = true;
  }

  bool
  ConvergenceTest::is_met(const double residual) const
  {
    if (spec.convergence == Convergence::increment_and_energy)
      return any && change <= spec.displacement_tolerance * largest_change &&
             energy <= spec.energy_tolerance * first_energy;
    // A slender body resists with little force: what is small against the
    // forces of its material may still be all that happens in the step.
    return allows(residual) &&
           residual <= spec.newton_reduction * first_residual;
  }

  bool
  ConvergenceTest::allows(const double residual) const
  {
    return spec.convergence == Convergence::increment_and_energy ?
             is_met(residual) :
             residual <= spec.newton_tolerance;
  }
} // namespace impm
