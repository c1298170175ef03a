#include <impm/balance/terms/loads.h>

#include <gtest/gtest.h>

#include "expect_blame.h"
#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // On the last of the 8 layers of points of the block.
  Overrides
  traction(const std::string &normal,
           const std::string &value,
           const std::string &name = "pull")
  {
    const std::string coordinate = normal == "x" ? "x" : "y";
    const std::string path       = "Loads/" + name + "/";
    return {path + "Body=block",
            path + "Acts on=points",
            path + "Where=" + coordinate + " - 0.9",
            path + "Normal=" + normal,
            path + "Value=" + value};
  }

  const Overrides pull = {"Loads/Tractions=pull", "Loads/pull/Acts on=points"};

  template <int dim>
  Tensor<1, dim>
  force(const Model<dim> &model)
  {
    Tensor<1, dim> sum;
    for (unsigned int i = 0; i < model.vector().locally_owned_size(); ++i)
      sum[i % dim] -= model.problem->loads->at_end.local_element(i);
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  }

  template <int dim>
  void
  expect_force(const std::string    &text,
               const Overrides      &overrides,
               const Tensor<1, dim> &expected,
               const unsigned int    n_points)
  {
    std::string all;
    for (const auto &override : overrides)
      all += override + ", ";
    SCOPED_TRACE(all);
    Model<dim> model(text, overrides);
    EXPECT_EQ(count_points_under_tractions(model.scene.loads.tractions,
                                           model.points),
              std::vector<types::particle_index>{n_points});
    model.scatter_points(3); // wherever they are
    model.begin_step();
    EXPECT_LT((force(model) - expected).norm(), 1e-13 * expected.norm());
  }

  std::string
  path_of_run()
  {
    return "/tmp/impm_test_traction_" +
           std::to_string(
             Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                       static_cast<int>(getpid())));
  }
} // namespace


TEST(PointTractionMpi, TheForceIsTractionTimesArea)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      const Overrides common = pull + Overrides{"Grid/Method=" + method};
      expect_force<2>(block_scene("plane strain"),
                      common + traction("x", "3; -2*t"),
                      Tensor<1, 2>({3, -2}),
                      8);
      // a whole disk of radius 1, a whole hoop through the points
      expect_force<2>(block_scene("axisymmetric"),
                      common + traction("y", "0; 5"),
                      Tensor<1, 2>({0, 5 * numbers::PI}),
                      8);
      expect_force<2>(block_scene("axisymmetric"),
                      common + traction("x", "0; 5"),
                      Tensor<1, 2>({0, 5 * 2 * numbers::PI * 15. / 16}),
                      8);
      expect_force<3>(block_scene("3D"),
                      common + traction("y", "1; 2; -3"),
                      Tensor<1, 3>({1, 2, -3}),
                      64);
    }
  // Cells on the left are finer: 8 of 16 points lie there.
  expect_force<2>(block_scene("plane strain"),
                  pull + refined +
                    Overrides{"Loads/pull/Body=block",
                              "Loads/pull/Where=if(x < 0.5, y - 0.93, "
                              "y - 0.9)",
                              "Loads/pull/Normal=y",
                              "Loads/pull/Value=0; 7"},
                  Tensor<1, 2>({0, 7}),
                  12);
}


// Each is a cube of its volume.
TEST(PointTractionMpi, PointsFromAFile)
{
  const TemporaryFile cloud("x,y,volume\n0.3,0.3,0.04\n0.6,0.4,0.09\n"
                            "0.6,0.7,0.01\n",
                            ".csv");
  std::string         text  = block_scene("plane strain");
  const std::string   shape = "    set Shape    = box\n";
  text.erase(text.find(shape), shape.size());
  expect_force<2>(text,
                  pull + traction("x", "2; 0") +
                    Overrides{"Loads/pull/Where=x - 0.5",
                              "Bodies/block/Points from=file",
                              "Bodies/block/File=" + cloud.name},
                  Tensor<1, 2>({2 * (0.3 + 0.1), 0}),
                  2);
}


// The point of a corner may carry two.
TEST(PointTractionMpi, SeveralAddUp)
{
  Model<2> model(block_scene("plane strain"),
                 traction("x", "3; 0") + traction("y", "1; 4", "lift") +
                   Overrides{"Loads/Tractions=pull, lift",
                             "Loads/Body force=0; 10"});
  model.begin_step();
  EXPECT_LT((force(model) - Tensor<1, 2>({3 + 1, 4 + 10})).norm(), 1e-13);
}


