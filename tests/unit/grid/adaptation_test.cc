#include <impm/base/exceptions.h>
#include <impm/output/history.h>

#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  // Before every step, cells whose centre makes a function of place and time
  // positive are split once, others are as coarse as they were at the start.
  template <int dim>
  class SplitWhere : public GridPolicy<dim>
  {
  public:
    using Where = std::function<double(const Point<dim> &, double time)>;

    SplitWhere(const Faces<dim> &faces, Where where)
      : GridPolicy<dim>(faces)
      , where(std::move(where))
    {}

    bool
    flag_cells(BackgroundGrid<dim> &grid,
               const MaterialPoints<dim> &,
               const RigidBodies<dim> &,
               const PolicyTime &now) override
    {
      auto &triangulation = grid.triangulation;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && start_level == 0)
          start_level = cell->level();
      start_level = Utilities::MPI::max(start_level, grid.communicator);
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            if (cell->level() == start_level &&
                where(cell->center(), now.time) > 0)
              cell->set_refine_flag();
            if (cell->level() > start_level &&
                where(cell->center(), now.time) <= 0)
              cell->set_coarsen_flag();
          }
      return true;
    }

  private:
    const Where where;
    int         start_level = 0;
  };

  // A strip that sweeps over the grid.
  template <int dim>
  double
  sweep(const Point<dim> &x, const double time)
  {
    return 0.3 - std::abs(x[0] - 0.25 * std::round(4 * time));
  }

  template <int dim>
  void
  adapt(Model<dim> &model, SplitWhere<dim> &policy)
  {
    ASSERT_TRUE(policy.flag_cells(
      model.grid, model.points, model.rigid, {model.time, 0}));
    const auto n         = model.points.sorted.n_global();
    const auto numbering = model.grid.discretization()->numbering;
    model.problem.reset();
    adapt_grid(model.grid, model.points, model.rigid);
    EXPECT_EQ(model.points.sorted.n_global(), n);
    EXPECT_NE(model.grid.discretization()->numbering, numbering);
  }

  const Overrides boxes = {"Grid/Method=GIMP"};
} // namespace


// A body that flies keeps mass, momentum and its uniform velocity, whatever
// the grid does under it.
template <int dim>
void
fly(const std::string &kind, const Overrides &overrides)
{
  SCOPED_TRACE(kind);
  Model<dim>      model(block_scene(kind),
                   overrides + Overrides{"Grid/Cells=8, 8" +
                                           std::string(dim == 3 ? ", 8" : ""),
                                         "Time/Integrator=theta",
                                         "Time/Time step=0.05"});
  SplitWhere<dim> policy(model.scene.faces, sweep<dim>);
  const auto      start = total(model.points);
  impm::Vector    u;
  unsigned int    smallest = -1, largest = 0;
  for (unsigned int step = 0; step < 6; ++step)
    {
      adapt(model, policy);
      const auto n      = model.grid.triangulation.n_global_active_cells();
      smallest          = std::min<unsigned int>(smallest, n);
      largest           = std::max<unsigned int>(largest, n);
      const auto result = model.solve(u);
      ASSERT_TRUE(result.converged) << result.failure;
      model.commit(u);
      const auto now = total(model.points);
      EXPECT_NEAR(now.mass / start.mass, 1., 1e-14);
      EXPECT_LT((now.momentum - start.momentum).norm(),
                1e-12 * start.momentum.norm());
    }
  EXPECT_GT(largest, smallest);
  EXPECT_GT(model.problem->discretization->numbering->dof_handler.n_dofs(), 0u);
  for (unsigned int p = 0; p < model.points.size(); ++p)
    for (unsigned int d = 0; d < dim; ++d)
      EXPECT_NEAR(model.points.velocity(p)[d],
                  d == 0 ? 0.4 :
                  d == 1 ? -0.2 :
                           0.1,
                  1e-12);
  EXPECT_NEAR(total(model.points).strain_energy, 0., 1e-24);
}

TEST(AdaptationMpi, FlightKeepsMassAndMomentum)
{
  const Overrides plane = {"Geometry/box/Lower corner=0.1, 0.4",
                           "Geometry/box/Upper corner=0.5, 0.75",
                           "Bodies/block/Velocity=0.4; -0.2"};
  fly<2>("plane strain", plane);
  fly<2>("plane strain", plane + boxes);
  fly<2>("plane strain",
         plane + boxes +
           Overrides{"Time/Integrator=Newmark",
                     "Time/Acceleration from=points",
                     "Time/Transfer=APIC"});
  const Overrides space = {"Geometry/box/Lower corner=0.1, 0.4, 0.3",
                           "Geometry/box/Upper corner=0.5, 0.75, 0.6",
                           "Bodies/block/Velocity=0.4; -0.2; 0.1"};
  fly<3>("3D", space);
  fly<3>("3D", space + boxes);
}


