#include <impm/balance/terms/following_loads.h>
#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "expect_blame.h"
#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  const Overrides gas = {"Loads/Tractions=gas",
                         "Loads/gas/Body=block",
                         "Loads/gas/Kind=pressure"};

  const Overrides pull = {"Loads/Tractions=pull", "Loads/pull/Body=block"};

  /** The block is a box inside of the grid, off its lines. */
  template <int dim>
  Overrides
  inside()
  {
    return dim == 2 ? Overrides{"Geometry/box/Lower corner=0.22, 0.3",
                                "Geometry/box/Upper corner=0.8, 0.7"} :
                      Overrides{"Geometry/box/Lower corner=0.22, 0.3, 0.25",
                                "Geometry/box/Upper corner=0.8, 0.7, 0.75"};
  }

  /** The same with corners on lines between points, where none is cut off. */
  template <int dim>
  Overrides
  on_lines()
  {
    return dim == 2 ? Overrides{"Geometry/box/Lower corner=0.25, 0.25",
                                "Geometry/box/Upper corner=0.75, 0.75"} :
                      Overrides{"Geometry/box/Lower corner=0.25, 0.25, 0.25",
                                "Geometry/box/Upper corner=0.75, 0.75, 0.75"};
  }

  template <int dim>
  Tensor<1, dim>
  sum(const Vector &forces)
  {
    Tensor<1, dim> result;
    for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
      result[i % dim] += forces.local_element(i);
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }

  /** Of all loads at an increment (N). */
  template <int dim>
  Vector
  forces_at(const Model<dim> &model, const Vector &u)
  {
    u.update_ghost_values();
    Vector forces = model.vector();
    if (auto &loads = model.problem->following_loads)
      {
        loads->evaluate(u, true);
        loads->add_force(u, forces);
      }
    forces.compress(VectorOperation::add);
    if (const auto &loads = model.problem->loads)
      forces += loads->at_end;
    forces *= -1;
    return forces;
  }

  template <int dim>
  Tensor<1, dim>
  force(const std::string &text, const Overrides &overrides)
  {
    Model<dim> model(text, overrides);
    model.begin_step();
    return sum<dim>(forces_at(model, model.vector()));
  }

  // The difference of forces against their derivative, applied and as blocks.
  template <int dim>
  void
  expect_derivatives(const std::string &text, const Overrides &overrides)
  {
    Model<dim> model(text, overrides);
    model.begin_step();
    auto        &loads     = *model.problem->following_loads;
    const Vector u         = model.random_increment(1, 0.02),
                 direction = model.random_direction(2);
    direction.update_ghost_values();
    const double h     = 1e-4;
    const auto   force = [&](const double part) {
      Vector at = u;
      at.add(part * h, direction);
      auto result = forces_at(model, at);
      result *= -1;
      return result;
    };
    Vector difference = force(1);
    difference -= force(-1);
    difference *= 8;
    difference -= force(2);
    difference += force(-2);
    difference /= 12 * h;
    forces_at(model, u);
    Vector image = model.vector(), by_blocks = model.vector();
    loads.apply(direction, image);
    image.compress(VectorOperation::add);
    loads.add_matrix(false, [&](const auto &nodes, const auto &block) {
      for (unsigned int i = 0; i < block.m(); ++i)
        for (unsigned int j = 0; j < block.n(); ++j)
          by_blocks.local_element(dim * nodes[i / dim] + i % dim) +=
            block(i, j) *
            direction.local_element(dim * nodes[j / dim] + j % dim);
    });
    by_blocks.compress(VectorOperation::add);
    ASSERT_GT(image.linfty_norm(), 1e-3);
    difference -= image;
    by_blocks -= image;
    EXPECT_LT(difference.linfty_norm(), 1e-8 * image.linfty_norm());
    EXPECT_LT(by_blocks.linfty_norm(), 1e-13 * image.linfty_norm());
  }

  std::string
  path_of_run()
  {
    return "/tmp/impm_test_surface_loads_" +
           std::to_string(
             Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                       static_cast<int>(getpid())));
  }
} // namespace


