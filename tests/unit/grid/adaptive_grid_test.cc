#include <deal.II/grid/grid_tools.h>

#include <impm/base/exceptions.h>
#include <impm/grid/adaptive_grid.h>
#include <impm/grid/load_balance.h>
#include <impm/output/history.h>
#include <impm/points/adapt_points.h>

#include <gtest/gtest.h>

#include "expect_blame.h"
#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  Overrides
  criterion(const std::string &kind, const Overrides &entries = {})
  {
    Overrides all = {"Grid/Adaptation/Criteria=it",
                     "Grid/Adaptation/Highest level=2",
                     "Grid/Adaptation/Buffer=0",
                     "Grid/Adaptation/Hysteresis=0",
                     "Grid/Adaptation/it/Kind=" + kind};
    for (const auto &entry : entries)
      all.push_back("Grid/Adaptation/it/" + entry);
    return all;
  }

  const Overrides small_block = {"Geometry/box/Upper corner=0.5, 0.5",
                                 "Grid/Cells=8, 8"};

  /** Adapts until nothing changes; the cells by their level. */
  template <int dim>
  std::vector<unsigned int>
  adapt(Model<dim> &model)
  {
    AdaptiveGrid<dim> policy(model.scene.faces, model.scene.adaptation);
    for (unsigned int i = 0; i < 6; ++i)
      {
        if (!policy.flag_cells(
              model.grid, model.points, model.rigid, {model.time, i}))
          break;
        EXPECT_LT(i, 5u) << "the grid does not come to rest";
        adapt_grid(model.grid, model.points, model.rigid);
        adapt_points(model.scene.bodies, model.grid, model.points);
      }
    std::vector<unsigned int> levels(4);
    for (const auto &cell : model.grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        ++levels.at(model.grid.level(cell));
    Utilities::MPI::sum(levels, model.grid.communicator, levels);
    return levels;
  }

  using Levels = std::vector<unsigned int>;
} // namespace


TEST(AdaptiveGridMpi, EachCriterionRefinesItsCells)
{
  const auto levels = [](const Overrides &overrides) {
    SCOPED_TRACE(overrides.back());
    Model<2> model(block_scene("plane strain"), small_block + overrides);
    return adapt(model);
  };
  // The body fills 4 x 4 of 8 x 8 cells; two of its sides are free. Beside
  // what is refined there, cells without points are, too.
  const Overrides boxes = {"Grid/Method=GIMP"};
  EXPECT_EQ(levels(criterion("free surface", {"Level=0"})),
            Levels({64, 0, 0, 0}));
  EXPECT_EQ(levels(criterion("free surface", {"Level=1"}) + boxes),
            // 7 cells with points are split, 9 without; 13 of their children
            // lie at the surface, and siblings stay together.
            Levels({48, 64, 0, 0}));
  EXPECT_EQ(levels(criterion("distance", {"Of=left", "Level=1"})),
            Levels({55, 36, 0, 0}));
  EXPECT_EQ(levels(
              criterion("distance", {"Of=top", "Distance=0.13", "Level=1"})),
            Levels({48, 64, 0, 0}));
  EXPECT_EQ(levels(criterion("distance", {"Of=block", "Level=1"})),
            Levels({39, 100, 0, 0}));
  EXPECT_EQ(levels(criterion("expression", {"Expression=if(x<0.5, 1, 0)"})),
            Levels({27, 148, 0, 0}));
  EXPECT_EQ(levels(criterion("expression", {"Expression=9"})),
            Levels({0, 0, 1024, 0}));
  // Points as in cells of half the size.
  EXPECT_EQ(levels(criterion("points") +
                   Overrides{"Bodies/block/Points per cell=4"}),
            Levels({39, 100, 0, 0}));
  EXPECT_EQ(levels(criterion(
              "size",
              {"Field=position", "Component=0", "Above=0.375", "Level=1"})),
            Levels({53, 44, 0, 0}));
  EXPECT_EQ(levels(criterion("gradient",
                             {"Field=position", "Above=0.9", "Level=1"})),
            Levels({39, 100, 0, 0}));
}


