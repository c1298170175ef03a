#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // The unit block in a Lagrangian grid that is wider than it.
  Overrides
  wide_grid(const unsigned int dim, const std::string &traction)
  {
    const bool solid = dim == 3;
    return {"Grid/Method=Lagrangian",
            std::string("Grid/Upper corner=2, 1") + (solid ? ", 1" : ""),
            std::string("Grid/Cells=4, 2") + (solid ? ", 2" : ""),
            "Boundary conditions/top/Type=traction",
            "Boundary conditions/top/Value=" + traction};
  }

  template <int dim>
  void
  expect_force(const std::string    &kind,
               const Overrides      &overrides,
               const Tensor<1, dim> &expected)
  {
    SCOPED_TRACE(kind);
    Model<dim> model(block_scene(kind), overrides);
    model.begin_step();
    Tensor<1, dim> sum;
    for (unsigned int i = 0; i < model.vector().locally_owned_size(); ++i)
      sum[i % dim] -= model.problem->loads.at_end.local_element(i);
    sum = Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    EXPECT_LT((sum - expected).norm(), 1e-13 * expected.norm());
  }
} // namespace


TEST(FaceTractionMpi, LoadsTheMaterialAlone)
{
  expect_force<2>("plane strain",
                  wide_grid(2, "3; -2*t"),
                  Tensor<1, 2>({3, -2}));
  expect_force<2>("plane strain",
                  wide_grid(2, "3; -2*t") + refined,
                  Tensor<1, 2>({3, -2}));
  // a whole disk of radius 1
  expect_force<2>("axisymmetric",
                  wide_grid(2, "0; 5"),
                  Tensor<1, 2>({0, 5 * numbers::PI}));
  expect_force<3>("3D", wide_grid(3, "1; 2; -3"), Tensor<1, 3>({1, 2, -3}));
}


TEST(FaceTractionMpi, TheReactionIsTheForceOnTheBlock)
{
  const auto scene =
    scene_from<2>(block_scene("plane strain"),
                  wide_grid(2, "0; -0.1*t") +
                    Overrides{"Boundary conditions/left/Type=slip",
                              "Boundary conditions/bottom/Type=slip",
                              "Output/Reactions=F",
                              "Output/F/On=bottom",
                              "Output/F/Direction=0, -1"});
  const int id =
    Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
  const auto columns =
    run(scene,
        MPI_COMM_WORLD,
        "/tmp/impm_test_face_traction_" + std::to_string(id));
  EXPECT_NEAR(columns.at("F").back(), 0.1, 1e-7);
}