// Whatever the cells and points are.
TEST(SurfaceLoadsMpi, TractionTimesAreaIsTheForce)
{
  for (const auto &more : {Overrides{},
                           Overrides{"Grid/Method=GIMP"},
                           Overrides{"Grid/Cells=8, 8"},
                           Overrides{"Bodies/block/Points per cell=3"},
                           refined})
    {
      const auto on = [&](const std::string &where, const std::string &value) {
        return pull + more +
               Overrides{"Loads/pull/Where=" + where,
                         "Loads/pull/Value=" + value};
      };
      const auto plane =
        force<2>(block_scene("plane strain"), on("x - 0.99", "3; -2*t"));
      EXPECT_LT((plane - Tensor<1, 2>({3, -2})).norm(), 1e-9);
      const auto cut = force<2>(block_scene("plane strain"),
                                on("x - 0.74", "3; -2*t") + on_lines<2>());
      EXPECT_LT((cut - 0.5 * Tensor<1, 2>({3, -2})).norm(), 1e-9);
      // Corners between the lines are cut off in small parts alone.
      const auto off = force<2>(block_scene("plane strain"),
                                on("x - 0.799", "3; -2*t") + inside<2>());
      EXPECT_LT((off - 0.4 * Tensor<1, 2>({3, -2})).norm(), 0.02);
      const auto hoop =
        force<2>(block_scene("axisymmetric"), on("x - 0.99", "0; 5"));
      EXPECT_LT(std::abs(hoop[1] - 10 * numbers::PI), 1e-8);
      const auto disc =
        force<2>(block_scene("axisymmetric"), on("y - 0.99", "0; 5"));
      EXPECT_LT(std::abs(disc[1] - 5 * numbers::PI), 1e-8);
    }
  const auto solid = force<3>(block_scene("3D"),
                              pull + Overrides{"Loads/pull/Where=y - 0.99",
                                               "Loads/pull/Value=1; 2; -3"});
  EXPECT_LT((solid - Tensor<1, 3>({1, 2, -3})).norm(), 1e-9);
}


TEST(SurfaceLoadsMpi, PressureOnAllSidesIsBuoyancy)
{
  const auto at = [](const std::string &value) {
    return gas + Overrides{"Loads/gas/Value=" + value};
  };
  EXPECT_LT(
    force<2>(block_scene("plane strain"), at("3") + on_lines<2>()).norm(),
    1e-9);
  const auto plane =
    force<2>(block_scene("plane strain"), at("2*(1 - y)") + on_lines<2>());
  EXPECT_LT((plane - Tensor<1, 2>({0, 2 * 0.25})).norm(), 1e-9);
  const auto solid =
    force<3>(block_scene("3D"), at("2*(1 - z)") + on_lines<3>());
  EXPECT_LT((solid - Tensor<1, 3>({0, 0, 2 * 0.125})).norm(), 1e-9);
}


TEST(SurfaceLoadsMpi, PressureFollowsTheSurface)
{
  // Stretched by 1.2 along x, a wall at the end along y is as large as before,
  // the one along x larger.
  Model<2> model(block_scene("plane strain"),
                 gas +
                   Overrides{"Loads/gas/Where=y - 0.99", "Loads/gas/Value=3"});
  model.begin_step();
  Tensor<2, 2> gradient;
  gradient[0][0] = 0.2;
  gradient[1][0] = 0.1; // and inclined
  const auto u   = model.linear_field(gradient);
  EXPECT_LT((sum<2>(forces_at(model, u)) - Tensor<1, 2>({0.3, -3.6})).norm(),
            1e-9);
}


TEST(SurfaceLoadsMpi, DerivativesOfPressure)
{
  const Overrides value = {"Loads/gas/Value=0.3 + 0.2*y - 0.4*x*t"};
  for (const std::string kind : {"plane strain", "axisymmetric"})
    expect_derivatives<2>(block_scene(kind), gas + value + inside<2>());
  expect_derivatives<2>(block_scene("plane strain"),
                        gas + value + inside<2>() + refined);
  expect_derivatives<2>(block_scene("plane strain"),
                        gas + value + inside<2>() +
                          Overrides{"Loads/gas/Coordinates=initial",
                                    "Grid/Method=GIMP"});
  expect_derivatives<3>(block_scene("3D"), gas + value + inside<3>());
}


TEST(SurfaceLoadsMpi, DerivativesOnLagrangianFaces)
{
  const Overrides faces = {"Grid/Method=Lagrangian",
                           "Boundary conditions/right/Type=pressure",
                           "Boundary conditions/right/Value=0.3 + 0.2*y*t",
                           "Boundary conditions/top/Type=pressure",
                           "Boundary conditions/top/Value=0.1"};
  for (const std::string kind : {"plane strain", "axisymmetric"})
    expect_derivatives<2>(block_scene(kind), faces);
  expect_derivatives<3>(block_scene("3D"), faces);
}


TEST(SurfaceLoadsMpi, DerivativesAndMomentOfATorque)
{
  const Overrides twist = {"Loads/Tractions=twist",
                           "Loads/twist/Body=block",
                           "Loads/twist/Kind=torque",
                           "Loads/twist/Value=0.7*t"};
  const auto      plane = twist + inside<2>() +
                     Overrides{"Loads/twist/About=0.4, "
                               "0.5"};
  expect_derivatives<2>(block_scene("plane strain"), plane);
  const auto solid =
    twist + inside<3>() +
    Overrides{"Loads/twist/About=0.4, 0.5, 0.5", "Loads/twist/Axis=1, 2, 2"};
  expect_derivatives<3>(block_scene("3D"), solid);

  // At any increment: what a small turn about the axis works.
  Model<3> model(block_scene("3D"), solid);
  model.begin_step();
  const Tensor<1, 3> axis({1. / 3, 2. / 3, 2. / 3});
  const Point<3>     about(0.4, 0.5, 0.5);
  const auto  u = model.linear_field(0.1 * outer_product(axis, axis), about);
  const auto  forces = forces_at(model, u);
  double      moment = 0;
  const auto &places = model.grid.discretization()->node_positions;
  for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
    {
      Point<3> place = places[i / 3];
      for (unsigned int d = 0; d < 3; ++d)
        place[d] += u.local_element(3 * (i / 3) + d);
      moment +=
        cross_product_3d(axis, place - about)[i % 3] * forces.local_element(i);
    }
  EXPECT_NEAR(Utilities::MPI::sum(moment, MPI_COMM_WORLD), 0.7, 1e-9);
}


