#include <impm/grid/rigid_motion.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  template <int dim>
  RigidMotion<dim>
  some_motion()
  {
    Point<dim>     centre;
    Tensor<1, dim> shift;
    for (unsigned int d = 0; d < dim; ++d)
      {
        centre[d] = 0.3 - 0.2 * d;
        shift[d]  = 0.7 * d - 0.1;
      }
    RotationVector rotation;
    rotation[2] = 0.9;
    if (dim == 3)
      rotation[0] = -0.5;
    return {centre, shift, rotation};
  }

  template <int dim>
  Point<dim>
  some_place()
  {
    Point<dim> place;
    for (unsigned int d = 0; d < dim; ++d)
      place[d] = 1.1 - 0.4 * d * d;
    return place;
  }

  template <int dim>
  void
  check_maps()
  {
    const auto motion = some_motion<dim>();
    const auto x      = some_place<dim>();
    const auto y      = motion(x);
    EXPECT_LT(motion.inverse(y).distance(x), 1e-15);
    EXPECT_LT((motion.increment_to(y) - motion.increment(x)).norm(), 1e-15);
    EXPECT_LT(motion(motion.centre).distance(motion.centre + motion.shift),
              1e-16);
    const auto R = motion.rotation();
    EXPECT_LT((R * transpose(R) - unit_symmetric_tensor<dim>()).norm(), 1e-15);
    EXPECT_NEAR(determinant(R), 1, 1e-15);
    EXPECT_LT((motion.turn(x) - R * x).norm(), 1e-15);
    const RigidMotion<dim> again(motion.centre,
                                 motion.shift,
                                 motion.rotation_vector());
    EXPECT_LT((again.turning - motion.turning).norm(), 1e-15);
  }
} // namespace


TEST(RigidMotion, ThereAndBack)
{
  check_maps<2>();
  check_maps<3>();
  const RigidMotion<2> quarter({1, 0},
                               Tensor<1, 2>({0, 3}),
                               RotationVector({0, 0, numbers::PI / 2}));
  EXPECT_LT(quarter(Point<2>(2, 0)).distance(Point<2>(1, 4)), 1e-15);
  const RigidMotion<3> about_x({0, 0, 0},
                               Tensor<1, 3>(),
                               RotationVector({numbers::PI / 2, 0, 0}));
  EXPECT_LT(about_x(Point<3>(1, 2, 0)).distance(Point<3>(1, 0, 2)), 1e-15);
}


// What turns by little loses no digits, what does not turn is shifted to the
// last one.
TEST(RigidMotion, LittleAndNothing)
{
  const double         angle = 1e-12;
  const RigidMotion<2> little({0, 0}, {}, RotationVector({0, 0, angle}));
  EXPECT_NEAR(little.increment(Point<2>(1, 0))[1] / angle, 1, 1e-15);
  EXPECT_NEAR(little.rotation_vector()[2] / angle, 1, 1e-15);
  const Tensor<1, 2>   shift({0.1, -1e-9});
  const RigidMotion<2> straight({0.3, 0.7}, shift);
  EXPECT_FALSE(straight.turns());
  EXPECT_EQ(straight.increment({1. / 3, 17.}), shift);
  EXPECT_EQ(straight.increment_to({1. / 3, 17.}), shift);
}


TEST(RigidMotion, RotationsInThePlaneAndInSpace)
{
  const Tensor<1, 2>   arm({0.3, 0.4}), force({-2, 1});
  const RotationVector rate({0, 0, 5});
  EXPECT_EQ(moment_of(arm, force)[2], 0.3 + 0.8);
  EXPECT_LT((cross(rate, arm) - Tensor<1, 2>({-2, 1.5})).norm(), 1e-15);
  const Tensor<1, 3> arm_3({0.3, 0.4, 0}), force_3({-2, 1, 0});
  EXPECT_EQ(moment_of(arm_3, force_3)[2], 0.3 + 0.8);
  EXPECT_LT((cross(rate, arm_3) - Tensor<1, 3>({-2, 1.5, 0})).norm(), 1e-15);
}


