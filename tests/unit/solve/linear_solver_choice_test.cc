#include <impm/solve/inverses.h>
#include <impm/solve/linear_solver_choice.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace impm;

namespace
{
  using Kind = LinearSolverKind;

  SolverSpec
  automatic()
  {
    SolverSpec spec;
    spec.preconditioner = PreconditionerKind::multigrid;
    return spec;
  }

  /** The block under its weight, held below; so many cells a side. */
  Overrides
  weight(const std::string &cells)
  {
    return {"Grid/Lower corner=-0.25, 0",
            "Grid/Upper corner=1.25, 1.5",
            "Grid/Cells=" + cells + ", " + cells,
            "Boundary conditions/bottom/Type=fixed",
            "Loads/Body force=0; -0.05"};
  }

  struct Outcome
  {
    Vector       u;
    unsigned int linear_iterations;
    std::string  name;
  };

  Outcome
  solve(const Overrides &overrides)
  {
    Model<2>   model(block_scene("plane strain"), overrides);
    Outcome    outcome;
    const auto result = model.solve(outcome.u);
    EXPECT_TRUE(result.converged) << result.failure;
    EXPECT_EQ(model.counts.solver_fallbacks, 0u);
    outcome.linear_iterations = result.linear_iterations;
    outcome.name = describe_linear_solver(model.scene.solver, 2, model.counts);
    return outcome;
  }

  /** Left open, a step is bit for bit that of the solver that has a name. */
  void
  expect_choice(const Overrides   &scene,
                const std::string &solver,
                const std::string &name)
  {
    SCOPED_TRACE(name);
    const auto named =
      solve(scene + Overrides{"Solver/Linear solver=" + solver});
    auto open = solve(scene + Overrides{"Solver/Linear solver=automatic"});
    EXPECT_EQ(named.name, name);
    EXPECT_EQ(open.name, name + " (automatic)");
    EXPECT_EQ(open.linear_iterations, named.linear_iterations);
    open.u -= named.u;
    EXPECT_EQ(open.u.linfty_norm(), 0);
  }
} // namespace


TEST(LinearSolverChoice, BySizeAndDimension)
{
  const auto spec = automatic();
  for (const unsigned int dim : {2u, 3u})
    {
      const unsigned int n = largest_coarse_system(dim);
      EXPECT_EQ(choose_linear_solver(spec, dim, 1), Kind::direct);
      EXPECT_EQ(choose_linear_solver(spec, dim, n), Kind::direct);
      EXPECT_EQ(choose_linear_solver(spec, dim, n + 1), Kind::cg);
    }
  EXPECT_LT(largest_coarse_system(3), largest_coarse_system(2));
}


TEST(LinearSolverChoice, ByKind)
{
  auto unsymmetric                 = automatic();
  unsymmetric.has_symmetric_matrix = false;
  EXPECT_EQ(choose_linear_solver(unsymmetric, 2, 10), Kind::direct);
  EXPECT_EQ(choose_linear_solver(unsymmetric, 2, 100000), Kind::gmres);
  // What a direct solver would not do.
  for (const auto preconditioner :
       {PreconditionerKind::jacobi, PreconditionerKind::none})
    {
      auto spec           = automatic();
      spec.preconditioner = preconditioner;
      EXPECT_EQ(choose_linear_solver(spec, 2, 10), Kind::cg);
    }
  for (const auto tangent :
       {TangentKind::matrix_free, TangentKind::difference_quotient})
    {
      auto spec    = automatic();
      spec.tangent = tangent;
      EXPECT_EQ(choose_linear_solver(spec, 2, 10), Kind::cg);
      spec.has_symmetric_matrix = false;
      EXPECT_EQ(choose_linear_solver(spec, 2, 10), Kind::gmres);
    }
  // A name stands for itself.
  for (const auto kind : {Kind::cg, Kind::gmres, Kind::direct})
    {
      auto spec          = automatic();
      spec.linear_solver = kind;
      EXPECT_EQ(choose_linear_solver(spec, 3, 10), kind);
      EXPECT_EQ(choose_linear_solver(spec, 3, 100000), kind);
    }
}


TEST(LinearSolverChoice, SaysWhatItIs)
{
  auto       spec = automatic();
  WorkCounts counts;
  const auto found = [&]() { return describe_linear_solver(spec, 2, counts); };
  EXPECT_EQ(found(),
            "direct up to 2000 unknowns, else CG with multigrid (automatic)");
  counts.direct_systems = 3;
  EXPECT_EQ(found(), "direct (automatic)");
  counts.iterative_systems = 1;
  EXPECT_EQ(found(), "direct and CG with multigrid (automatic)");
  counts.direct_systems = 0;
  EXPECT_EQ(found(), "CG with multigrid (automatic)");
  spec.has_symmetric_matrix = false;
  EXPECT_EQ(found(), "GMRES with multigrid (automatic)");
  spec.preconditioner = PreconditionerKind::jacobi;
  EXPECT_EQ(found(), "GMRES with Jacobi (automatic)");
  spec.linear_solver  = Kind::cg;
  spec.preconditioner = PreconditionerKind::none;
  EXPECT_EQ(found(), "CG without preconditioner");
}


TEST(LinearSolverChoiceMpi, ComputesAsTheNamedSolver)
{
  const Overrides small = weight("12"), large = weight("60");
  expect_choice(small, "direct", "direct");
  expect_choice(small + refined, "direct", "direct");
  expect_choice(large, "CG", "CG with multigrid");
  expect_choice(small + Overrides{"Solver/Preconditioner=Jacobi"},
                "CG",
                "CG with Jacobi");
  expect_choice(small + Overrides{"Solver/Operator=matrix-free"},
                "CG",
                "CG with multigrid");
  const Overrides momentum =
    with_inertia + Overrides{"Time/Formulation=momentum"};
  expect_choice(small + momentum, "direct", "direct");
  expect_choice(small + momentum + Overrides{"Solver/Preconditioner=none"},
                "GMRES",
                "GMRES without preconditioner");
}


// An iterative solver that was not asked for and fails once leaves the rest of
// the step to the direct one.
TEST(LinearSolverChoiceMpi, GivesUpOnceAStep)
{
  const auto solve_few = [](const std::string &solver) {
    Model<2>   model(block_scene("plane strain"),
                   weight("60") + Overrides{"Solver/Linear solver=" + solver,
                                            "Solver/Linear iterations=1"});
    Vector     u;
    const auto result = model.solve(u);
    EXPECT_TRUE(result.converged) << result.failure;
    EXPECT_GT(result.iterations, 1u);
    return std::make_pair(result.iterations, model.counts.solver_fallbacks);
  };
  const auto named = solve_few("CG"), open = solve_few("automatic");
  EXPECT_EQ(named.second, named.first);
  EXPECT_EQ(open.first, named.first);
  EXPECT_EQ(open.second, 1u);
}
