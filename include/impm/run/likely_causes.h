#ifndef impm_run_likely_causes_h
#define impm_run_likely_causes_h

#include <string>
#include <vector>

namespace impm
{
  /** What is known of a step that could not be made however short. */
  struct FailedStep
  {
    std::string         failure;   ///< of the last attempt
    std::vector<double> residuals; ///< of its iterations, over the scale

    bool         is_unstable   = false;         ///< an equilibrium of the run
    unsigned int pieces_before = 0, pieces = 0; ///< of all bodies
    double       points_per_cell = 1;           ///< smallest, by volume
    double       drift           = 0;           ///< see deformation_drift()
    bool         are_plain       = false;       ///< points without boxes
    double       fullest         = 1;           ///< see PointsPerCell
    double       smallest_J = 1, largest_J = 1; ///< of a point
    bool         bodies_touch = false;          ///< share a node, or nearly do
    unsigned int failed       = 0;              ///< points, see FailingLaw
    bool         is_unheld = false; ///< loads act on pieces that nothing holds
  };

  /** What it may have failed for, for people: the likely ones, in their order,
   * or that there is no sign of any. */
  std::string
  likely_causes(const FailedStep &step);
} // namespace impm

#endif