// Where no points split, too.
TEST(AdaptiveGridMpi, SurfaceOfPointsThatStay)
{
  Model<2> model(block_scene("plane strain"),
                 small_block + criterion("free surface", {"Level=1"}) +
                   Overrides{"Grid/Method=GIMP",
                             "Bodies/block/Point adaptation=off"});
  EXPECT_EQ(adapt(model), Levels({48, 64, 0, 0}));
}


// Bodies are seeded on the grid that the criteria want, however far that is
// from the first one.
TEST(AdaptiveGridMpi, SeedsOnTheFinestLevel)
{
  const auto scene = scene_from<2>(block_scene("plane strain"),
                                   criterion("distance", {"Of=block"}) +
                                     Overrides{"Grid/Adaptation/Lowest level=2",
                                               "Grid/Method=GIMP",
                                               "Bodies/block/Point adaptation="
                                               "off",
                                               "Time/Largest number of steps=1",
                                               "Boundary conditions/left/Type="
                                               "fixed"});
  const int  id =
    Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
  const auto columns =
    run(scene,
        MPI_COMM_WORLD,
        testing::TempDir() + "impm_seeds_" + std::to_string(id));
  EXPECT_EQ(columns.at("points").back(), 4. * 16 * 16);
  EXPECT_EQ(columns.at("active_cells").back(), 16. * 16);
}


// No node of the material hangs on cells that have none, whatever is asked for.
TEST(AdaptiveGridMpi, CellsBesideMaterialAreAsFine)
{
  for (const std::string level : {"if(sin(9*x + 5*y) > 0, 2, 0)",
                                  "if(max(x, y) < 0.5, 2, 0)",
                                  "if(x < 0.2 && y > 0.2, 2, 0)"})
    {
      SCOPED_TRACE(level);
      Model<2> model(block_scene("plane strain"),
                     small_block +
                       criterion("expression", {"Expression=" + level}) +
                       Overrides{"Geometry/box/Upper corner=0.49, 0.38"});
      EXPECT_GT(adapt(model)[2], 30u);
      const auto &triangulation = model.grid.triangulation;
      const auto  n_points      = [&](const auto &cell) {
        return model.points.sorted.particles.n_particles_in_cell(cell);
      };
      const auto neighbors = GridTools::vertex_to_cell_map(triangulation);
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && n_points(cell) > 0)
          for (const auto v : cell->vertex_indices())
            for (const auto &other : neighbors[cell->vertex_index(v)])
              if (other->is_locally_owned() && n_points(other) == 0)
                {
                  EXPECT_GE(other->level(), cell->level()) << other->center();
                }
    }
}


TEST(AdaptiveGridMpi, BufferAndHysteresisSurround)
{
  const Overrides at_corner =
    criterion("expression", {"Expression=if(max(x, y) < 0.125 + t, 1, 0)"});
  const auto with = [&](const std::string &buffer, const std::string &keep) {
    return small_block + at_corner +
           Overrides{"Grid/Adaptation/Buffer=" + buffer,
                     "Grid/Adaptation/Hysteresis=" + keep};
  };
  Model<2> none(block_scene("plane strain"), with("0", "0")),
    one(block_scene("plane strain"), with("1", "0")),
    kept(block_scene("plane strain"), with("0", "2"));
  EXPECT_EQ(adapt(none), Levels({63, 4, 0, 0}));
  EXPECT_EQ(adapt(one), Levels({60, 16, 0, 0}));
  for (Model<2> *model : {&none, &kept})
    model->time = 0.125;
  EXPECT_EQ(adapt(none), Levels({60, 16, 0, 0}));
  EXPECT_EQ(adapt(kept), Levels({60, 16, 0, 0}));
  for (Model<2> *model : {&none, &kept})
    model->time = 0;
  EXPECT_EQ(adapt(none), Levels({63, 4, 0, 0}));
  EXPECT_EQ(adapt(kept), Levels({60, 16, 0, 0}));
}


