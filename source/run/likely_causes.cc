#include <impm/base/names.h>
#include <impm/run/likely_causes.h>

#include <algorithm>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Whether the last iterations have left a residual as small as round-off
     * lets it be. */
    bool
    stays_at_round_off(const std::vector<double> &residuals)
    {
      constexpr unsigned int n = 4;
      if (residuals.size() < n + 1)
        return false;
      const auto [least, most] =
        std::minmax_element(residuals.end() - n, residuals.end());
      return *most < 1e-9 * residuals.front() && *least > 0.1 * *most;
    }
  } // namespace

  std::string
  likely_causes(const FailedStep &step)
  {
    const auto failed_by = [&](const std::string &words) {
      return step.failure.find(words) != std::string::npos;
    };
    std::vector<std::string> causes;
    const auto               add = [&](const auto &...parts) {
      std::ostringstream text;
      (text << ... << parts);
      causes.push_back(text.str());
    };
    if (step.is_unheld)
      add("a body that nothing holds in some direction, and that loads move "
          "without inertia (section 'Boundary conditions', or another "
          "'Time/Integrator')");
    else if (step.is_unstable)
      add("a limit point: the run has met equilibria that are not stable, and "
          "may be beyond the load that can be borne");
    if (step.failed > 0)
      add(
        "failed points: ",
        step.failed,
        " of them bear next to nothing and go anywhere, as far as ",
        step.largest_J,
        " times their volume, in a step without inertia ('Remaining stress' = "
        "1e-3 to 1e-2 holds them)");
    if (step.pieces > step.pieces_before || step.points_per_cell < 0.5)
      add("a tear: material has parted, ",
          step.pieces,
          " pieces hang together and a cell has ",
          step.points_per_cell,
          " points (let points split, or begin with more)");
    if (failed_by("leave the domain"))
      add(
        "a face that holds nothing there (section 'Boundary conditions'), or a "
        "grid that is too small for where the body goes");
    if (failed_by("whole cell") || (step.are_plain && step.drift > 0.1))
      add("crossing: points go far through the grid, and their deformation has "
          "drifted from how they lie by ",
          100 * step.drift,
          " % (shorter steps, or boxes: Grid/Method = GIMP)");
    if (step.fullest > 1.3)
      add("an overfull cell: points in one have ",
          step.fullest,
          " times its volume, so that material lies in itself (a finer grid "
          "where it folds)");
    if (step.bodies_touch)
      add(
        "contact: two bodies share nodes, or nearly do (shorter steps as they "
        "meet)");
    if (failed_by("inside out") || step.smallest_J < 0.1 || step.largest_J > 10)
      add("the material: points have ",
          step.smallest_J,
          " to ",
          step.largest_J,
          " times their volume, and turn inside out beyond what the law bears");
    if (stays_at_round_off(step.residuals))
      add("a tolerance below round-off: the residual stays at ",
          step.residuals.back(),
          " ('Newton tolerance')");
    return causes.empty() ?
             "no sign of the usual causes: shorter steps, or a finer grid, may "
             "tell" :
             "likely " + join(causes, ", or ");
  }
} // namespace impm