TEST(SurfaceLoadsMpi, PiecesThatSplitCarryAsMuch)
{
  Model<3> model(block_scene("3D"),
                 pull + inside<3>() +
                   Overrides{"Loads/pull/Value=1 + x; 2*y; 3 + z",
                             "Loads/pull/Coordinates=initial",
                             "Bodies/block/Point adaptation=split"});
  model.begin_step();
  const auto before = sum<3>(forces_at(model, model.vector()));
  const auto n_first =
    Utilities::MPI::sum(model.surfaces->size(), MPI_COMM_WORLD);
  // Longer on their own, as if stretched.
  for (unsigned int s = 0; s < model.surfaces->size(); ++s)
    {
      auto edges = model.surfaces->edges(s);
      for (auto &edge : edges)
        edge *= 3;
      model.surfaces->set_edges(s, edges);
    }
  model.surfaces->split();
  EXPECT_GT(Utilities::MPI::sum(model.surfaces->size(), MPI_COMM_WORLD),
            2 * n_first);
  model.begin_step();
  EXPECT_LT((sum<3>(forces_at(model, model.vector())) - before).norm(), 1e-9);
}


TEST(SurfaceLoadsMpi, PushAFreeBody)
{
  const std::vector<Overrides> schemes = {
    {"Time/Integrator=theta"},
    {"Time/Integrator=theta", "Time/Theta=0.5", "Grid/Method=GIMP"},
    {"Time/Integrator=Newmark"},
    {"Time/Integrator=energy-momentum"},
    {"Time/Integrator=explicit", "Grid/Method=GIMP"},
    {"Time/Integrator=explicit", "Time/Formulation=momentum"}};
  for (const auto &scheme : schemes)
    {
      SCOPED_TRACE(scheme.front() + ", " + scheme.back());
      const auto columns =
        run(scene_from<2>(block_scene("plane strain"),
                          scheme + Overrides{"Loads/Tractions=pull",
                                             "Loads/pull/Body=block",
                                             "Loads/pull/Where=x - 0.99",
                                             "Loads/pull/Value=0.02; 0",
                                             "Grid/Lower corner=-1, -1",
                                             "Grid/Upper corner=3, 3",
                                             "Grid/Cells=16, 16",
                                             "Solver/Newton tolerance=1e-10",
                                             "Time/Time step=0.125",
                                             "Time/End time=1"}),
            MPI_COMM_WORLD,
            path_of_run());
      EXPECT_NEAR(columns.at("momentum_x").back(), 0.02, 1e-9);
      EXPECT_NEAR(columns.at("momentum_y").back(), 0., 1e-9);
      EXPECT_GT(columns.at("external_work").back(), 1e-4);
    }
}


// On one of the ranks.
TEST(SurfaceLoadsMpi, MustBeNumbers)
{
  for (const Overrides &load :
       {gas + Overrides{"Loads/gas/Value=log(0.9 - y)"},
        pull + Overrides{"Loads/pull/Value=0; log(0.9 - y)"}})
    {
      Model<2> model(block_scene("plane strain"), load);
      EXPECT_THROW(model.begin_step(), ComputationError);
    }
}


TEST(SurfaceLoads, AreRefused)
{
  const auto blame = [](const Overrides   &overrides,
                        const std::string &entry,
                        const std::string &word) {
    expect_blame(block_scene("plane strain"),
                 pull + Overrides{"Loads/pull/Value=1; 0"} + overrides,
                 entry,
                 {word});
  };
  blame({"Loads/pull/Where=x - 1.5"}, "Loads/pull/Where", "no part");
  // What a face holds is no surface.
  blame({"Loads/pull/Where=x - 0.99", "Boundary conditions/right/Type=slip"},
        "Loads/pull/Where",
        "no part");
  blame({"Loads/pull/Value="}, "Loads/pull/Value", "''");
  blame({"Loads/pull/Body=rock"}, "Loads/pull/Body", "block");
  blame({"Grid/Method=Lagrangian"}, "Loads/Tractions", "faces");
  blame({"Grid/Reset=interval"}, "Loads/pull/Acts on", "points");
  blame({"Loads/pull/Kind=torque", "Loads/pull/Value=x"},
        "Loads/pull/Value",
        "function of t");
  blame({"Loads/pull/Kind=torque",
         "Loads/pull/Value=1",
         "Geometry/Kind=axisymmetric"},
        "Loads/pull/Kind",
        "pressure");
  blame({"Loads/pull/Kind=pressure",
         "Loads/pull/Value=1",
         "Solver/Linear solver=CG"},
        "Solver/Linear solver",
        "GMRES");
}