// The estimate finds a corner that turns inwards, and the same cells on any
// number of ranks.
TEST(AdaptiveGridMpi, StressErrorFindsTheCorner)
{
  const auto run = [](const MPI_Comm communicator) {
    Model<2>                  model(block_scene("plane strain"),
                   criterion("stress error", {"Tolerance=0.1"}) +
                     Overrides{"Grid/Method=GIMP",
                               "Geometry/Shapes=box, b, both",
                               "Geometry/box/Lower corner=0, 0",
                               "Geometry/box/Upper corner=1, 0.5",
                               "Geometry/b/Lower corner=0, 0.5",
                               "Geometry/b/Upper corner=0.5, 1",
                               "Geometry/both/Kind=union",
                               "Geometry/both/Of=box, b",
                               "Bodies/block/Shape=both",
                               "Grid/Cells=8, 8",
                               "Boundary conditions/left/Type=slip",
                               "Boundary conditions/right/Type=slip",
                               "Boundary conditions/bottom/Type=slip",
                               "Boundary conditions/top/Type=displacement",
                               "Boundary conditions/top/Value=0; -0.05*t"},
                   communicator);
    impm::Vector              u;
    std::vector<unsigned int> levels;
    for (unsigned int step = 0; step < 2; ++step)
      {
        EXPECT_TRUE(model.solve(u).converged);
        model.commit(u);
        model.problem.reset();
        levels = adapt(model);
      }
    double nearest = 1e9;
    for (const auto &cell : model.grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && model.grid.level(cell) == 2)
        nearest = std::min(nearest, cell->center().distance({0.5, 0.5}));
    EXPECT_LT(Utilities::MPI::min(nearest, communicator), 0.07);
    return levels;
  };
  const auto one = run(MPI_COMM_SELF), several = run(MPI_COMM_WORLD);
  EXPECT_EQ(one, several);
  EXPECT_GT(one[0], 10u);
  EXPECT_GT(one[2], 10u);
}


// Whole runs: a body flies with cells that follow its surface, and points that
// split and merge with them.
namespace
{
  template <int dim>
  void
  fly(const std::string &kind, const Overrides &overrides)
  {
    SCOPED_TRACE(kind + ", " + overrides.back());
    Model<dim> model(
      block_scene(kind),
      criterion("free surface", {"Level=1"}) + with_inertia +
        Overrides{"Grid/Method=GIMP",
                  "Bodies/block/Point adaptation=split and merge",
                  "Bodies/block/Points per cell=3",
                  "Grid/Adaptation/Buffer=1",
                  "Time/Time step=0.05"} +
        overrides);
    AdaptiveGrid<dim> policy(model.scene.faces, model.scene.adaptation);
    const auto        start = total(model.points);
    impm::Vector      u;
    PointChanges      changes;
    std::set<int>     cells;
    for (unsigned int step = 0; step < 6; ++step)
      {
        changes.append(
          adapt_points(model.scene.bodies, model.grid, model.points));
        if (policy.flag_cells(
              model.grid, model.points, model.rigid, {model.time, 0}))
          {
            model.problem.reset();
            adapt_grid(model.grid, model.points, model.rigid);
            changes.append(
              adapt_points(model.scene.bodies, model.grid, model.points));
          }
        cells.insert(model.grid.triangulation.n_global_active_cells());
        ASSERT_TRUE(model.solve(u).converged);
        model.commit(u);
      }
    EXPECT_GT(cells.size(), 1u);
    EXPECT_GT(changes.splits + changes.merges, 0u);
    const auto end = total(model.points);
    EXPECT_NEAR(end.mass / start.mass, 1., 1e-13);
    EXPECT_LT((end.momentum - start.momentum).norm(),
              1e-12 * start.momentum.norm());
    EXPECT_NEAR(end.kinetic_energy / start.kinetic_energy, 1., 1e-12);
    EXPECT_NEAR(end.strain_energy, 0., 1e-20);
  }
} // namespace

TEST(AdaptiveGridMpi, FlightKeepsAll)
{
  const Overrides plane = {"Grid/Cells=8, 8",
                           "Geometry/box/Lower corner=0.1, 0.4",
                           "Geometry/box/Upper corner=0.5, 0.75",
                           "Bodies/block/Velocity=0.8; -0.4"};
  fly<2>("plane strain", plane);
  fly<2>("plane stress", plane + Overrides{"Time/Transfer=APIC"});
  fly<3>("3D",
         {"Grid/Cells=8, 8, 8",
          "Bodies/block/Points per cell=2",
          "Geometry/box/Lower corner=0.1, 0.4, 0.3",
          "Geometry/box/Upper corner=0.5, 0.75, 0.6",
          "Bodies/block/Velocity=0.8; -0.4; 0.2"});
}