// Of the time from one instant to another, which may have another centre.
TEST(RigidMotionMpi, OfABodyBetweenTwoTimes)
{
  Model<2>       model(block_scene("plane strain"),
                 Overrides{"Geometry/Shapes=box, inner",
                           "Geometry/box/Upper corner=0.5, 1",
                           "Geometry/inner/Lower corner=0.6, 0.4",
                           "Geometry/inner/Upper corner=0.8, 0.6",
                           "Bodies/Names=block, tool",
                           "Bodies/tool/Kind=rigid",
                           "Bodies/tool/Shape=inner",
                           "Bodies/tool/Displacement=0.01*t^2; -0.02*t",
                           "Bodies/tool/Rotation=0.3*t",
                           "Bodies/tool/Centre=0.6, 0.5"});
  const auto    &body = model.rigid.bodies[0];
  const Point<2> x(0.8, 0.6);
  const auto     direct = body.motion(0, 2)(x);
  EXPECT_LT(body.motion(1, 2)(body.motion(0, 1)(x)).distance(direct), 1e-15);
  EXPECT_NEAR(body.angle(2), 0.6, 1e-15);

  std::map<types::particle_index, Point<2>> before;
  for (const auto &particle : body.points->particles)
    before[particle.get_id()] = particle.get_location();
  model.rigid.move(0, 1);
  EXPECT_LE(0.04, model.rigid.largest_displacement(0, 1));
  EXPECT_LE(model.rigid.largest_displacement(0, 1), 0.1);
  for (const auto &particle : body.points->particles)
    if (const auto it = before.find(particle.get_id()); it != before.end())
      {
        EXPECT_LT(
          body.motion(0, 1)(it->second).distance(particle.get_location()),
          1e-14);
      }
}


// Every node that it holds goes with it; its moment is what the energy gains by
// the turn.
TEST(RigidMotionMpi, NodesTurnWithTheBody)
{
  auto overrides = Overrides{"Geometry/Shapes=box, inner, ring",
                             "Geometry/inner/Kind=ball",
                             "Geometry/inner/Centre=0.5, 0.5",
                             "Geometry/inner/Radius=0.2",
                             "Geometry/ring/Kind=difference",
                             "Geometry/ring/Of=box, inner",
                             "Bodies/block/Shape=ring",
                             "Grid/Cells=8, 8",
                             "Stabilization/Ghost penalty=0",
                             "Materials/rubber/Law=linear elastic",
                             "Bodies/Names=block, tool",
                             "Bodies/tool/Kind=rigid",
                             "Bodies/tool/Shape=inner",
                             "Bodies/tool/Rotation=0.02*t",
                             "Bodies/tool/Centre=0.5, 0.5"};
  for (unsigned int f = 0; f < 4; ++f)
    overrides.push_back("Boundary conditions/" + face_names()[f] +
                        "/Type=fixed");
  Model<2>     model(block_scene("plane strain"), overrides);
  impm::Vector u;
  const auto   solution = model.solve(u);
  ASSERT_TRUE(solution.converged) << solution.failure;
  const auto  &constraints = model.constraints();
  const auto   motion      = model.rigid.bodies[0].motion(0, 1);
  unsigned int n           = 0;
  for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
    if (constraints.carrier[i] == 4)
      {
        ++n;
        EXPECT_NEAR(u.local_element(i),
                    motion.increment(model.problem->discretization
                                       ->node_positions[i / 2])[i % 2],
                    1e-15);
      }
  EXPECT_GT(Utilities::MPI::sum(n, MPI_COMM_WORLD), 10u);

  ReactionSpec moment;
  moment.on                 = "tool";
  moment.is_moment          = true;
  moment.about              = {0.5, 0.5};
  moment.direction          = {0, 0, 1};
  const auto   forces       = model.problem->end_forces(u);
  const double about_centre = model.problem->reaction(moment, u, forces);
  const double energy =
    Utilities::MPI::sum(model.problem->response.potential, MPI_COMM_WORLD);
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(0.5 * about_centre * 0.02 / energy, 1, 1e-3);

  // About another point by what the force does there.
  ReactionSpec force;
  force.on        = "tool";
  force.direction = {0, 1};
  moment.about    = {0.1, 0.5};
  EXPECT_NEAR(model.problem->reaction(moment, u, forces),
              about_centre + 0.4 * model.problem->reaction(force, u, forces),
              1e-12 * about_centre);
}
