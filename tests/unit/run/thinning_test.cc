#include <gtest/gtest.h>

#include "run_file.h"

using namespace impm;

namespace
{
  // The force over the exact one at the end, and the drift of the deformation,
  // when a bar is drawn by half (prm/extreme/stretched_bar.prm).
  std::pair<double, double>
  draw(const std::string &method, const std::string &adaptation)
  {
    const auto columns =
      run_file("extreme/stretched_bar",
               {"Time/End time=0.5",
                "Grid/Method=" + method,
                "Bodies/bar/Point adaptation=" + adaptation});
    const double l = 1.5;
    return {columns.at("force").back() / (0.125e6 * (l - 1 / l)),
            columns.at("deformation_drift").back()};
  }
} // namespace


// What boxes carry is right; where plain points carry too little, since each
// cell that they cross tells them its own gradient, their drift says so.
TEST(ThinningMpi, DriftTellsOfForcesThatAreTooSmall)
{
  for (const std::string adaptation : {"split", "off"})
    {
      SCOPED_TRACE(adaptation);
      const auto [force, drift] = draw("GIMP", adaptation);
      EXPECT_NEAR(force, 1., 0.015);
      EXPECT_LT(drift, 0.01);
      const auto [lost_force, large_drift] = draw("MPM", adaptation);
      EXPECT_LT(lost_force, 0.75);
      EXPECT_NEAR(large_drift, 1 - lost_force, 0.1);
    }
}
