#include <impm/solve/convergence_test.h>

#include <algorithm>
#include <cmath>

namespace impm
{
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
  ConvergenceTest::changes_little() const
  {
    return any && change <= spec.displacement_tolerance * largest_change &&
           energy <= spec.energy_tolerance * first_energy;
  }

  bool
  ConvergenceTest::is_met(const Evaluation &now) const
  {
    // A slender body resists with little force: what is small against the
    // forces of its material may still be all that happens in the step.
    const double reduction = spec.newton_reduction;
    bool         met       = true;
    for (unsigned int i = 0; i < now.parts.size(); ++i)
      {
        const auto &part  = now.parts[i];
        const bool  small = spec.convergence == Convergence::residual &&
                           part.residual <= spec.newton_tolerance &&
                           part.residual <= reduction * first_residual[i] &&
                           (part.at_work == 0 || reduction == 1 ||
                            part.residual <= reduction * part.at_work);
        met = met && (small || part.residual <= part.round_off);
      }
    return met || (spec.convergence == Convergence::increment_and_energy &&
                   changes_little());
  }

  bool
  ConvergenceTest::allows(const Evaluation &now) const
  {
    return spec.convergence == Convergence::increment_and_energy ?
             changes_little() :
             now.residual <= spec.newton_tolerance;
  }

  bool
  ConvergenceTest::stagnates(const Evaluation &now)
  {
    const unsigned int patience = 5;
    const bool in_vain = now.residual > 0.5 * smallest_residual && allows(now);
    n_in_vain          = in_vain ? n_in_vain + 1 : 0;
    smallest_residual  = std::min(smallest_residual, now.residual);
    return n_in_vain >= patience;
  }
} // namespace impm
