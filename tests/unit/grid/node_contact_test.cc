#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace impm;

// Rigid boxes to which the nodes of a Lagrangian grid stick.
namespace
{
  Overrides
  plate(const std::string &lower,
        const std::string &upper,
        const std::string &displacement)
  {
    return {"Geometry/Shapes=box, plate",
            "Geometry/plate/Lower corner=" + lower,
            "Geometry/plate/Upper corner=" + upper,
            "Bodies/Names=block, plate",
            "Bodies/plate/Kind=rigid",
            "Bodies/plate/Shape=plate",
            "Bodies/plate/Displacement=" + displacement,
            "Grid/Method=Lagrangian",
            "Boundary conditions/left/Type=slip",
            "Boundary conditions/bottom/Type=slip"};
  }

  template <int dim>
  Columns
  press(const std::string &kind, const Overrides &overrides)
  {
    const int id =
      dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                        static_cast<int>(getpid()));
    return run(scene_from<dim>(block_scene(kind), overrides),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_contact_" + std::to_string(id));
  }
} // namespace

// A plate that comes down by 0.35 from 0.15 above the block and slips leaves a
// homogeneous state, that of a block whose upper side is moved by 0.2.
TEST(NodeContactMpi, SlippingPlateMakesTheStateOfAPrescribedSide)
{
  const Overrides probes = {"Output/Probes=width",
                            "Output/width/Kind=largest",
                            "Output/width/Field=displacement",
                            "Time/Time step=0.1"};
  const auto      prescribed =
    press<2>("plane strain",
             probes + Overrides{"Grid/Method=Lagrangian",
                                "Boundary conditions/left/Type=slip",
                                "Boundary conditions/bottom/Type=slip",
                                "Boundary conditions/top/Type=normal "
                                "displacement",
                                "Boundary conditions/top/Value=-0.2*t"});
  const auto touched =
    press<2>("plane strain",
             probes + plate("-1, 1.15", "3, 2", "0; -0.35*t") +
               Overrides{"Bodies/plate/Contact=slip y",
                         "Output/Reactions=load",
                         "Output/load/On=plate",
                         "Output/load/Direction=0, 1"});
  // Within the distance that counts as contact.
  EXPECT_NEAR(touched.at("width").back(), prescribed.at("width").back(), 1e-4);
  EXPECT_NEAR(touched.at("strain_energy").back() /
                prescribed.at("strain_energy").back(),
              1.,
              1e-3);
  EXPECT_EQ(touched.at("load").front(), 0.);
  EXPECT_GT(touched.at("load").back(), 0.2);
  double cuts = 0;
  for (const double value : touched.at("step_cuts"))
    cuts += value;
  EXPECT_GE(cuts, 1.);
}


// A block that is bonded to a plate from the start folds onto it: its nodes may
// touch the plate, not enter it, whatever the step.
template <int dim>
void
check_folding(const std::string &kind,
              const Overrides   &plate,
              const Overrides   &overrides = {})
{
  SCOPED_TRACE(kind);
  Model<dim>   model(block_scene(kind),
                   plate + overrides +
                     Overrides{"Time/Time step=0.1",
                               "Materials/rubber/Poisson's ratio=0.45",
                               "Materials/rubber/Law=decoupled neo-Hookean"});
  const double tolerance =
    1e-4 * model.grid.discretization()->smallest_cell_extent;
  unsigned int landed = 0;
  double       dt     = 0.1;
  auto         u      = model.vector();
  while (model.time < 1 - 1e-12)
    {
      model.dt          = std::min(dt, 1 - model.time);
      const auto result = model.solve(u);
      ASSERT_TRUE(result.converged) << result.failure;
      u.update_ghost_values();
      const double part =
        model.rigid.first_touch(u,
                                model.constraints().is_constrained,
                                model.time,
                                model.time + model.dt);
      ASSERT_GT(part, 0.);
      dt = part < 1 ? part * model.dt : 0.1;
      landed += part < 1;
      if (part < 1)
        continue;
      const double start = model.time;
      model.commit(u);
      model.rigid.move(start, model.time);
      const auto   shift = model.rigid.bodies[0].motion(0, model.time).shift;
      const double face  = 1 + shift[dim - 1];
      for (const auto &place : model.grid.discretization()->node_positions)
        EXPECT_LT(place[dim - 1], face + 2 * tolerance);
    }
  EXPECT_GT(landed, 0u);
  // More than the upper side is held now.
  unsigned int held = 0, held_at_start = dim == 2 ? 9 : 18;
  for (unsigned int i = 0; i < u.locally_owned_size(); i += dim)
    held += model.rigid.holders_of_nodes[i / dim] > 0;
  held = dealii::Utilities::MPI::sum(held, MPI_COMM_WORLD);
  EXPECT_GT(held, held_at_start);
}

TEST(NodeContactMpi, NodesFoldOntoAPlate)
{
  const Overrides cells = {"Grid/Cells=8, 8"};
  check_folding<2>("plane strain", plate("-1, 1", "9, 2", "0; -0.5*t"), cells);
  // Thin rings and slices fold as easily; massive bodies would take more.
  check_folding<2>("axisymmetric",
                   plate("9, 1", "20, 2", "0; -0.5*t"),
                   cells + Overrides{"Grid/Lower corner=10, 0",
                                     "Grid/Upper corner=11, 1",
                                     "Geometry/box/Lower corner=10, 0",
                                     "Geometry/box/Upper corner=11, 1"});
  check_folding<3>("3D",
                   plate("-1, -1, 1", "9, 9, 2", "0; 0; -0.5*t"),
                   {"Grid/Cells=8, 1, 8",
                    "Boundary conditions/left/Type=slip",
                    "Boundary conditions/bottom/Type=slip",
                    "Boundary conditions/top/Type=slip",
                    "Boundary conditions/back/Type=slip"});
}


TEST(NodeContact, RefusesOtherShapes)
{
  try
    {
      scene_from<2>(block_scene("plane strain"),
                    {"Geometry/Shapes=box, plate",
                     "Geometry/plate/Kind=ball",
                     "Geometry/plate/Centre=0.5, 2",
                     "Geometry/plate/Radius=1",
                     "Bodies/Names=block, plate",
                     "Bodies/plate/Kind=rigid",
                     "Bodies/plate/Shape=plate",
                     "Bodies/plate/Displacement=0; -0.35*t",
                     "Grid/Method=Lagrangian"});
      FAIL();
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("boxes"), std::string::npos);
    }
}
