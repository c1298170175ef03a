#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // The scene alone on each rank, then on all of them together.
  template <int dim>
  void
  compare(const std::string &text, const Overrides &overrides)
  {
    std::string all;
    for (const auto &override : overrides)
      all += override + ", ";
    SCOPED_TRACE(all);
    const auto scene = scene_from<dim>(text, overrides);
    const auto id =
      Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
    const auto rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const auto path = "/tmp/impm_test_run_" + std::to_string(id);
    const auto alone =
      run(scene, MPI_COMM_SELF, path + "_" + std::to_string(rank));
    const auto together = run(scene, MPI_COMM_WORLD, path);

    ASSERT_EQ(alone.at("step").size(), 5u);
    expect_near(alone, together);
    EXPECT_GT(alone.at("plastic_work").back(), 0.);
    EXPECT_GT(alone.at("load").back(), 0.);
  }

  // The upsetting of prm/upsetting.prm on a coarse grid, in units of 10 mm,
  // 10 GPa and the density; a third of its height in 5 steps.
  std::string
  upsetting()
  {
    return "subsection Geometry\n"
           "  set Kind   = axisymmetric\n"
           "  set Shapes = cylinder\n"
           "  subsection cylinder\n"
           "    set Lower corner = 0, 0\n"
           "    set Upper corner = 1, 1.5\n"
           "  end\n"
           "end\n"
           "subsection Grid\n"
           "  set Method       = MPM\n"
           "  set Lower corner = 0, 0\n"
           "  set Upper corner = 2, 1.5\n"
           "  set Cells        = 8, 6\n"
           "end\n"
           "subsection Materials\n"
           "  set Names = steel\n"
           "  subsection steel\n"
           "    set Law               = log-strain von Mises\n"
           "    set F-bar             = false\n"
           "    set Density           = 1\n"
           "    set Young's modulus   = 20\n"
           "    set Poisson's ratio   = 0.3\n"
           "    set Yield stress      = 0.07\n"
           "    set Hardening modulus = 0.03\n"
           "  end\n"
           "end\n"
           "subsection Bodies\n"
           "  set Names = billet\n"
           "  subsection billet\n"
           "    set Shape    = cylinder\n"
           "    set Material = steel\n"
           "  end\n"
           "end\n"
           "subsection Boundary conditions\n"
           "  subsection left\n"
           "    set Type = slip\n"
           "  end\n"
           "  subsection bottom\n"
           "    set Type = slip\n"
           "  end\n"
           "end\n"
           "subsection Time\n"
           "  set Integrator = theta\n"
           "  set End time   = 5\n"
           "  set Time step  = 1\n"
           "end\n"
           "subsection Solver\n"
           "  set Newton tolerance = 1e-11\n"
           "  set Linear solver    = direct\n"
           "end\n"
           "subsection Output\n"
           "  set Pictures  = false\n"
           "  set Probes    = radius, moved\n"
           "  set Reactions = load\n"
           "  subsection radius\n"
           "    set Kind = extent\n"
           "  end\n"
           "  subsection moved\n"
           "    set Position  = 0.99, 1.48\n"
           "    set Component = 0\n"
           "  end\n"
           "  subsection load\n"
           "    set Direction = 0, 1\n"
           "  end\n"
           "end\n";
  }

  const Overrides platen_is_a_face = {
    "Boundary conditions/top/Type=velocity",
    "Boundary conditions/top/Value=0; -0.05",
    "Boundary conditions/top/Moves the grid=true",
    "Output/load/On=top"};

  const Overrides platen_is_a_body = {"Geometry/Shapes=cylinder, plate",
                                      "Geometry/plate/Lower corner=0, 1.5",
                                      "Geometry/plate/Upper corner=2, 1.75",
                                      "Grid/Upper corner=2, 2",
                                      "Grid/Cells=8, 8",
                                      "Bodies/Names=billet, platen",
                                      "Bodies/platen/Kind=rigid",
                                      "Bodies/platen/Shape=plate",
                                      "Bodies/platen/Displacement=0; -0.05*t",
                                      "Output/load/On=platen"};

  const Overrides split_cells = {"Grid/Local refinements=1",
                                 "Grid/Refine where=0.8 - x + 0.3*y"};
} // namespace


TEST(ParallelMpi, GridFollowsThePlaten)
{
  compare<2>(upsetting(), platen_is_a_face);
}


// Cells that follow the surface and the strain, points that split and merge.
TEST(ParallelMpi, GridAndPointsAdapt)
{
  const Overrides adapting = {"Grid/Method=GIMP",
                              "Materials/steel/F-bar=true",
                              "Bodies/billet/Point adaptation=split and merge",
                              "Bodies/billet/Points per cell=3",
                              "Grid/Adaptation/Criteria=surface, strain",
                              "Grid/Adaptation/Highest level=2",
                              "Grid/Adaptation/surface/Kind=free surface",
                              "Grid/Adaptation/surface/Level=1",
                              "Grid/Adaptation/strain/Kind=size",
                              "Grid/Adaptation/strain/Field="
                              "equivalent_plastic_strain",
                              "Grid/Adaptation/strain/Above=0.4"};
  compare<2>(upsetting(), platen_is_a_face + adapting);
  compare<2>(upsetting(),
             platen_is_a_body + adapting +
               Overrides{"Grid/Method=MPM",
                         "Grid/Adaptation/Criteria=surface, strain, platen",
                         "Grid/Adaptation/platen/Kind=distance",
                         "Grid/Adaptation/platen/Of=platen",
                         "Grid/Adaptation/platen/Level=1"});
}


