#include <impm/output/history.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  // A body in the middle of the grid that flies, turns and is stretched.
  const Overrides flying = {"Geometry/box/Lower corner=0.3, 0.4",
                            "Geometry/box/Upper corner=0.7, 0.75",
                            "Grid/Cells=8, 8",
                            "Time/Integrator=theta",
                            "Time/Time step=0.05",
                            "Bodies/block/Velocity=0.3 + 0.4*x - y; x*y - 0.2"};

  template <int dim>
  Tensor<1, dim>
  momentum_of_grid(const Model<dim> &model)
  {
    Tensor<1, dim> sum;
    const auto    &motion = model.problem->motion;
    for (unsigned int i = 0; i < motion.mass.locally_owned_size(); ++i)
      sum[i % dim] +=
        motion.mass.local_element(i) * motion.velocity.local_element(i);
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  }

  template <int dim>
  double
  mass_of_grid(const Model<dim> &model)
  {
    double sum = 0;
    for (unsigned int i = 0;
         i < model.problem->motion.mass.locally_owned_size();
         ++i)
      sum += model.problem->motion.mass.local_element(i);
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD) / dim;
  }

  template <int dim>
  void
  check_gather(const std::string &kind, const Overrides &overrides)
  {
    SCOPED_TRACE(kind);
    Model<dim> model(block_scene(kind), flying + overrides);
    ASSERT_GT(model.grid.triangulation.n_global_active_cells(), 0u);
    model.scatter_points(1);
    model.begin_step();
    const auto totals = total(model.points);
    EXPECT_NEAR(mass_of_grid(model) / totals.mass, 1., 1e-14);
    const auto difference = momentum_of_grid(model) - totals.momentum;
    EXPECT_LT(difference.norm(), 1e-14 * totals.momentum.norm());
    // nothing at hanging nodes
    for (unsigned int i = 0;
         i < model.problem->motion.mass.locally_owned_size();
         ++i)
      if (model.grid.discretization()->numbering->hanging_nodes.is_constrained(
            model.problem->motion.mass.get_partitioner()->local_to_global(i)))
        EXPECT_EQ(model.problem->motion.mass.local_element(i), 0.);
  }

  template <int dim>
  void
  fly(const std::string &kind, const Overrides &overrides)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    Model<dim> model(block_scene(kind), flying + overrides);
    const auto start = total(model.points);
    Vector     u;
    double     largest = 0;
    for (unsigned int step = 0; step < 6; ++step)
      {
        const auto result = model.solve(u);
        ASSERT_TRUE(result.converged) << result.failure;
        model.commit(u);
        const auto now        = total(model.points);
        auto       difference = now.momentum - start.momentum;
        if (kind == "axisymmetric")
          difference[0] = 0;
        largest = std::max(largest, difference.norm());
        EXPECT_NEAR(now.mass / start.mass, 1., 1e-14);
      }
    // Momentum is as exact as the forces: the scale of these is E times area.
    EXPECT_LT(largest, 1e-12);
    const auto end = total(model.points);
    EXPECT_GT(end.strain_energy + end.plastic_work, 1e-6);
    // That of explicit steps oscillates with dt.
    const double slack = model.integrator->is_explicit() ? 0.03 : 1e-12;
    EXPECT_LT(end.strain_energy + end.plastic_work + end.kinetic_energy,
              start.kinetic_energy * (1 + slack));
  }

  const Overrides space        = {"Geometry/box/Lower corner=0.3, 0.4, 0.4",
                                  "Geometry/box/Upper corner=0.7, 0.75, 0.7",
                                  "Grid/Cells=4, 4, 4",
                                  "Bodies/block/Velocity=0.3 - y; x*z - 0.2; 0.4*x"};
  const Overrides half_refined = {"Grid/Local refinements=1",
                                  "Grid/Refine where=0.5 - x"};
} // namespace


TEST(ConservationMpi, GridHasMassAndMomentumOfThePoints)
{
  check_gather<2>("plane strain", {});
  check_gather<2>("plane strain", half_refined);
  check_gather<2>("axisymmetric", half_refined);
  check_gather<3>("3D", space + half_refined);
}


TEST(ConservationMpi, FreeFlightKeepsMomentum)
{
  fly<2>("plane strain", {"Time/Theta=1"});
  fly<2>("plane strain", {"Time/Theta=0.5"});
  fly<2>("plane strain", half_refined + plastic);
  fly<2>("axisymmetric", half_refined);
  fly<3>("3D", space + half_refined);
}


