#include <gtest/gtest.h>

#include <fstream>

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
  check_order<2>("plane strain", platen + Overrides{"Grid/Method=Lagrangian"});
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
    for (const std::string preconditioner :
         {"multigrid", "AMG", "Jacobi", "none"})
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
          EXPECT_EQ(model.counts.solver_fallbacks, 0u)
            << solver << ' ' << preconditioner << ' ' << how;
          u -= reference;
          EXPECT_LT(u.linfty_norm(), 1e-11)
            << solver << ' ' << preconditioner << ' ' << how;
        }
}


// Nodes without material are no unknowns: a domain of ten times the area takes
// no more iterations to the same state.
TEST(NewtonSolverMpi, EmptyCellsCostNoIterations)
{
  const auto solve = [](const std::string &lower,
                        const std::string &upper,
                        const std::string &cells) {
    Model<2>   model(block_scene("plane strain"),
                   {"Grid/Lower corner=" + lower,
                      "Grid/Upper corner=" + upper,
                      "Grid/Cells=" + cells,
                      "Boundary conditions/bottom/Type=fixed",
                      "Loads/Body force=0; -0.05",
                      "Solver/Linear solver=CG",
                      "Solver/Newton tolerance=1e-10"});
    auto       u      = model.vector();
    const auto result = model.solve(u);
    EXPECT_TRUE(result.converged) << result.failure;
    EXPECT_EQ(model.counts.solver_fallbacks, 0u);
    const auto unknowns = model.balance().make_unknowns();
    // 41 x 41 nodes, whose lowest are held
    EXPECT_EQ(unknowns.size(), 2u * 41 * 40);
    return std::make_pair(result.linear_iterations, u.l2_norm());
  };
  const auto near = solve("-0.25, 0", "1.25, 1.25", "60, 50");
  const auto far  = solve("-1.5, 0", "2.5, 4", "160, 160");
  EXPECT_GT(near.first, 10u); // several levels
  EXPECT_NEAR(far.first, near.first, 3);
  EXPECT_NEAR(far.second, near.second, 1e-8 * near.second);
}


// Where a tangent is kept and corrected, the same state is found, with fewer
// tangents than iterations.
TEST(NewtonSolverMpi, BfgsFindsTheSameState)
{
  const Overrides press = {"Boundary conditions/bottom/Type=fixed",
                           "Boundary conditions/top/Type=displacement",
                           "Boundary conditions/top/Value=0; -0.05*t"};
  const auto check = [&](const std::string &kind, const Overrides &overrides) {
    SCOPED_TRACE(kind + overrides.front());
    Model<2> newton(block_scene(kind), press + overrides);
    auto     reference = newton.vector();
    ASSERT_TRUE(newton.solve(reference).converged);
    for (const std::string solver : {"direct", "CG"})
      {
        auto all = press + overrides +
                   Overrides{"Solver/Nonlinear solver=BFGS",
                             "Solver/Linear solver=" + solver};
        if (solver == "CG")
          all.push_back("Solver/Linear tolerance=1e-8");
        Model<2>   model(block_scene(kind), all);
        auto       u      = model.vector();
        const auto result = model.solve(u);
        ASSERT_TRUE(result.converged) << result.failure;
        EXPECT_LT(model.counts.tangents, result.iterations / 2);
        u -= reference;
        EXPECT_LT(u.linfty_norm(), 1e-11);
      }
  };
  check("plane strain", plastic + refined);
  check("axisymmetric", plastic);
  check("plane stress", {"Materials/rubber/Law=neo-Hookean"});
  check("plane strain",
        {"Materials/rubber/Law=decoupled neo-Hookean",
         "Materials/rubber/F-bar=true",
         "Grid/Method=GIMP"});
  check("plane strain", with_inertia + plastic);
}


// Guilkey & Weiss (2003), eq. 13. Newton's method converges quadratically, so
// the last change of 1e-6 leaves an error of 1e-12.
TEST(NewtonSolverMpi, ConvergenceOfIncrementAndEnergy)
{
  const Overrides press = {"Boundary conditions/bottom/Type=fixed",
                           "Boundary conditions/top/Type=displacement",
                           "Boundary conditions/top/Value=0; -0.05*t"};
  Model<2>        reference(block_scene("plane strain"), press + refined);
  auto            exact = reference.vector();
  ASSERT_TRUE(reference.solve(exact).converged);
  std::vector<unsigned int> iterations;
  for (const auto &[displacement, energy] :
       std::vector<std::pair<std::string, std::string>>{{"0.5", "0.5"},
                                                        {"0.5", "1e-12"},
                                                        {"1e-6", "1"}})
    {
      Model<2>   model(block_scene("plane strain"),
                     press + refined +
                       Overrides{"Solver/Convergence=increment and energy",
                                 "Solver/Displacement tolerance=" +
                                   displacement,
                                 "Solver/Energy tolerance=" + energy});
      auto       u      = model.vector();
      const auto result = model.solve(u);
      ASSERT_TRUE(result.converged) << result.failure;
      EXPECT_FALSE(result.stopped_at_noise);
      iterations.push_back(result.iterations);
      u -= exact;
      if (iterations.size() > 1)
        EXPECT_LT(u.linfty_norm(), 1e-9);
    }
  // Never on the first iteration, whose change is the largest.
  EXPECT_EQ(iterations[0], 2u);
  EXPECT_GT(iterations[1], 2u);
  EXPECT_GT(iterations[2], 2u);
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
        EXPECT_EQ(model.counts.solver_fallbacks, result.iterations);
        u -= reference;
        EXPECT_LT(u.linfty_norm(), 1e-11) << formulation << ' ' << how;
      }
}