// Nodes that keep their motion for some steps, over hanging nodes, under a face
// and a body, on cells that change at resets.
TEST(ParallelMpi, GridIsResetNowAndThen)
{
  const Overrides seldom = {"Grid/Reset=interval",
                            "Grid/Steps between resets=2",
                            "Grid/Largest motion=10"},
                  boxes  = {"Grid/Method=GIMP",
                            "Materials/steel/F-bar=true",
                            "Bodies/billet/Point adaptation=split",
                            "Grid/Adaptation/Criteria=surface",
                            "Grid/Adaptation/surface/Kind=free surface"};
  compare<2>(upsetting(), platen_is_a_face + split_cells + seldom);
  compare<2>(upsetting(), platen_is_a_face + seldom + boxes);
  compare<2>(upsetting(),
             platen_is_a_body + seldom + boxes +
               Overrides{"Grid/Largest motion=0.5"});
  compare<2>(upsetting(),
             platen_is_a_face + split_cells + seldom +
               Overrides{"Time/Integrator=Newmark",
                         "Time/Acceleration from=points"});
}


TEST(ParallelMpi, LocallyRefinedGrid)
{
  compare<2>(upsetting(), platen_is_a_face + split_cells);
}


TEST(ParallelMpi, RateLawsAndPlaneStress)
{
  compare<2>(upsetting(),
             platen_is_a_face + split_cells +
               Overrides{"Materials/steel/Law=Jaumann von Mises"});
  compare<2>(upsetting(),
             platen_is_a_face + split_cells +
               Overrides{"Materials/steel/Law=linear von Mises",
                         "Geometry/Kind=plane stress"});
}


TEST(ParallelMpi, Boxes)
{
  compare<2>(upsetting(),
             platen_is_a_face + split_cells + Overrides{"Grid/Method=GIMP"});
}


TEST(ParallelMpi, MeanVolume)
{
  compare<2>(upsetting(),
             platen_is_a_face + split_cells +
               Overrides{"Materials/steel/F-bar=true"});
  compare<2>(upsetting(),
             platen_is_a_face +
               Overrides{"Grid/Method=GIMP", "Materials/steel/F-bar=true"});
  compare<2>(upsetting(),
             platen_is_a_face + split_cells +
               Overrides{"Materials/steel/Law=Jaumann von Mises",
                         "Materials/steel/F-bar=true"});
}


TEST(ParallelMpi, NewmarkAndTransfers)
{
  for (const std::string from : {"grid", "points"})
    compare<2>(upsetting(),
               platen_is_a_face + split_cells +
                 Overrides{"Time/Integrator=Newmark",
                           "Time/Acceleration from=" + from,
                           "Time/Transfer=APIC"});
}


TEST(ParallelMpi, FiniteElements)
{
  const Overrides platen = {"Grid/Method=Lagrangian",
                            "Boundary conditions/top/Type=velocity",
                            "Boundary conditions/top/Value=0; -0.05",
                            "Output/load/On=top"};
  compare<2>(upsetting(), platen + split_cells);
  compare<2>(upsetting(),
             platen + Overrides{"Time/Integrator=Newmark",
                                "Materials/steel/F-bar=true"});
}


TEST(ParallelMpi, MomentumFormulationAndExplicitSteps)
{
  const Overrides momentum = {"Time/Formulation=momentum"};
  compare<2>(upsetting(),
             platen_is_a_body + momentum +
               Overrides{"Solver/Linear solver=GMRES",
                         "Solver/Linear tolerance=1e-10"});
  compare<2>(upsetting(), platen_is_a_body + momentum + split_cells);
  compare<2>(upsetting(),
             platen_is_a_face + momentum + Overrides{"Grid/Method=GIMP"});
  for (const auto &formulation : {Overrides{}, momentum})
    compare<2>(upsetting(),
               platen_is_a_face + split_cells + formulation +
                 Overrides{"Time/Integrator=explicit",
                           "Time/Time step=0.01",
                           "Time/End time=0.05",
                           "Materials/steel/Yield stress=0.001"});
}


TEST(ParallelMpi, PlatenOfPoints)
{
  compare<2>(upsetting(), platen_is_a_body);
  compare<2>(upsetting(), platen_is_a_body + split_cells);
}


TEST(ParallelMpi, QuasiStaticWithMultigrid)
{
  for (const std::string preconditioner : {"multigrid", "AMG"})
    compare<2>(upsetting(),
               platen_is_a_face + split_cells +
                 Overrides{"Time/Integrator=quasi-static",
                           "Solver/Linear solver=CG",
                           "Solver/Preconditioner=" + preconditioner,
                           "Solver/Linear tolerance=1e-6"});
}


TEST(ParallelMpi, InSpace)
{
  compare<3>(block_scene("3D"),
             plastic + refined +
               Overrides{"Time/Time step=0.2",
                         "Boundary conditions/bottom/Type=fixed",
                         "Boundary conditions/top/Type=displacement",
                         "Boundary conditions/top/Value=0.1*t; -0.1*t; 0",
                         "Boundary conditions/top/Moves the grid=true",
                         "Grid/Lower corner=-0.5, 0, 0",
                         "Grid/Upper corner=1.5, 1, 1",
                         "Boundary conditions/back/Type=slip",
                         "Boundary conditions/front/Type=slip",
                         "Output/Probes=radius",
                         "Output/radius/Kind=extent",
                         "Output/Reactions=load",
                         "Output/load/On=top",
                         "Output/load/Direction=0, 1, 0"});
}
