#include <impm/scene/rigid_inertia.h>

#include <gtest/gtest.h>

#include "create_shape.h"

using namespace dealii;
using namespace impm;

TEST(RigidInertia, OfABox)
{
  const auto box =
    *create<3>("box",
               {{"Lower corner", "1, 2, 3"}, {"Upper corner", "2, 4, 7"}});
  const auto of_box = inertia_of_shape(box, 3., false);
  EXPECT_NEAR(of_box.mass, 24, 1e-12);
  EXPECT_LT(of_box.centre.distance(Point<3>(1.5, 3, 5)), 1e-12);
  EXPECT_NEAR(of_box.tensor[0][0], 24 * (4. + 16) / 12, 1e-11);
  EXPECT_NEAR(of_box.tensor[2][2], 24 * (1. + 4) / 12, 1e-11);
  EXPECT_NEAR(of_box.tensor[0][1], 0, 1e-11);
}


TEST(RigidInertia, OfADiscAndABall)
{
  const auto disc = inertia_of_shape(
    *create<2>("ball", {{"Centre", "0.3, -2"}, {"Radius", "0.5"}}), 2., false);
  const double mass = 2 * numbers::PI / 4;
  EXPECT_NEAR(disc.mass / mass, 1, 1e-5);
  EXPECT_LT(disc.centre.distance(Point<2>(0.3, -2)), 1e-5);
  EXPECT_NEAR(disc.tensor[2][2] / (mass / 8), 1, 1e-5);
  const auto ball =
    inertia_of_shape(*create<3>("ball",
                                {{"Centre", "0.3, -2, 1"}, {"Radius", "0.5"}}),
                     2.,
                     false);
  const double heavy = 2 * numbers::PI / 6;
  EXPECT_NEAR(ball.mass / heavy, 1, 1e-3);
  for (unsigned int d = 0; d < 3; ++d)
    EXPECT_NEAR(ball.tensor[d][d] / (heavy / 10), 1, 2e-3);
  // around an axis through its centre
  const auto ring = inertia_of_shape(
    *create<2>("ball", {{"Centre", "2, 1"}, {"Radius", "0.5"}}), 2., true);
  EXPECT_NEAR(ring.mass / (mass * 4 * numbers::PI), 1, 1e-4);
  EXPECT_NEAR(ring.centre[1], 1, 1e-5);
}