TEST(ConservationMpi, BoxesKeepMomentum)
{
  const Overrides boxes = {"Grid/Method=GIMP"};
  check_gather<2>("plane strain", boxes + half_refined);
  check_gather<3>("3D", boxes + space + half_refined);
  fly<2>("plane strain", boxes + half_refined + plastic);
  fly<3>("3D", boxes + space + half_refined);
}


TEST(ConservationMpi, EveryTransferKeepsMomentum)
{
  for (const std::string transfer : {"FLIP", "PIC", "APIC"})
    for (const std::string from : {"grid", "points"})
      fly<2>("plane strain",
             half_refined + Overrides{"Time/Integrator=Newmark",
                                      "Time/Acceleration from=" + from,
                                      "Time/Transfer=" + transfer});
}


TEST(ConservationMpi, MomentumFormulationKeepsMomentum)
{
  const Overrides momentum = {"Time/Formulation=momentum",
                              "Solver/Linear solver=GMRES",
                              "Solver/Linear tolerance=1e-10"};
  fly<2>("plane strain", momentum + half_refined + plastic);
  fly<2>("axisymmetric", momentum + half_refined);
  fly<2>("plane strain", momentum + Overrides{"Grid/Method=GIMP"});
  fly<3>("3D", momentum + space);
  fly<2>("axisymmetric", Overrides{"Time/Formulation=momentum"} + half_refined);
}


TEST(ConservationMpi, ExplicitStepsKeepMomentum)
{
  const Overrides explicit_steps = {"Time/Integrator=explicit",
                                    "Time/Time step=0.02"};
  for (const std::string formulation : {"velocity", "momentum"})
    {
      const Overrides all =
        explicit_steps + Overrides{"Time/Formulation=" + formulation};
      fly<2>("plane strain", all + half_refined + plastic);
      fly<2>("axisymmetric", all + half_refined);
      fly<3>("3D", all + space + half_refined);
    }
}


// What points lose at a wall is what the wall exerts, from the first step on,
// in which nothing but the wall's own nodes can know of it.
TEST(ConservationMpi, WallTakesWhatThePointsLose)
{
  const Overrides              wall = {"Geometry/box/Lower corner=0, 0.4",
                                       "Geometry/box/Upper corner=0.4, 0.75",
                                       "Grid/Cells=8, 8",
                                       "Time/Time step=0.02",
                                       "Boundary conditions/left/Type=fixed",
                                       "Bodies/block/Velocity=-0.1; 0.03*x"};
  const std::vector<Overrides> integrators = {
    {"Time/Integrator=theta"},
    {"Time/Integrator=theta", "Time/Theta=0.5"},
    {"Time/Integrator=explicit"},
    {"Time/Integrator=explicit", "Time/Formulation=momentum"},
    {"Time/Integrator=theta",
     "Time/Formulation=momentum",
     "Solver/Linear solver=GMRES",
     "Solver/Linear tolerance=1e-10"},
    {"Time/Integrator=Newmark"},
    {"Time/Integrator=Newmark", "Grid/Method=GIMP"}};
  for (const auto &integrator : integrators)
    {
      SCOPED_TRACE(integrator.back());
      Model<2>     model(block_scene("plane strain"), wall + integrator);
      impm::Vector u;
      Tensor<1, 2> impulse;
      Tensor<1, 2> first;
      const auto   start = total(model.points).momentum;
      for (unsigned int step = 0; step < 10; ++step)
        {
          ASSERT_TRUE(model.solve(u).converged);
          impm::Vector forces;
          if (model.integrator->is_explicit())
            {
              forces = model.problem->start_forces;
              for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
                if (model.constraints().is_constrained[i])
                  forces.local_element(i) += model.problem->held_inertia(u, i);
            }
          else
            forces = model.balance().constraint_forces();
          for (unsigned int d = 0; d < 2; ++d)
            impulse[d] +=
              model.dt * model.constraints().sum_over("left",
                                                      forces,
                                                      {d == 0 ? 1. : 0.,
                                                       d == 1 ? 1. : 0.});
          model.commit(u);
          const auto lost = total(model.points).momentum - start;
          if (step == 0)
            first = lost;
          EXPECT_LT((lost - impulse).norm(), 1e-12) << step;
        }
      EXPECT_GT(impulse[0], 10 * first[0]); // no jump by the mass of a node
      EXPECT_GT(impulse[0], 1e-4);
    }
}


