#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  // Orders log(r_k+1 / r_k) / log(r_k / r_k-1) of the last iterates that are
  // clearly above round-off.
  std::vector<double>
  orders(const std::vector<double> &residuals)
  {
    std::vector<double> result;
    for (unsigned int k = 1; k + 1 < residuals.size(); ++k)
      if (residuals[k + 1] > 1e-15)
        result.push_back(std::log(residuals[k + 1] / residuals[k]) /
                         std::log(residuals[k] / residuals[k - 1]));
    return result;
  }

  template <int dim>
  void
  check_order(const std::string &kind, const Overrides &overrides)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    // Pressed without slip, so that the strain is not uniform.
    Model<dim> model(block_scene(kind),
                     plastic + overrides +
                       Overrides{"Solver/Newton tolerance=1e-14",
                                 "Materials/rubber/Yield stress=0.005",
                                 "Boundary conditions/left/Type=slip",
                                 "Boundary conditions/bottom/Type=fixed"});
    Vector     u;
    const auto result = model.solve(u);
    ASSERT_TRUE(result.converged) << result.failure;
    EXPECT_EQ(result.projections, 0u);
    EXPECT_LE(result.iterations, 8u);
    const auto found = orders(result.residuals);
    ASSERT_FALSE(found.empty());
    EXPECT_GT(found.back(), 1.7) << [&]() {
      std::ostringstream text;
      for (const double r : result.residuals)
        text << ' ' << r;
      return text.str();
    }();
  }
} // namespace


TEST(NewtonSolverMpi, ConvergesQuadratically)
{
  const Overrides platen = {"Boundary conditions/top/Type=displacement",
                            "Boundary conditions/top/Value=0; -0.05*t"};
  check_order<2>("plane strain", platen);
  check_order<2>("plane strain", platen + refined);
  check_order<2>("axisymmetric", platen + refined);
  check_order<2>("plane strain",
                 platen + with_inertia +
                   Overrides{"Geometry/box/Upper corner=0.7, 1"});
  check_order<2>("axisymmetric",
                 platen + refined + with_inertia +
                   Overrides{"Time/Formulation=momentum"});
  check_order<3>("3D",
                 {"Boundary conditions/top/Type=displacement",
                  "Boundary conditions/top/Value=0; -0.05*t; 0",
                  "Grid/Cells=2, 2, 2"});
}


TEST(NewtonSolverMpi, IterativeSolversFindTheSameState)
{
  const Overrides press = {"Boundary conditions/bottom/Type=fixed",
                           "Boundary conditions/top/Type=displacement",
                           "Boundary conditions/top/Value=0; -0.05*t"};
  Model<2> direct(block_scene("plane strain"), plastic + refined + press);
  auto     reference = direct.vector();
  ASSERT_TRUE(direct.solve(reference).converged);
  for (const std::string solver : {"CG", "GMRES"})
    for (const std::string preconditioner : {"AMG", "Jacobi", "none"})
      for (const std::string how :
           {"matrix", "matrix-free", "difference quotient"})
        {
          Model<2>   model(block_scene("plane strain"),
                         plastic + refined + press +
                           Overrides{"Solver/Linear solver=" + solver,
                                     "Solver/Linear tolerance=1e-6",
                                     "Solver/Preconditioner=" + preconditioner,
                                     "Solver/Operator=" + how});
          auto       u      = model.vector();
          const auto result = model.solve(u);
          ASSERT_TRUE(result.converged) << solver << preconditioner << how;
          EXPECT_EQ(model.step_solver.linear_solver.n_fallbacks, 0u)
            << solver << ' ' << preconditioner << ' ' << how;
          u -= reference;
          EXPECT_LT(u.linfty_norm(), 1e-11)
            << solver << ' ' << preconditioner << ' ' << how;
        }
}


// An iterative solver that finds no end leaves the solve to the direct one.
TEST(NewtonSolverMpi, DirectSolverTakesOver)
{
  for (const std::string formulation : {"velocity", "momentum"})
    for (const std::string how : {"matrix", "matrix-free"})
      {
        const Overrides press = {"Boundary conditions/bottom/Type=fixed",
                                 "Boundary conditions/top/Type=displacement",
                                 "Boundary conditions/top/Value=0; -0.05*t",
                                 "Time/Formulation=" + formulation};
        Model<2>        direct(block_scene("plane strain"),
                        plastic + with_inertia + press);
        auto            reference = direct.vector();
        ASSERT_TRUE(direct.solve(reference).converged);
        Model<2>   model(block_scene("plane strain"),
                       plastic + with_inertia + press +
                         Overrides{"Solver/Linear solver=GMRES",
                                   "Solver/Linear iterations=2",
                                   "Solver/Preconditioner=none",
                                   "Solver/Operator=" + how});
        auto       u      = model.vector();
        const auto result = model.solve(u);
        ASSERT_TRUE(result.converged) << formulation << ' ' << how;
        EXPECT_EQ(model.step_solver.linear_solver.n_fallbacks,
                  result.iterations);
        u -= reference;
        EXPECT_LT(u.linfty_norm(), 1e-11) << formulation << ' ' << how;
      }
}