// Faces that are displaced linearly strain a body uniformly, while cells and
// points come and go.
TEST(AdaptiveGridMpi, PatchStaysUniform)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      Model<2>        model(block_scene("plane strain"),
                     displaced_faces(2, "0.06*t*x + 0.02*t*y; -0.04*t*y") +
                       criterion("expression",
                                 {"Expression=if(abs(x - t) < 0.3, 1, 0)"}) +
                       Overrides{"Grid/Method=" + method,
                                 "Bodies/block/Points per cell=4",
                                 "Bodies/block/Point adaptation=split"});
      AdaptiveGrid<2> policy(model.scene.faces, model.scene.adaptation);
      model.dt = 0.25;
      impm::Vector u;
      for (unsigned int step = 0; step < 3; ++step)
        {
          if (policy.flag_cells(
                model.grid, model.points, model.rigid, {model.time, 0}))
            {
              model.problem.reset();
              adapt_grid(model.grid, model.points, model.rigid);
            }
          adapt_points(model.scene.bodies, model.grid, model.points);
          const auto result = model.solve(u);
          ASSERT_TRUE(result.converged) << result.failure;
          EXPECT_LE(result.iterations, 4u);
          Tensor<2, 3> gradient;
          gradient[0][0]           = 0.06 * model.dt;
          gradient[0][1]           = 0.02 * model.dt;
          gradient[1][1]           = -0.04 * model.dt;
          const Tensor<2, 3> one   = unit_symmetric_tensor<3>();
          double             worst = 0;
          for (unsigned int p = 0; p < model.points.size(); ++p)
            worst = std::max(
              worst,
              (model.problem->response.increment(p) - one - gradient).norm());
          EXPECT_LT(worst, 1e-10) << "step " << step;
          model.time += model.dt;
        }
    }
}


// The points of a rigid body leave no gap between them in the finest cells.
TEST(AdaptiveGridMpi, RigidBodyHasNoGaps)
{
  Model<2> model(block_scene("plane strain"),
                 small_block + criterion("distance", {"Of=wall"}) +
                   Overrides{"Geometry/Shapes=box, wall",
                             "Geometry/wall/Lower corner=0.75, 0",
                             "Geometry/wall/Upper corner=1, 1",
                             "Bodies/Names=block, wall",
                             "Bodies/wall/Kind=rigid",
                             "Bodies/wall/Points per cell=1",
                             "Bodies/wall/Shape=wall",
                             "Bodies/wall/Displacement=-0.1*t; 0"});
  adapt(model);
  model.rigid.move(0, 0.3);
  adapt(model);
  std::set<CellId> touched;
  for (const auto &particle : model.rigid.bodies[0].points->particles)
    touched.insert(particle.get_surrounding_cell()->id());
  for (const auto &cell : model.grid.triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->center()[0] > 0.73 &&
        cell->center()[0] < 0.96)
      EXPECT_EQ(touched.count(cell->id()), 1u) << cell->center();
}