// A block of one velocity just flies: no force, whatever grid it crosses.
TEST(ConservationMpi, UniformVelocityStaysUniform)
{
  Model<2> model(block_scene("plane strain"),
                 flying + half_refined +
                   Overrides{"Bodies/block/Velocity=0.7; -0.3"});
  auto     u = model.vector();
  for (unsigned int step = 0; step < 6; ++step)
    {
      ASSERT_TRUE(model.solve(u).converged);
      model.commit(u);
    }
  for (unsigned int p = 0; p < model.points.size(); ++p)
    {
      const double *fields = model.points.fields(p);
      EXPECT_NEAR(fields[model.points.offset_velocity], 0.7, 1e-12);
      EXPECT_NEAR(fields[model.points.offset_velocity + 1], -0.3, 1e-12);
    }
  EXPECT_NEAR(total(model.points).strain_energy, 0., 1e-24);
}


// v_p += dt (a_p + a_p_end) / 2 with what the points carry, not what the grid
// makes of it (Guilkey & Weiss 2003, section 3.3, step 7).
TEST(ConservationMpi, PointsMoveByTheirOwnAccelerations)
{
  Model<2> model(block_scene("plane strain"),
                 half_refined +
                   Overrides{"Time/Integrator=Newmark",
                             "Time/Acceleration from=points",
                             "Time/Time step=0.01",
                             "Bodies/block/Velocity=0.01*x*y; -0.02*y^2"});
  // By the number of the point: velocity and acceleration.
  const auto state = [&]() {
    std::map<unsigned int, std::array<Tensor<1, 2>, 2>> result;
    unsigned int                                        p = 0;
    for (const auto &particle : model.points.sorted.particles)
      {
        auto &[velocity, acceleration] = result[particle.get_id()];
        const double *fields           = model.points.fields(p++);
        for (unsigned int d = 0; d < 2; ++d)
          {
            velocity[d]     = fields[model.points.offset_velocity + d];
            acceleration[d] = fields[model.points.offset_acceleration + d];
          }
      }
    return result;
  };
  auto u = model.vector();
  for (unsigned int step = 0; step < 4; ++step)
    {
      const auto before = state();
      ASSERT_TRUE(model.solve(u).converged);
      model.commit(u);
      double difference = 0, size = 0;
      for (const auto &[id, after] : state())
        {
          const auto expected =
            before.at(id)[0] + 0.005 * (before.at(id)[1] + after[1]);
          difference = std::max(difference, (after[0] - expected).norm());
          size       = std::max(size, after[1].norm());
        }
      EXPECT_LT(difference, 1e-14);
      EXPECT_GT(size, 1e-4);
    }
}


// A point exactly on a grid line gives no mass to the nodes across: they must
// neither make the system singular nor strain the point.
template <int dim>
void
fly_alone(const std::string &kind, const Overrides &overrides)
{
  std::string all = kind;
  for (const auto &override : overrides)
    all += ", " + override;
  SCOPED_TRACE(all);
  const TemporaryFile file(dim == 2 ? "x,y,volume\n0.25,0.4,0.001\n" :
                                      "x,y,z,volume\n0.25,0.4,0.5,0.001\n",
                           ".csv");
  Model<dim>   model(block_scene(kind),
                   Overrides{"Bodies/block/Points from=file",
                             "Bodies/block/File=" + file.name,
                             "Bodies/block/Velocity=1; 0" +
                               std::string(dim == 3 ? "; 0" : ""),
                             "Time/Time step=0.05"} +
                     overrides);
  impm::Vector u;
  for (unsigned int step = 0; step < 10; ++step)
    {
      const auto result = model.solve(u);
      ASSERT_TRUE(result.converged) << result.failure;
      model.commit(u);
    }
  for (unsigned int p = 0; p < model.points.size(); ++p)
    for (unsigned int d = 0; d < dim; ++d)
      EXPECT_NEAR(model.points.velocity(p)[d], d == 0 ? 1. : 0., 1e-10);
}

TEST(ConservationMpi, PointOnAGridLineFlies)
{
  const std::vector<Overrides> integrators = {
    {"Time/Integrator=theta"},
    {"Time/Integrator=theta", "Solver/Linear solver=CG"},
    {"Time/Integrator=Newmark", "Time/Acceleration from=points"},
    {"Time/Integrator=explicit"},
    {"Time/Integrator=theta", "Time/Formulation=momentum"}};
  for (const auto &integrator : integrators)
    {
      fly_alone<2>("plane strain", integrator);
      fly_alone<2>("plane strain",
                   integrator + Overrides{"Grid/Local refinements=1",
                                          "Grid/Refine where=0.3 - x"});
      fly_alone<3>("3D", integrator);
    }
}
