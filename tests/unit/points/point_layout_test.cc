#include <impm/points/point_layout.h>

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace impm
{
  namespace
  {
    using Kind = PointLayout::Kind;

    struct Expected
    {
      GeometryKind geometry;
      unsigned int vector;
      unsigned int symmetric_tensor;
      unsigned int tensor;
    };

    const double untouched = -1.;

    class PointLayoutOf : public testing::TestWithParam<Expected>
    {
    protected:
      bool
      is_3d() const
      {
        return GetParam().geometry == GeometryKind::three_d;
      }

      /** Whether nothing was written but the n components in the middle. */
      static bool
      frame_is_untouched(const std::vector<double> &values)
      {
        return values.front() == untouched && values.back() == untouched;
      }

      const PointLayout layout{GetParam().geometry};
    };

    TEST_P(PointLayoutOf, sizes)
    {
      EXPECT_EQ(layout.n_components(Kind::scalar), 1);
      EXPECT_EQ(layout.n_components(Kind::vector), GetParam().vector);
      EXPECT_EQ(layout.n_components(Kind::symmetric_tensor),
                GetParam().symmetric_tensor);
      EXPECT_EQ(layout.n_components(Kind::tensor), GetParam().tensor);
    }

    TEST_P(PointLayoutOf, tensor_round_trip)
    {
      dealii::Tensor<2, 3> tensor;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          if (is_3d() || (i < 2 && j < 2))
            tensor[i][j] = 2. + 3. * i + j;
      if (!is_3d())
        tensor[2][2] =
          GetParam().geometry == GeometryKind::plane_strain ? 1. : 7.;

      std::vector<double> values(GetParam().tensor + 2, untouched);
      layout.store_tensor(tensor, &values[1]);
      EXPECT_TRUE(frame_is_untouched(values));
      EXPECT_EQ(layout.load_tensor(&values[1]), tensor);
    }

    TEST_P(PointLayoutOf, symmetric_tensor_round_trip)
    {
      dealii::SymmetricTensor<2, 3> tensor;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          if (is_3d() || j < 2 || i == j)
            tensor[i][j] = 2. + 3. * i + j;

      std::vector<double> values(GetParam().symmetric_tensor + 2, untouched);
      layout.store_symmetric(tensor, &values[1]);
      EXPECT_TRUE(frame_is_untouched(values));
      EXPECT_EQ(layout.load_symmetric(&values[1]), tensor);
    }

    INSTANTIATE_TEST_SUITE_P(
      Geometries,
      PointLayoutOf,
      testing::Values(Expected{GeometryKind::plane_strain, 2, 4, 4},
                      Expected{GeometryKind::plane_stress, 2, 4, 5},
                      Expected{GeometryKind::axisymmetric, 2, 4, 5},
                      Expected{GeometryKind::three_d, 3, 6, 9}));

    TEST(PointLayout, fields_follow_each_other)
    {
      PointLayout layout(GeometryKind::axisymmetric);
      EXPECT_EQ(layout.size(), 0);
      EXPECT_EQ(layout.add("volume", Kind::scalar), 0);
      EXPECT_EQ(layout.add("F", Kind::tensor), 1);
      EXPECT_EQ(layout.add("velocity", Kind::vector), 6);
      EXPECT_EQ(layout.size(), 8);
      EXPECT_EQ(layout.offset("F"), 1);
      ASSERT_EQ(layout.fields().size(), 3);
      EXPECT_EQ(layout.fields()[1].n_components, 5);
    }

    TEST(PointLayout, add_shares_a_field)
    {
      PointLayout layout(GeometryKind::three_d);
      layout.add("volume", Kind::scalar);
      const auto offset = layout.add("stress", Kind::symmetric_tensor);
      const auto size   = layout.size();
      EXPECT_EQ(layout.add("stress", Kind::symmetric_tensor), offset);
      EXPECT_EQ(layout.size(), size);
      EXPECT_EQ(layout.fields().size(), 2);
    }

    TEST(PointLayout, offset_of_an_unknown_field_throws)
    {
      PointLayout layout(GeometryKind::plane_strain);
      layout.add("volume", Kind::scalar);
      EXPECT_TRUE(layout.find("volume"));
      EXPECT_FALSE(layout.find("stress"));
      EXPECT_THROW(layout.offset("stress"), std::logic_error);
    }
  } // namespace
} // namespace impm
