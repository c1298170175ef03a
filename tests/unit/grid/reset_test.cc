#include <impm/output/history.h>

#include <gtest/gtest.h>

#include "expect_blame.h"
#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

// Nodes that keep their motion from step to step, until the grid is reset.
namespace
{
  const Overrides seldom = {"Grid/Reset=interval",
                            "Grid/Steps between resets=3",
                            "Grid/Largest motion=100"};

  // Of point p: 1 + sum_I u_I grad S_pI, with slopes of some step.
  template <int dim>
  std::vector<Tensor<2, dim>>
  deformations(const Footprints<dim> &footprints, const impm::Vector &u)
  {
    std::vector<Tensor<2, dim>> result(footprints.first.size() - 1);
    for (const auto &cell : footprints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              result[footprints.point[e]][c][d] +=
                u.local_element(dim * cell.nodes[n] + c) *
                footprints.gradient(e)[n * dim + d];
    return result;
  }

  /**
   * Two steps of any motion: slopes are those with respect to the nodes where
   * they are, and F is that of the whole motion with the slopes of the start.
   */
  template <int dim>
  void
  move_twice(const std::string &kind, const Overrides &overrides)
  {
    SCOPED_TRACE(kind + ", " + overrides.back());
    Model<dim> model(block_scene(kind), seldom + overrides);
    model.scatter_points(1);
    model.begin_step();
    const Footprints<dim> start    = model.problem->footprints;
    const double          size     = 0.02;
    auto                  together = model.vector();
    for (unsigned int step = 0; step < 2; ++step)
      {
        model.begin_step();
        auto u = model.random(7 + step, size);
        model.problem->discretization->interpolate_hanging(u);
        ASSERT_TRUE(model.balance().evaluate(u).admissible);
        model.commit(u);
        together += u;
      }
    together.update_ghost_values();
    model.begin_step();
    const auto  &now    = model.problem->footprints;
    const auto   nodes  = model.grid.discretization()->node_positions;
    impm::Vector places = model.vector();
    for (unsigned int i = 0; i < places.locally_owned_size(); ++i)
      places.local_element(i) = nodes[i / dim][i % dim];
    places.update_ghost_values();
    const auto   unity = deformations(now, places);
    const auto   whole = deformations(start, together);
    unsigned int p     = 0;
    for (const auto &particle : model.points.sorted.particles)
      {
        const Tensor<2, dim> one(unit_symmetric_tensor<dim>());
        // The mean slope of a box that reaches over moved cells sees places
        // that do not change linearly.
        EXPECT_LT((unity[p] - one).norm(), 1e-12) << particle.get_location();
        const auto F = deformation_gradient(model.points, p);
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            EXPECT_NEAR(F[c][d], one[c][d] + whole[p][c][d], 1e-12);
        if (kind == "axisymmetric")
          {
            const double r = 1 / now.inverse_radius[p];
            EXPECT_NEAR(F[2][2], r * start.inverse_radius[p], 1e-12);
          }
        ++p;
      }
  }

  template <int dim>
  Columns
  go(const std::string &kind, const Overrides &overrides)
  {
    const int id =
      Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
    return run(scene_from<dim>(block_scene(kind), overrides),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_reset_" + std::to_string(id));
  }
} // namespace


TEST(GridResetMpi, DeformationIsThatOfTheWholeMotion)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      const Overrides choice = {"Grid/Method=" + method};
      move_twice<2>("plane strain", choice + refined);
      move_twice<2>("axisymmetric",
                    Overrides{"Grid/Lower corner=0.5, 0",
                              "Grid/Upper corner=1.5, 1",
                              "Geometry/box/Lower corner=0.5, 0",
                              "Geometry/box/Upper corner=1.5, 1"} +
                      choice);
      move_twice<3>("3D", choice);
    }
}


// A body that flies over several cells between two resets, over ranks.
TEST(GridResetMpi, FlightKeepsAll)
{
  const auto fly = [](const std::string &kind, const Overrides &more) {
    SCOPED_TRACE(more.back());
    const auto history = go<2>(kind,
                               with_inertia + seldom +
                                 Overrides{"Grid/Cells=32, 32",
                                           "Geometry/box/Lower corner=0.1, 0.4",
                                           "Geometry/box/Upper corner=0.3, 0.6",
                                           "Bodies/block/Velocity=0.6; -0.3",
                                           "Time/Time step=0.1"} +
                                 more);
    for (const std::string column :
         {"mass", "momentum_x", "momentum_y", "kinetic_energy"})
      {
        const auto &values = history.at(column);
        for (const double value : values)
          EXPECT_NEAR(value / values[0], 1., 1e-11) << column;
      }
    EXPECT_NEAR(history.at("strain_energy").back(), 0., 1e-20);
  };
  for (const std::string transfer : {"FLIP", "PIC", "APIC"})
    fly("plane strain", {"Grid/Method=GIMP", "Time/Transfer=" + transfer});
  fly("plane strain", refined);
  fly("plane strain", {"Time/Integrator=explicit", "Time/Time step=0.01"});
  fly("plane stress",
      {"Time/Integrator=Newmark", "Time/Acceleration from=points"});
  fly("plane strain",
      {"Grid/Method=GIMP",
       "Bodies/block/Point adaptation=split and merge",
       "Grid/Adaptation/Criteria=surface",
       "Grid/Adaptation/surface/Kind=free surface",
       "Grid/Adaptation/Highest level=1",
       "Grid/Cells=16, 16"});
}


