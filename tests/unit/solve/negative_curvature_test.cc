#include <impm/solve/direct_solver.h>
#include <impm/solve/linear_solver.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // Whether a solver finds that a slender column of 2 x 20 cells, clamped below
  // and pressed from above by a share of its Euler load, is not stable; the
  // share of motion to the side in the mode is `sideways`.
  bool
  buckles(const double load, const Overrides &overrides, double &sideways)
  {
    const double young = 1, thickness = 0.1;
    // A column that is free above: pi^2 E I / (4 L^2).
    const double euler =
      numbers::PI * numbers::PI * young * std::pow(thickness, 3) / 12 / 4;
    Model<2>     model(block_scene("plane strain"),
                   Overrides{"Grid/Method=Lagrangian",
                             "Grid/Cells=4, 40",
                             "Grid/Upper corner=0.1, 1",
                             "Materials/rubber/Poisson's ratio=0",
                             "Boundary conditions/bottom/Type=fixed",
                             "Boundary conditions/top/Type=traction",
                             "Boundary conditions/top/Value=0; " +
                               std::to_string(-load * euler / thickness) +
                               "*t"} +
                     overrides);
    impm::Vector u;
    EXPECT_TRUE(model.solve(u).converged);
    TimerOutput  timer(std::cout, TimerOutput::never, TimerOutput::wall_times);
    LinearSolver solver(model.scene.solver, model.balance(), timer);
    solver.evaluate(u, true);
    solver.take_tangent();
    impm::Vector mode = model.vector();
    if (!solver.find_negative_curvature(mode))
      return false;
    double side = 0, all = 0;
    for (unsigned int i = 0; i < mode.locally_owned_size(); ++i)
      {
        const double square = std::pow(mode.local_element(i), 2);
        all += square;
        side += i % 2 == 0 ? square : 0.;
      }
    sideways = Utilities::MPI::sum(side, MPI_COMM_WORLD) /
               Utilities::MPI::sum(all, MPI_COMM_WORLD);
    EXPECT_NEAR(mode.linfty_norm(), 1., 1e-12);
    return true;
  }
} // namespace


TEST(NegativeCurvatureMpi, OfAColumnBeyondItsEulerLoad)
{
  for (const Overrides &solver :
       {Overrides{"Solver/Linear solver=direct"},
        Overrides{"Solver/Linear solver=CG"},
        Overrides{"Solver/Linear solver=CG", "Solver/Preconditioner=AMG"}})
    {
      SCOPED_TRACE(solver.back());
      double sideways = 0;
      EXPECT_FALSE(buckles(0.9, solver, sideways));
      EXPECT_TRUE(buckles(1.2, solver, sideways));
      EXPECT_GT(sideways, 0.9);
    }
}
