#include <impm/base/exceptions.h>
#include <impm/solve/direct_solver.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace impm;

namespace
{
  const Overrides press = {"Boundary conditions/bottom/Type=fixed",
                           "Boundary conditions/top/Type=displacement",
                           "Boundary conditions/top/Value=0; -0.05*t"};

  /** The tangent of a scene where its first step has ended. */
  struct Tangent
  {
    explicit Tangent(const Overrides &overrides)
      : model(block_scene("plane strain"), press + overrides)
    {
      Vector u;
      EXPECT_TRUE(model.solve(u).converged);
      unknowns = std::make_unique<Unknowns>(model.balance().make_unknowns());
      matrix   = model.balance().make_matrix(*unknowns);
      model.balance().assemble(*matrix);
    }

    /** A compact vector with something everywhere. */
    Vector
    vector() const
    {
      Vector result;
      unknowns->initialize(result);
      for (unsigned int i = 0; i < result.locally_owned_size(); ++i)
        result.local_element(i) =
          std::sin(1. + unknowns->partitioner->local_to_global(i));
      return result;
    }

    /** Of what is found for a right-hand side that has a known solution,
     * relative. */
    double
    error(DirectSolver &solver) const
    {
      const Vector exact = vector();
      Vector       b = exact, x = exact;
      matrix->vmult(b, exact);
      solver.solve(x, b);
      x -= exact;
      return x.linfty_norm();
    }

    Model<2>                      model;
    std::unique_ptr<Unknowns>     unknowns;
    std::unique_ptr<SparseMatrix> matrix;
  };
} // namespace


TEST(DirectSolverMpi, SolvesToRoundOff)
{
  for (const auto &overrides :
       {Overrides{}, refined, Overrides{"Grid/Method=GIMP"}})
    {
      Tangent      tangent(plastic + overrides);
      DirectSolver symmetric(*tangent.matrix, true),
        general(*tangent.matrix, false);
      for (DirectSolver *solver : {&symmetric, &general})
        {
          solver->factorize();
          EXPECT_LT(tangent.error(*solver), 1e-10);
          EXPECT_LT(tangent.error(*solver), 1e-10); // once more
        }
    }
}


// The order of elimination is kept, the entries are not.
TEST(DirectSolverMpi, FactorizesOtherEntries)
{
  Tangent      tangent(refined);
  DirectSolver solver(*tangent.matrix, true);
  Vector       diagonal = tangent.vector();
  tangent.matrix->get_diagonal(diagonal);
  for (const double factor : {1., 1.5, 0.8})
    {
      Vector other = diagonal;
      other *= factor;
      tangent.matrix->set_diagonal(other);
      solver.factorize();
      EXPECT_LT(tangent.error(solver), 1e-10) << factor;
    }
}


// Where no pivots are searched, such a matrix may not be eliminated, or not
// well: then others do it.
TEST(DirectSolverMpi, SolvesWhatIsNotPositiveDefinite)
{
  Tangent tangent(refined);
  Vector  diagonal = tangent.vector();
  tangent.matrix->get_diagonal(diagonal);
  const auto error = [&](const double factor) {
    Vector other = diagonal;
    other *= factor;
    tangent.matrix->set_diagonal(other);
    DirectSolver solver(*tangent.matrix, true);
    solver.factorize();
    return tangent.error(solver);
  };
  EXPECT_LT(error(0.37), 1e-7);
  EXPECT_LT(error(1e-14), 1e-7);
  EXPECT_LT(error(0), 1e-7); // the first pivot is none
  EXPECT_LT(error(-1), 1e-7);
}


// The momentum formulation has an unsymmetric matrix with a pattern of its own.
TEST(DirectSolverMpi, SolvesWhatIsNotSymmetric)
{
  for (const bool taken_for_symmetric : {false, true})
    {
      Tangent      tangent(plastic + with_inertia +
                      Overrides{"Time/Formulation=momentum"});
      DirectSolver solver(*tangent.matrix, taken_for_symmetric);
      solver.factorize();
      EXPECT_LT(tangent.error(solver), 1e-9);
    }
}


TEST(DirectSolverMpi, ThrowsWhereTheMatrixIsSingular)
{
  for (const bool is_symmetric : {false, true})
    {
      Tangent tangent({});
      tangent.matrix->set_zero();
      DirectSolver solver(*tangent.matrix, is_symmetric);
      EXPECT_THROW(
        {
          solver.factorize();
          tangent.error(solver);
        },
        LinearizationError);
    }
}
