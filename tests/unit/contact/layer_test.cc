#include <impm/contact/layer.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace impm;

namespace
{
  constexpr double k = 3;
}


TEST(Layer, PressureAndStiffnessAreDerivatives)
{
  for (const double weight : {0.5, 0.7, 1.})
    for (const double start : {-0.2, -1e-4, 0.3, 1e-4})
      for (const double end : {-0.5, -1e-5, 1e-5, 0.4})
        {
          const double h     = 1e-6 * std::abs(end);
          const auto   at    = layer_over(k, start, end, weight);
          const auto   above = layer_over(k, start, end + h, weight);
          const auto   below = layer_over(k, start, end - h, weight);
          const double scale = k * std::max(std::abs(start), std::abs(end));
          EXPECT_NEAR(at.pressure,
                      -(above.potential - below.potential) / (2 * h),
                      1e-8 * scale);
          EXPECT_NEAR(at.stiffness,
                      -(above.pressure - below.pressure) / (2 * h),
                      1e-8 * k);
        }
}


// The mean of the forces does the work that the layer stores or has stored.
TEST(Layer, TrapezoidalStepsKeepEnergy)
{
  for (const double start : {-0.2, -0.1, 0., 0.3})
    for (const double end : {-0.5, -1e-7, 1e-7, 0.4})
      {
        const auto   before = layer_at(k, start), after = layer_at(k, end);
        const double mean =
          0.5 * (before.pressure + layer_over(k, start, end, 0.5).pressure);
        EXPECT_NEAR(mean * (start - end),
                    after.potential - before.potential,
                    1e-15);
      }
}


TEST(Layer, ForcesAtTheEndAloneAreThoseThere)
{
  for (const double start : {-0.2, 0.3})
    for (const double end : {-0.5, 0.4})
      EXPECT_EQ(layer_over(k, start, end, 1).pressure,
                layer_at(k, end).pressure);
}
