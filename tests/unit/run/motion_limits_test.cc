#include <impm/run/motion_limits.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace impm;

namespace
{
  const std::array<double, 4> faces = {{0, 3, -2, 1}};
  const Tensor<1, 2>          extents({0.5, 0.25});

  bool
  is_put_back(Point<2> &place, const GeometryKind geometry)
  {
    return put_back<2>(faces, extents, geometry, place);
  }
} // namespace


TEST(MotionLimits, RoundOffDoesNotTakeAPointOutOfTheDomain)
{
  for (const double sign : {-1., 1.})
    {
      Point<2> place(sign < 0 ? -1e-13 : 3 + 1e-13, 0.5);
      EXPECT_TRUE(is_put_back(place, GeometryKind::plane_strain));
      EXPECT_GE(place[0], 0);
      EXPECT_LE(place[0], 3);
      EXPECT_NEAR(place[0], sign < 0 ? 0 : 3, 1e-11);
      EXPECT_EQ(place[1], 0.5);
    }
  Point<2> corner(3 + 1e-13, -2 - 1e-13);
  EXPECT_TRUE(is_put_back(corner, GeometryKind::plane_strain));
  EXPECT_LE(corner[0], 3);
  EXPECT_GE(corner[1], -2);
}


TEST(MotionLimits, WhatLeavesTheDomainIsLeftToTheError)
{
  Point<2> place(-1e-9, 0.5);
  EXPECT_FALSE(is_put_back(place, GeometryKind::plane_strain));
  EXPECT_EQ(place[0], -1e-9);
}


TEST(MotionLimits, PointsInsideAndOnFacesStayToTheBit)
{
  for (const Point<2> at :
       {Point<2>(0, 0.5), Point<2>(3, 1), Point<2>(1e-14, -2)})
    {
      auto place = at;
      EXPECT_FALSE(is_put_back(place, GeometryKind::plane_strain));
      EXPECT_EQ(place, at);
    }
}


// The next step divides by the radius.
TEST(MotionLimits, RoundOffDoesNotTakeAPointOntoTheAxis)
{
  for (const double r : {0., -1e-14})
    {
      Point<2> place(r, 0.5);
      EXPECT_TRUE(is_put_back(place, GeometryKind::axisymmetric));
      EXPECT_GT(place[0], 0);
      EXPECT_LT(place[0], 1e-11);
    }
}