// Faces that are displaced linearly strain a body uniformly.
TEST(GridResetMpi, PatchStaysUniform)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      Model<2> model(block_scene("plane strain"),
                     displaced_faces(2, "0.06*t*x + 0.02*t*y; -0.04*t*y") +
                       seldom + refined + Overrides{"Grid/Method=" + method});
      model.dt = 0.25;
      impm::Vector u;
      for (unsigned int step = 0; step < 3; ++step)
        {
          const auto result = model.solve(u);
          ASSERT_TRUE(result.converged) << result.failure;
          EXPECT_LE(result.iterations, 4u);
          model.commit(u);
        }
      const auto first = deformation_gradient(model.points, 0);
      for (unsigned int p = 0; p < model.points.size(); ++p)
        EXPECT_LT((deformation_gradient(model.points, p) - first).norm(),
                  1e-10);
    }
}


// The first reset comes after the step that exceeds the measure.
TEST(GridResetMpi, ResetsByDistortion)
{
  const Overrides stretched = {"Geometry/box/Upper corner=0.5, 0.5",
                               "Grid/Cells=8, 8",
                               "Boundary conditions/left/Type=slip",
                               "Boundary conditions/bottom/Type=slip",
                               "Loads/Body force=0.4*x*t; 0",
                               "Time/Time step=0.1",
                               "Output/Probes=width",
                               "Output/width/Kind=extent",
                               "Grid/Reset=distortion"};
  const auto      every     = go<2>("plane strain",
                           stretched + Overrides{"Grid/Reset=every step"}),
             some =
               go<2>("plane strain",
                     stretched + Overrides{"Grid/Largest distortion=0.05"}),
             often =
               go<2>("plane strain",
                     stretched + Overrides{"Grid/Largest distortion=1e-6"});
  EXPECT_NEAR(some.at("width").back() / every.at("width").back(), 1., 5e-3);
  expect_near(every, often);
}


// Into cells an eighth as large, whatever the rank.
TEST(GridResetMpi, FlightIntoFinerCells)
{
  for (const std::string steps : {"5", "100"})
    {
      const auto history =
        go<2>("plane strain",
              with_inertia + seldom +
                Overrides{"Grid/Steps between resets=" + steps,
                          "Grid/Cells=16, 16",
                          "Grid/Local refinements=3",
                          "Grid/Refine where=x - 0.6",
                          "Geometry/box/Lower corner=0.1, 0.1",
                          "Geometry/box/Upper corner=0.3, 0.3",
                          "Bodies/block/Velocity=0.55; 0.5",
                          "Time/Time step=0.09",
                          "Time/End time=0.9"});
      const auto &energy = history.at("kinetic_energy");
      EXPECT_NEAR(energy.back() / energy[0], 1., 1e-11) << steps;
    }
}


// Two bodies fly at each other, an empty cell between them: neither is in the
// other when they meet.
TEST(GridResetMpi, BodiesDoNotPassIntoEachOther)
{
  const Overrides two     = {"Grid/Cells=20, 20",
                             "Geometry/Shapes=box, other",
                             "Geometry/box/Lower corner=0.1, 0.4",
                             "Geometry/box/Upper corner=0.3, 0.6",
                             "Geometry/other/Lower corner=0.35, 0.4",
                             "Geometry/other/Upper corner=0.55, 0.6",
                             "Bodies/Names=block, second",
                             "Bodies/second/Shape=other",
                             "Bodies/second/Material=rubber",
                             "Bodies/block/Velocity=0.03; 0",
                             "Bodies/second/Velocity=-0.03; 0",
                             "Time/Time step=0.02",
                             "Output/Probes=one, two",
                             "Output/one/Kind=mean",
                             "Output/one/Field=displacement",
                             "Output/one/Component=0",
                             "Output/one/Bodies=block",
                             "Output/two/Kind=mean",
                             "Output/two/Field=displacement",
                             "Output/two/Component=0",
                             "Output/two/Bodies=second",
                             "Grid/Reset=distortion"};
  const auto      history = go<2>("plane strain", with_inertia + two);
  for (unsigned int i = 0; i < history.at("one").size(); ++i)
    // They are compressed a little, too.
    EXPECT_LT(history.at("one")[i] - history.at("two")[i], 0.05 + 0.01);
  expect_blame(block_scene("plane strain"),
               two + Overrides{"Grid/Largest motion=1"},
               "Grid/Largest motion",
               {"0.5", "several bodies"});
}


TEST(GridReset, BadInputIsRefused)
{
  expect_blame(block_scene("plane strain"),
               seldom + with_inertia + Overrides{"Time/Formulation=momentum"},
               "Time/Formulation",
               {"allowed", "velocity", "Grid/Reset"});
}
