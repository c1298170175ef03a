#include <gtest/gtest.h>

#include <algorithm>

#include "run_scene.h"

using namespace impm;

// Behind a disc that is drawn through a block the grid coarsens and points
// merge: there are about as many as before. Without merging there are 21,050 at
// the end.
TEST(Wake, GridAndPointsRecover)
{
  const auto  columns = run_file("wake");
  const auto &points  = columns.at("points"),
             &cells = columns.at("active_cells"), &load = columns.at("load"),
             &time   = columns.at("time");
  const double start = 3300; // points at rest
  EXPECT_NEAR(points.back() / start, 1., 0.1);
  EXPECT_NEAR(cells.back() / cells.front(), 1., 0.1);
  EXPECT_LT(*std::max_element(points.begin(), points.end()), 1.12 * start);

  // F begins anew where points merge: it is not said to drift.
  EXPECT_EQ(columns.at("deformation_drift").back(), 0);

  // The mean after the start is that without merging.
  double sum = 0, duration = 0;
  for (unsigned int i = 0; i < time.size(); ++i)
    if (time[i] > 0.2)
      {
        sum += columns.at("dt")[i] * load[i];
        duration += columns.at("dt")[i];
      }
  const double without_merging = 275.6e3;
  EXPECT_NEAR(sum / duration / without_merging, 1., 0.015);
  const double lost = -columns.at("resampling_energy").back() /
                      columns.at("external_work").back();
  EXPECT_GT(lost, 0.);
  EXPECT_LT(lost, 2e-3);
}
