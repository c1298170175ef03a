#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <impm/base/exceptions.h>
#include <impm/solve/coarse_unknowns.h>
#include <impm/solve/multigrid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** The linear system of a first step. */
  template <int dim>
  struct System
  {
    System(const std::string &kind,
           const Overrides   &overrides,
           const MPI_Comm     communicator = MPI_COMM_WORLD)
      : model(block_scene(kind), overrides, communicator)
    {
      model.begin_step();
      EXPECT_TRUE(model.balance().evaluate(model.vector(), true).admissible);
      unknowns = std::make_unique<Unknowns>(model.balance().make_unknowns());
      matrix   = model.balance().make_matrix(*unknowns);
      model.balance().assemble(*matrix);
    }

    LinearMap
    multigrid()
    {
      return make_multigrid(*matrix, model.balance().lattice(*unknowns));
    }

    /** Of any kind, but the same on any number of ranks; zero where held. */
    impm::Vector
    rough(const double seed) const
    {
      const auto   places = model.problem->discretization->node_positions;
      impm::Vector full   = model.vector(), result;
      for (unsigned int i = 0; i < full.locally_owned_size(); ++i)
        full.local_element(i) =
          std::sin(seed * (1e3 * places[i / dim][0] + 3e3 * places[i / dim][1] +
                           i % dim));
      model.constraints().set_zero(full);
      unknowns->initialize(result);
      unknowns->pack(full, result);
      return result;
    }

    /** Of CG, to a reduction of 1e-8. */
    unsigned int
    iterations()
    {
      const impm::Vector b = rough(1);
      impm::Vector       x;
      SolverControl      control(200, 1e-8 * b.l2_norm());
      unknowns->initialize(x);
      SolverCG<impm::Vector>(control).solve(*matrix, x, b, multigrid());
      return control.last_step();
    }

    Model<dim>                          model;
    std::unique_ptr<Unknowns>           unknowns;
    std::unique_ptr<impm::SparseMatrix> matrix;
  };

  // Surfaces of the block cut cells, and the cells are no power of two.
  Overrides
  cells(const unsigned int dim)
  {
    const bool solid = dim == 3;
    return {std::string("Grid/Cells=") + (solid ? "18, 18, 18" : "80, 80"),
            std::string("Grid/Upper corner=") +
              (solid ? "1.23, 1.23, 1.23" : "1.23, 1.23"),
            "Boundary conditions/bottom/Type=fixed",
            "Boundary conditions/left/Type=slip"};
  }

  const Overrides boxes = {"Grid/Method=GIMP"};
} // namespace


TEST(MultigridMpi, IsSymmetricAndPositive)
{
  const auto check = [](auto &&system) {
    const auto         multigrid = system.multigrid();
    const impm::Vector a = system.rough(1), b = system.rough(2);
    impm::Vector       Ma = a, Mb = b;
    multigrid.vmult(Ma, a);
    multigrid.vmult(Mb, b);
    EXPECT_GT(a * Ma, 0.);
    EXPECT_NEAR(b * Ma, a * Mb, 1e-9 * std::sqrt((a * Ma) * (b * Mb)));
  };
  check(System<2>("plane strain", cells(2)));
  check(System<2>("axisymmetric", cells(2) + refined + boxes));
  check(System<3>("3D", cells(3) + refined));
}


// However fine, however refined, whatever holds it.
TEST(MultigridMpi, TakesFewIterations)
{
  const auto check = [](auto &&system, const unsigned int most) {
    EXPECT_GT(system.unknowns->size(), 5000u);
    EXPECT_LE(system.iterations(), most);
  };
  const Overrides finer = {"Grid/Cells=160, 160"},
                  steep = {"Grid/Local refinements=3",
                           "Grid/Refine where=0.2 - x"};
  check(System<2>("plane strain", cells(2)), 16);
  check(System<2>("plane strain", cells(2) + finer), 16);
  check(System<2>("plane strain", cells(2) + steep), 16);
  check(System<2>("plane strain", cells(2) + finer + boxes), 16);
  check(System<2>("axisymmetric", cells(2) + refined + boxes), 16);
  check(System<2>("plane stress",
                  cells(2) + Overrides{"Grid/Method=Lagrangian",
                                       "Grid/Upper corner=1, 1"}),
        16);
  check(System<3>("3D", cells(3)), 16);
  check(System<3>("3D", cells(3) + refined + boxes), 16);
}


// The levels do not know of ranks: nor does the number of iterations, but for
// round-off.
TEST(MultigridMpi, TakesAsManyIterationsOnAnyNumberOfRanks)
{
  const auto refined_cells = cells(2) + refined;
  EXPECT_NEAR(
    System<2>("plane strain", refined_cells).iterations(),
    System<2>("plane strain", refined_cells, MPI_COMM_SELF).iterations(),
    1);
  EXPECT_NEAR(System<3>("3D", cells(3)).iterations(),
              System<3>("3D", cells(3), MPI_COMM_SELF).iterations(),
              1);
}


// Places beyond what a key can tell are refused, not mixed up.
TEST(MultigridMpi, RefusesTooFineALattice)
{
  System<2> system("plane strain", cells(2));
  auto      lattice = system.model.balance().lattice(*system.unknowns);
  for (auto &place : lattice.places)
    place[1] += 1 << 17;
  EXPECT_THROW(make_multigrid(*system.matrix, lattice), ComputationError);
}


// A node that is free alone, between those of the coarse lattice: the four
// places around it stand for no more than this one.
TEST(MultigridMpi, SurvivesANodeThatStandsAlone)
{
  System<2> system("plane strain", cells(2));
  auto      lattice = system.model.balance().lattice(*system.unknowns);
  for (auto &place : lattice.places)
    if (place[0] == 10 && place[1] == 10)
      place = {{1001, 1001, 0}};
  const auto   b         = system.rough(1);
  impm::Vector x         = b;
  const auto   multigrid = make_multigrid(*system.matrix, lattice);
  multigrid.vmult(x, b);
  EXPECT_GT(x * b, 0.);
}


// The keys are those of ranks, some wanted by several, one excluded.
TEST(CoarseUnknownsMpi, AreNumberedOnce)
{
  const unsigned int rank    = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  CoarseUnknowns::Wanted wanted;
  for (unsigned int key = 10 * rank; key < 10 * rank + 15; ++key)
    wanted[key] = 4 + rank; // the last five the next rank wants, too
  std::vector<CoarseUnknowns::Key> excluded;
  if (rank + 1 == n_ranks)
    excluded = {3, 12};
  const CoarseUnknowns unknowns(wanted, excluded, MPI_COMM_WORLD);
  EXPECT_EQ(unknowns.owned.size(), 10 * n_ranks + 5 - 2);
  EXPECT_EQ(unknowns.owned.n_elements(), unknowns.keys.size());
  for (const auto &[key, extent] : wanted)
    {
      const auto number = unknowns.number(key);
      if (key == 3 || key == 12)
        EXPECT_EQ(number, CoarseUnknowns::none);
      else
        {
          // consecutive, since each rank wants what follows the one before
          EXPECT_EQ(number, key - (key > 3) - (key > 12));
          const bool is_owned = rank == 0 || key >= 10 * rank + 5;
          EXPECT_EQ(unknowns.owned.is_element(number), is_owned);
        }
    }
  for (unsigned int i = 0; i < unknowns.keys.size(); ++i)
    {
      EXPECT_EQ(unknowns.owned.nth_index_in_set(i),
                unknowns.number(unknowns.keys[i]));
      EXPECT_EQ(unknowns.extents[i], 4 + static_cast<int>(rank));
    }
}