// A body that settles under its weight ends in round-off, whose reduction must
// not be asked for; and that of a stress is one of its stiffness, however small
// the stress. Units do not matter.
TEST(NewtonSolverMpi, BodyThatComesToRest)
{
  const auto check = [](const std::string &scene, const Overrides &overrides) {
    SCOPED_TRACE(scene.substr(0, 60) + overrides.back());
    Model<2>     model(scene,
                   Overrides{"Boundary conditions/bottom/Type=slip",
                             "Boundary conditions/left/Type=slip",
                             "Boundary conditions/right/Type=slip",
                             "Grid/Upper corner=1, 1.5",
                             "Grid/Cells=4, 6",
                             "Loads/Body force=0; -0.001",
                             "Time/Time step=2",
                             "Solver/Newton tolerance=1e-7"} +
                     overrides);
    impm::Vector u;
    double       first = 0, speed = 0;
    for (unsigned int step = 0; step < 200; ++step)
      {
        const auto result = model.solve(u);
        ASSERT_TRUE(result.converged) << step << ' ' << result.failure;
        ASSERT_LE(result.iterations, 2u) << step;
        speed = u.l2_norm();
        first = step == 0 ? speed : first;
        model.commit(u);
      }
    EXPECT_LT(speed, 1e-5 * first);
  };
  const std::string solid   = block_scene("plane strain");
  const Overrides   newmark = {"Time/Integrator=Newmark",
                               "Time/Gamma=0.6",
                               "Time/Beta=0.3025"};
  for (const std::string method : {"MPM", "GIMP", "Lagrangian"})
    for (const std::string solver : {"direct", "CG"})
      check(solid,
            with_inertia + Overrides{"Grid/Method=" + method,
                                     "Solver/Linear solver=" + solver});
  check(solid, newmark);
  check(fluid_scene("plane strain"), with_inertia);
  for (const std::string unit : {"1e120", "1e-120"})
    check(solid,
          with_inertia + Overrides{"Materials/rubber/Young's modulus=" + unit,
                                   "Materials/rubber/Density=" + unit});
}


// So it does where residuals elsewhere have stood in for the tangent: the
// matrix is that of the iterate, the mean volume included. The quotient itself
// enters where the prescribed motion is spread, and not into the second model.
TEST(NewtonSolverMpi, DirectSolverTakesOverFromTheDifferenceQuotient)
{
  const auto residuals = [](const std::string &how) {
    Model<2>   model(block_scene("plane strain"),
                   {"Materials/rubber/Law=decoupled neo-Hookean",
                      "Materials/rubber/Poisson's ratio=0.49",
                      "Materials/rubber/F-bar=true",
                      "Boundary conditions/bottom/Type=fixed",
                      "Boundary conditions/top/Type=displacement",
                      "Boundary conditions/top/Value=0; -0.05*t",
                      "Solver/Linear solver=GMRES",
                      "Solver/Linear iterations=1",
                      "Solver/Preconditioner=none",
                      "Solver/Difference step=1e-8",
                      "Solver/Operator=" + how});
    auto       u      = model.vector();
    const auto result = model.solve(u);
    EXPECT_TRUE(result.converged) << how << result.failure;
    EXPECT_EQ(model.counts.solver_fallbacks, result.iterations);
    return result.residuals;
  };
  const auto exact = residuals("matrix-free");
  const auto found = residuals("difference quotient");
  ASSERT_EQ(found.size(), exact.size());
  for (unsigned int k = 0; k < exact.size(); ++k)
    EXPECT_NEAR(found[k], exact[k], 1e-6 * exact[k] + 1e-13) << k;
}


// A system that nothing makes regular fails its step: no exception, no word of
// the libraries, no file.
TEST(NewtonSolver, SingularSystemFailsTheStep)
{
  const TemporaryFile points("x,y,volume\n0.3,0.4,0.01\n", ".csv");
  for (const std::string solver : {"direct", "CG"})
    {
      SCOPED_TRACE(solver);
      Model<2>     model(block_scene("plane strain"),
                     {"Bodies/block/Points from=file",
                          "Bodies/block/File=" + points.name,
                          "Boundary conditions/left/Type=displacement",
                          "Boundary conditions/left/Value=0.01*t; 0",
                          "Loads/Body force=1; 0",
                          "Stabilization/Isolated stiffness=0",
                          "Stabilization/Ghost penalty=0",
                          "Solver/Linear solver=" + solver},
                     MPI_COMM_SELF);
      impm::Vector u;
      testing::internal::CaptureStdout();
      const auto result = model.solve(u);
      EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
      EXPECT_FALSE(result.converged);
      EXPECT_FALSE(std::ifstream("amesos-failure.dat"));
    }
}