// Faces that are displaced linearly strain a body that fills the grid
// uniformly, step by step, while cells come and go. Points at mirror-symmetric
// places keep the quadrature exact on every grid.
template <int dim>
void
stretch(const std::string &kind, const Overrides &overrides)
{
  std::string all = kind;
  for (const auto &override : overrides)
    all += ", " + override;
  SCOPED_TRACE(all);
  const std::string value = dim == 2 ?
                              "0.06*t*x + 0.02*t*y; -0.04*t*y" :
                              "0.06*t*x + 0.02*t*y; -0.04*t*y; 0.03*t*z";
  Model<dim>        model(block_scene(kind),
                   displaced_faces(dim, value) + overrides +
                     Overrides{"Bodies/block/Points per cell=4"});
  SplitWhere<dim>   policy(model.scene.faces, sweep<dim>);
  model.dt = 0.25;
  impm::Vector u;
  for (unsigned int step = 0; step < 3; ++step)
    {
      adapt(model, policy);
      const auto result = model.solve(u);
      ASSERT_TRUE(result.converged) << result.failure;
      Tensor<2, 3> gradient;
      gradient[0][0] = 0.06 * model.dt;
      gradient[0][1] = 0.02 * model.dt;
      gradient[1][1] = -0.04 * model.dt;
      if (dim == 3)
        gradient[2][2] = 0.03 * model.dt;
      const Tensor<2, 3> one     = unit_symmetric_tensor<3>();
      double             largest = 0;
      for (unsigned int p = 0; p < model.points.size(); ++p)
        largest = std::max(
          largest,
          (model.problem->response.increment(p) - one - gradient).norm());
      EXPECT_LT(largest, 1e-10) << "step " << step;
      // The points stay: so does the body in the grid.
      model.time += model.dt;
    }
}

TEST(AdaptationMpi, UniformStrainStaysUniform)
{
  stretch<2>("plane strain", {});
  stretch<2>("plane strain", boxes);
  stretch<2>("plane strain",
             plastic + Overrides{"Materials/rubber/F-bar=true"} + boxes);
  stretch<3>("3D", {"Bodies/block/Points per cell=4"});
}


// Points in the middle of a cell lie on the new faces when it is split.
TEST(AdaptationMpi, PointsOnNewFacesStay)
{
  for (const std::string kind : {"plane strain", "axisymmetric"})
    for (const std::string n : {"1", "3", "2"})
      {
        SCOPED_TRACE(kind + n);
        Model<2>      model(block_scene(kind),
                       Overrides{"Bodies/block/Points per cell=" + n,
                                 "Boundary conditions/left/Type=fixed",
                                 "Time/Integrator=theta",
                                 "Boundary conditions/bottom/Type=fixed",
                                 "Geometry/Shapes=box, wall",
                                 "Geometry/box/Upper corner=0.75, 1",
                                 "Geometry/wall/Lower corner=0.75, 0",
                                 "Geometry/wall/Upper corner=1, 1",
                                 "Bodies/Names=block, wall",
                                 "Bodies/wall/Kind=rigid",
                                 "Bodies/wall/Shape=wall",
                                 "Bodies/wall/Points per cell=" + n,
                                 "Bodies/wall/Displacement=-0.02*t; 0"});
        SplitWhere<2> policy(model.scene.faces, sweep<2>);
        const auto    rigid = model.rigid.bodies[0].points->n_global();
        model.dt            = 0.25;
        impm::Vector u;
        for (unsigned int step = 0; step < 4; ++step)
          {
            adapt(model, policy);
            EXPECT_EQ(model.rigid.bodies[0].points->n_global(), rigid);
            const auto result = model.solve(u);
            ASSERT_TRUE(result.converged) << result.failure;
            model.commit(u);
            model.rigid.move(model.time - model.dt, model.time);
          }
        EXPECT_GT(total(model.points).strain_energy, 1e-6);
      }
}


// A whole run whose policy adapts: nothing else had to know.
TEST(AdaptationMpi, RunGoesOnOnOtherGrids)
{
  const auto scene = scene_from<2>(block_scene("axisymmetric"),
                                   {"Geometry/box/Upper corner=0.5, 0.75",
                                    "Grid/Cells=8, 8",
                                    "Boundary conditions/left/Type=slip",
                                    "Boundary conditions/bottom/Type=fixed",
                                    "Loads/Body force=0; -0.05*t",
                                    "Time/Time step=0.2",
                                    "Output/Probes=down",
                                    "Output/down/Position=0.4, 0.7",
                                    "Output/down/Component=1",
                                    "Solver/Newton tolerance=1e-10"});
  const int  id =
    Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
  const std::string directory =
    testing::TempDir() + "impm_adaptation_" + std::to_string(id);
  const auto fixed = run(scene, MPI_COMM_WORLD, directory);
  const auto adapted =
    run<2>(scene,
           MPI_COMM_WORLD,
           directory,
           std::make_unique<SplitWhere<2>>(scene.faces, sweep<2>));
  ASSERT_EQ(adapted.at("step").size(), 5u);
  EXPECT_NE(adapted.at("active_cells").back(), fixed.at("active_cells").back());
  EXPECT_NE(adapted.at("active_cells").front(),
            adapted.at("active_cells").back());
  EXPECT_NEAR(adapted.at("mass").back() / fixed.at("mass").back(), 1., 1e-12);
  // Finer cells in places: the same within the error of the coarse ones.
  EXPECT_LT(fixed.at("down").back(), -1e-3);
  EXPECT_NEAR(adapted.at("down").back() / fixed.at("down").back(), 1., 0.1);
}


TEST(AdaptationMpi, LagrangianGridKeepsItsCells)
{
  Model<2> model(block_scene("plane strain"), {"Grid/Method=Lagrangian"});
  EXPECT_THROW(adapt_grid(model.grid, model.points, model.rigid),
               ComputationError);
}
