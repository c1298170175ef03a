#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace impm;

// The billets of Guilkey & Weiss (2003), section 5.1, on coarse grids.
namespace
{
  const Overrides coarse          = {"Grid/Cells=20, 11", "Time/Time step=0.1"};
  const Overrides finite_elements = {"Grid/Method=Lagrangian",
                                     "Bodies/billet/Points per cell=2"};

  // Of finite elements with cells of 0.25 cm.
  constexpr double corner = 7.295, load = 3.621e8;
} // namespace

TEST(BilletMpi, FiniteElementsFoldOntoThePlaten)
{
  const auto columns = run_file("billet_static", coarse + finite_elements);
  EXPECT_NEAR(columns.at("corner_displacement").back(), corner, 0.01 * corner);
  EXPECT_NEAR(columns.at("platen_load").back(), load, 0.02 * load);
  EXPECT_NEAR(columns.at("compression").back(), 0.5, 1e-12);
}


TEST(Billet, PointsAndBoxesAgreeWithFiniteElements)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      const auto columns =
        run_file("billet_static",
                 coarse + Overrides{"Grid/Method=" + method,
                                    "Solver/Nonlinear solver=BFGS"});
      // The platen of points acts up to a cell of 1 cm ahead of itself.
      EXPECT_NEAR(columns.at("corner_displacement").back(),
                  corner,
                  0.06 * corner);
      EXPECT_NEAR(columns.at("platen_load").back(), load, 0.15 * load);
    }
  const auto columns =
    run_file("billet_static_moving_grid",
             {"Grid/Cells=20, 10", "Time/Time step=0.1", "Grid/Method=GIMP"});
  EXPECT_NEAR(columns.at("corner_displacement").back(), corner, 0.03 * corner);
  EXPECT_NEAR(columns.at("platen_load").back(), load, 0.04 * load);
}


// With few points a new grid can be so far out of balance that its first
// correction turns points inside out, in a step of any length.
TEST(Billet, FewPointsGoOn)
{
  const auto columns =
    run_file("billet_static_moving_grid", {"Bodies/billet/Points per cell=2"});
  EXPECT_NEAR(columns.at("compression").back(), 0.5, 1e-12);
}


TEST(BilletMpi, TimeIntegratorsAgree)
{
  const Overrides cells = {"Grid/Cells=20, 11"};
  const auto      end   = [&](const Overrides &overrides) {
    return run_file("billet_dynamic", cells + overrides)
      .at("corner_displacement")
      .back();
  };
  const double points = end({"Time/Time step=2.5e-3"});
  const double grid =
    end({"Time/Time step=2.5e-3", "Time/Acceleration from=grid"});
  // Explicit steps of the velocity formulation amplify round-off here, so that
  // every number of ranks would give another result.
  const double forward  = end({"Time/Integrator=explicit",
                               "Time/Formulation=momentum",
                               "Time/Time step=1.4e-4"});
  const double elements = end(finite_elements);
  EXPECT_NEAR(points, elements, 0.05 * elements);
  EXPECT_NEAR(grid, elements, 0.05 * elements);
  EXPECT_NEAR(forward, elements, 0.1 * elements);
}


// All of it in one step, a thousand times what a wave takes through a cell: it
// is cut as often as contact asks for.
TEST(Billet, AStepMayBeFarTooLong)
{
  const double end_corner = 7.398,
               end_load   = 3.68e8; // finite elements, 0.25 cm
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      const auto columns = run_file("billet_dynamic",
                                    {"Grid/Cells=20, 11",
                                     "Grid/Method=" + method,
                                     "Time/CFL number=1e3"});
      EXPECT_NEAR(columns.at("compression").back(), 0.5, 1e-12);
      EXPECT_NEAR(columns.at("corner_displacement").back(),
                  end_corner,
                  0.06 * end_corner);
      EXPECT_NEAR(columns.at("platen_load").back(), end_load, 0.15 * end_load);
    }
}