// A run on a grid that follows a face, with points that split: seeded on the
// adapted grid, nothing lost, and near the run on the fine grid.
TEST(AdaptiveGridMpi, RunFollowsFaceAndSurface)
{
  const Overrides press = {"Grid/Method=GIMP",
                           "Grid/Upper corner=1, 0.75",
                           "Geometry/box/Upper corner=0.5, 0.75",
                           "Boundary conditions/left/Type=slip",
                           "Boundary conditions/bottom/Type=slip",
                           "Boundary conditions/top/Type=displacement",
                           "Boundary conditions/top/Value=0; -0.2*t",
                           "Boundary conditions/top/Moves the grid=true",
                           "Time/Time step=0.1",
                           "Output/Reactions=load",
                           "Output/load/On=top",
                           "Output/load/Direction=0, 1",
                           "Output/Probes=corner",
                           "Output/corner/Position=0.48, 0.02"};
  const int       id =
    Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
  const auto go = [&](const Overrides &more) {
    return run(scene_from<2>(block_scene("axisymmetric"), press + more),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_adaptive_" + std::to_string(id));
  };
  const auto fine = go({"Grid/Cells=16, 12"}), coarse = go({"Grid/Cells=8, 6"}),
             adapted =
               go(criterion("free surface", {"Level=1"}) +
                  Overrides{"Grid/Cells=8, 6", "Grid/Adaptation/Buffer=1"});
  const auto last = [](const auto &history, const std::string &column) {
    return history.at(column).back();
  };
  EXPECT_NEAR(last(adapted, "mass") / last(fine, "mass"), 1., 1e-12);
  EXPECT_LT(last(adapted, "active_cells"), last(fine, "active_cells"));
  EXPECT_GT(last(adapted, "active_cells"), last(coarse, "active_cells"));
  EXPECT_NEAR(last(adapted, "load") / last(fine, "load"), 1., 0.01);
  EXPECT_NEAR(last(adapted, "corner") / last(fine, "corner"), 1., 0.01);
  EXPECT_GT(last(adapted, "smallest_points_per_cell"), 3.);
}


// A body in a corner: after sharing the work, ranks have as much of it as whole
// cells allow, and nothing is lost.
TEST(AdaptiveGridMpi, RanksShareTheWork)
{
  Model<2>       model(block_scene("plane strain"),
                 {"Grid/Cells=32, 32", "Geometry/box/Upper corner=0.5, 0.5"});
  LoadBalance<2> balance(model.grid, model.points);
  const auto     n     = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const auto     start = total(model.points);
  EXPECT_GT(balance.imbalance(), n == 1 ? 0.99 : 1.5);
  const auto shares = balance.shares();
  repartition_grid(model.grid, model.points, model.rigid);
  EXPECT_LT(balance.imbalance(), 1.05);
  // Back to what they were.
  balance.impose(shares);
  repartition_grid(model.grid, model.points, model.rigid);
  EXPECT_EQ(balance.shares(), shares);
  EXPECT_NEAR(total(model.points).mass, start.mass, 1e-13);
  impm::Vector u;
  EXPECT_TRUE(model.solve(u).converged);
}


// What no point of a coarse cell lies in is there once these are fine.
TEST(AdaptiveGridMpi, SmallBodyIsFoundWhereTheGridIsFine)
{
  const Overrides small = {"Geometry/box/Lower corner=0.44, 0.44",
                           "Geometry/box/Upper corner=0.49, 0.49"};
  expect_blame(block_scene("plane strain"),
               small,
               "Bodies/block/Shape",
               {"no points"});
  expect_blame(block_scene("plane strain"),
               small + criterion("expression", {"Expression=x > 0.6"}),
               "Bodies/block/Shape",
               {"no points"});
  const auto scene =
    scene_from<2>(block_scene("plane strain"),
                  small +
                    criterion("expression", {"Expression=if(x < 0.6, 3, 0)"}) +
                    Overrides{"Grid/Adaptation/Highest level=3"});
  const int id =
    Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
  const auto history =
    run(scene,
        MPI_COMM_WORLD,
        testing::TempDir() + "impm_small_" + std::to_string(id));
  EXPECT_NEAR(history.at("mass")[0], 0.05 * 0.05, 0.0012);
}


TEST(AdaptiveGrid, BadInputIsRefused)
{
  const auto expect = [](const Overrides &overrides, const std::string &entry) {
    expect_blame(block_scene("plane strain"), overrides, entry, {"allowed"});
  };
  expect(criterion("distance", {"Of=nobody"}), "Grid/Adaptation/it/Of");
  expect_blame(block_scene("plane strain"),
               criterion("size", {"Field=velocity"}),
               "Grid/Adaptation/it/Field",
               {"velocity", "do not have"});
  expect_blame(block_scene("plane strain"),
               criterion("size", {"Component=1"}),
               "Grid/Adaptation/it/Field",
               {"component 1"});
  expect(criterion("size", {"Component=0.5"}), "Grid/Adaptation/it/Component");
  expect(criterion("expression"), "Grid/Adaptation/it/Expression");
  expect_blame(block_scene("plane strain"),
               criterion("expression", {"Expression=sqrt(x - 0.5)"}),
               "Grid/Adaptation/it/Expression",
               {"is not a number at"});
  expect(criterion("free surface") + refined, "Grid/Adaptation/Criteria");
  expect(criterion("free surface") +
           Overrides{"Grid/Adaptation/Lowest level=3"},
         "Grid/Adaptation/Lowest level");
}
