#include <deal.II/base/symmetric_tensor.h>

#include <impm/points/point_shape.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace impm;

namespace
{
  // A cell of 1 x 1 m with room for 2 x 2 points.
  const MergeRoom<2> room{Tensor<1, 2>({1., 1.}), 2.};

  PointShape<2>
  box(const double x, const double y, const double width, const double height)
  {
    PointShape<2> shape;
    shape.volume = shape.present_measure = width * height;
    shape.place                          = Tensor<1, 2>({x, y});
    shape.domain                         = Tensor<1, 2>({width, height});
    shape.deformation                    = unit_symmetric_tensor<3>();
    return shape;
  }

  /** Sheared, turned round and swollen: but for a factor it fills the same. */
  PointShape<2>
  deformed(PointShape<2> shape, const double shear, const double growth)
  {
    const double turn       = shear > 0 ? -1 : 1;
    shape.deformation[0][0] = turn * growth;
    shape.deformation[1][1] = turn;
    shape.deformation[0][1] = shear;
    shape.present_measure   = growth * shape.volume;
    return shape;
  }

  void
  expect_box(const PointShape<2> &shape,
             const double         width,
             const double         height)
  {
    EXPECT_NEAR(shape.edge(0)[0], width, 1e-13);
    EXPECT_NEAR(shape.edge(1)[1], height, 1e-13);
    EXPECT_EQ(shape.edge(0)[1], 0.);
    EXPECT_EQ(shape.edge(1)[0], 0.);
  }
} // namespace

TEST(PointShape, BoxesSideBySideMakeOne)
{
  for (const bool compact : {false, true})
    {
      const auto both = merge_to_box(box(0.1, 0.2, 0.2, 0.3),
                                     box(0.25, 0.2, 0.1, 0.3),
                                     room,
                                     compact);
      ASSERT_TRUE(both);
      expect_box(*both, 0.3, 0.3);
      EXPECT_NEAR(both->place[0], 0.15, 1e-14);
      EXPECT_NEAR(both->volume, 0.09, 1e-14);
    }
  const auto along =
    merge_along(0, box(0.1, 0.2, 0.2, 0.3), box(0.3, 0.2, 0.2, 0.3), room);
  ASSERT_TRUE(along);
  expect_box(*along, 0.4, 0.3);
}

// Of parallelograms it is a box of their measure, of their means of J.
TEST(PointShape, ShearIsForgottenVolumeIsNot)
{
  const auto one   = deformed(box(0.1, 0.1, 0.2, 0.2), 1.5, 1.1),
             other = deformed(box(0.3, 0.1, 0.2, 0.2), -2, 0.9);
  const auto both  = merge_to_box(one, other, room, false);
  ASSERT_TRUE(both);
  EXPECT_NEAR(both->edge(0)[0] * both->edge(1)[1], 0.08, 1e-14);
  EXPECT_NEAR(determinant(both->deformation), 1., 1e-14);
  EXPECT_GT(both->edge(0)[0], both->edge(1)[1]);
  EXPECT_LE(both->edge(0)[0], 0.525 + 1e-14);
  // Not one box at all for laws that read F.
  EXPECT_FALSE(merge_along(0, one, other, room));
}

TEST(PointShape, ThereIsNoRoomForWhatIsSplitAgain)
{
  // Too much for one point.
  EXPECT_FALSE(merge_to_box(
    box(0.25, 0.25, 0.5, 0.5), box(0.25, 0.65, 0.5, 0.3), room, false));
  // Across a corner, and apart.
  EXPECT_FALSE(
    merge_to_box(box(0.1, 0.1, 0.2, 0.2), box(0.3, 0.3, 0.2, 0.2), room, true));
  EXPECT_FALSE(
    merge_to_box(box(0.1, 0.1, 0.2, 0.2), box(0.5, 0.1, 0.2, 0.2), room, true));
  // A long box becomes shorter and wider.
  const auto both =
    merge_to_box(box(0.2, 0.1, 0.4, 0.2), box(0.6, 0.1, 0.4, 0.2), room, true);
  ASSERT_TRUE(both);
  expect_box(*both, 0.525, 0.16 / 0.525);
}

// The sum of volumes and, in plane stress, that of areas.
TEST(PointShape, ThicknessIsAMean)
{
  auto thick              = box(0.1, 0.1, 0.2, 0.2);
  thick.deformation[2][2] = 1.2;
  const auto both = merge_to_box(thick, box(0.3, 0.1, 0.2, 0.2), room, true);
  ASSERT_TRUE(both);
  EXPECT_NEAR(both->deformation[2][2], 1.1, 1e-14);
  EXPECT_NEAR(determinant(both->deformation) * both->volume, 2.2 * 0.04, 1e-14);
  expect_box(*both, 0.4, 0.2);
}
