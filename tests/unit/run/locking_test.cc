#include <deal.II/base/numbers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "run_scene.h"

using namespace impm;

namespace
{
  // The pressure of a footing at each step over Prandtl's limit
  // (prm/extreme/footing.prm).
  std::vector<double>
  press(const std::vector<std::string> &overrides)
  {
    auto pressure = run_file("extreme/footing", overrides).at("pressure");
    for (double &value : pressure)
      value /= 2 + dealii::numbers::PI;
    return pressure;
  }
} // namespace


// On a grid that is fine at the edge the limit load is Prandtl's within 2 %:
// what is too much is half a cell at the edge, 0.8 %, and the cells of the fan.
TEST(LockingMpi, AFootingHasALimit)
{
  const auto pressure = press({});
  EXPECT_NEAR(pressure.back(), 1.013, 0.002);
  const auto last = pressure.end() - 8;
  EXPECT_LT(*std::max_element(last, pressure.end()) -
              *std::min_element(last, pressure.end()),
            1e-3);
}


// The half cell at the edge on an even grid of four across half the footing;
// without F-bar there is no limit.
TEST(Locking, WithoutMeanVolumeThereIsNoLimit)
{
  const std::vector<std::string> coarse = {"Grid/Method=MPM",
                                           "Grid/Adaptation/Highest level=2",
                                           "Grid/Adaptation/Lowest level=2"};
  EXPECT_NEAR(press(coarse).back(), 1.092, 0.005);
  auto plain = coarse;
  plain.push_back("Materials/clay/F-bar=false");
  EXPECT_GT(press(plain).back(), 1.8);
}


// Cook's membrane at nu = 0.4999, on squares that do not fit it
// (prm/extreme/cook_points.prm): 6.9 mm.
TEST(LockingMpi, CooksMembraneByPoints)
{
  EXPECT_NEAR(run_file("extreme/cook_points").at("rise").back() / 6.9,
              1.,
              0.01);
  EXPECT_LT(run_file("extreme/cook_points", {"Materials/rubber/F-bar=false"})
                .at("rise")
                .back() /
              6.9,
            0.85);
}


// Closer to nu = 0.5 it rises to the same limit; with F-bar and a bulk modulus
// 5e5 times the shear modulus, which stands for nu = 0.499999.
TEST(Locking, CooksMembraneTendsToALimit)
{
  const auto expect_limit = [](const std::string              &scene,
                               const std::vector<std::string> &grid,
                               const double                    error) {
    SCOPED_TRACE(scene);
    const auto rise = [&](const std::string &modulus) {
      auto overrides = grid;
      overrides.push_back("Materials/rubber/Bulk modulus=" + modulus);
      return run_file(scene, overrides).at("rise").back();
    };
    const double near = rise("40.0942e10"), nearest = rise("4.0096874e13");
    EXPECT_NEAR(nearest / 6.9, 1., error);
    // Some steps are cut, which F-bar and new grids know.
    EXPECT_NEAR(nearest / near, 1., 3e-3);
  };
  expect_limit("cook", {"Grid/Cells=16, 16"}, 0.015);
  expect_limit("extreme/cook_points",
               {"Grid/Cells=14, 18", "General/Constants=h = 0.004"},
               0.015);
}


// A vortex of a fluid decays by its viscosity alone
// (prm/fluid/decaying_vortex.prm), whatever the bulk modulus; without F-bar
// cells lock, and it stands still.
TEST(LockingMpi, AVortexOfAFluidDecays)
{
  const auto energy = [](const std::string &f_bar, const std::string &bulk) {
    return run_file("fluid/decaying_vortex",
                    {"Grid/Cells=8, 8",
                     "Materials/fluid/F-bar=" + f_bar,
                     "Materials/fluid/Bulk modulus=" + bulk})
             .at("kinetic_energy")
             .back() /
           (0.25 * std::exp(-4 * M_PI * M_PI * 0.02 * 0.5));
  };
  EXPECT_NEAR(energy("true", "1e3"), 1., 0.03);
  EXPECT_NEAR(energy("true", "1e6"), 1., 0.03);
  EXPECT_LT(energy("false", "1e3"), 0.8);
  EXPECT_LT(energy("false", "1e6"), 1e-3);
}