TEST(PointTractionMpi, Coordinates)
{
  const auto sum = [](const std::string &coordinates) {
    Model<2> model(block_scene("plane strain"),
                   pull + traction("x", "y; 0") +
                     Overrides{"Loads/pull/Coordinates=" + coordinates});
    model.place_points([](const unsigned int, const auto &particle) {
      return particle.get_location() + Tensor<1, 2>({0, 0.01});
    });
    model.begin_step();
    return force(model)[0];
  };
  EXPECT_NEAR(sum("initial"), 0.5, 1e-14);
  EXPECT_NEAR(sum("current"), 0.51, 1e-14);
}


TEST(PointTractionMpi, PushesAFreeBody)
{
  const std::vector<Overrides> schemes = {
    {"Time/Integrator=theta"},
    {"Time/Integrator=theta", "Time/Theta=0.5", "Grid/Method=GIMP"},
    {"Time/Integrator=theta",
     "Solver/Linear solver=GMRES",
     "Time/Formulation=momentum"},
    {"Time/Integrator=Newmark"},
    {"Time/Integrator=explicit", "Grid/Method=GIMP"},
    {"Time/Integrator=explicit", "Time/Formulation=momentum"}};
  for (const auto &scheme : schemes)
    {
      SCOPED_TRACE(scheme.front() + ", " + scheme.back());
      const auto columns =
        run(scene_from<2>(block_scene("plane strain"),
                          pull + scheme + traction("x", "0.02; 0.01") +
                            Overrides{"Grid/Lower corner=-1, -1",
                                      "Grid/Upper corner=3, 3",
                                      "Grid/Cells=16, 16",
                                      "Time/Time step=0.125",
                                      "Time/End time=2"}),
            MPI_COMM_WORLD,
            path_of_run());
      EXPECT_NEAR(columns.at("momentum_x").back(), 0.04, 1e-12);
      EXPECT_NEAR(columns.at("momentum_y").back(), 0.02, 1e-12);
    }
}


// Force times displacement of the layer, which is a body of its own here.
TEST(PointTractionMpi, Work)
{
  const auto columns =
    run(scene_from<2>(block_scene("plane strain"),
                      pull + traction("x", "0.05; 0") +
                        Overrides{"Geometry/Shapes=box, strip",
                                  "Geometry/box/Upper corner=0.875, 1",
                                  "Geometry/strip/Lower corner=0.875, 0",
                                  "Geometry/strip/Upper corner=1, 1",
                                  "Bodies/Names=block, layer",
                                  "Bodies/layer/Shape=strip",
                                  "Bodies/layer/Material=rubber",
                                  "Loads/pull/Body=layer",
                                  "Grid/Upper corner=2, 1",
                                  "Grid/Cells=8, 4",
                                  "Boundary conditions/left/Type=slip",
                                  "Boundary conditions/bottom/Type=slip",
                                  "Output/Probes=motion",
                                  "Output/motion/Kind=mean",
                                  "Output/motion/Bodies=layer"}),
        MPI_COMM_WORLD,
        path_of_run());
  const double motion = columns.at("motion").back();
  EXPECT_GT(motion, 0.03);
  EXPECT_NEAR(columns.at("external_work").back(), 0.05 * motion, 1e-12);
}


TEST(PointTractionMpi, IsRefused)
{
  const auto blame = [](const Overrides   &overrides,
                        const std::string &entry,
                        const std::string &word) {
    expect_blame(block_scene("plane strain"),
                 pull + traction("x", "1; 0") + overrides,
                 entry,
                 {word});
  };
  blame({"Loads/pull/Where=x - 0.95"}, "Loads/pull/Where", "no point");
  blame({"Loads/pull/Where="}, "Loads/pull/Where", "''");
  blame({"Loads/pull/Value="}, "Loads/pull/Value", "''");
  blame({"Loads/pull/Body=rock"}, "Loads/pull/Body", "block");
  blame({"Loads/pull/Normal=z"}, "Loads/pull/Normal", "x, y");
  blame({"Loads/Tractions=pull, pull"}, "Loads/Tractions", "twice");
  blame({"Grid/Method=Lagrangian"}, "Loads/Tractions", "faces");
}
