#include <impm/footprints/approach.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // Of two boxes with a gap between them, the second one so far from the face
  // on the right, in cells of 1/16.
  Approach
  approach(const unsigned int gap,
           const unsigned int to_face,
           const Overrides   &overrides = {})
  {
    const auto at = [](const double cells) {
      return std::to_string(cells / 16);
    };
    Model<2> model(
      block_scene("plane strain"),
      Overrides{"Grid/Cells=16, 16",
                "Geometry/Shapes=box, second",
                "Geometry/box/Lower corner=" + at(1) + ", 0",
                "Geometry/box/Upper corner=" + at(4) + ", 1",
                "Geometry/second/Kind=box",
                "Geometry/second/Lower corner=" + at(4 + gap) + ", 0",
                "Geometry/second/Upper corner=" + at(16 - to_face) + ", 1",
                "Bodies/Names=block, second",
                "Bodies/second/Shape=second",
                "Bodies/second/Material=rubber"} +
        overrides);
    model.begin_step();
    return find_approach(model.points,
                         model.problem->footprints,
                         *model.problem->discretization,
                         model.problem->constraints);
  }
} // namespace


// Cells that bodies lie in have nodes on both sides, so that those of two
// bodies with a gap of n cells are n cells apart.
TEST(ApproachMpi, OfBodies)
{
  for (const auto &grid : {Overrides{}, Overrides{"Grid/Cells=8, 8"} + refined})
    {
      EXPECT_EQ(approach(0, 0, grid).of_bodies, Distance::none);
      EXPECT_TRUE(approach(0, 0, grid).bodies_touch);
      EXPECT_FALSE(approach(2, 0, grid).bodies_touch);
      EXPECT_EQ(approach(2, 0, grid).of_bodies, Distance::near);
      EXPECT_EQ(approach(7, 0, grid).of_bodies, Distance::far);
    }
}

TEST(ApproachMpi, ToWalls)
{
  const Overrides wall = {"Boundary conditions/right/Type=slip"};
  EXPECT_EQ(approach(0, 2).to_walls, Distance::none);
  // The first one does not touch it.
  EXPECT_EQ(approach(2, 6, wall).to_walls, Distance::far);
  EXPECT_EQ(approach(2, 2, wall).to_walls, Distance::near);
}
