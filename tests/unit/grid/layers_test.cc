#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include <cmath>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

// Bodies that move nodes of their own.
namespace
{
  template <int dim>
  Columns
  run_scene(const std::string &kind, const Overrides &overrides)
  {
    const int id =
      Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()));
    return run(scene_from<dim>(block_scene(kind), overrides),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_layers_" + std::to_string(id));
  }

  std::string
  corner(const std::string &x, const std::string &y, const unsigned int dim)
  {
    return x + ", " + y + (dim == 3 ? ", " + x : "");
  }

  /** Two blocks that fill the unit cube and meet at a height. */
  template <int dim>
  Overrides
  two_blocks(const std::string &height)
  {
    return {"Geometry/Shapes=box, other",
            "Geometry/box/Upper corner=" + corner("1", height, dim),
            "Geometry/other/Lower corner=" + corner("0", height, dim),
            "Geometry/other/Upper corner=" + corner("1", "1", dim),
            "Bodies/Names=block, second",
            "Bodies/block/Points per cell=3",
            "Bodies/second/Shape=other",
            "Bodies/second/Material=rubber",
            "Materials/rubber/Law=linear elastic",
            "Contact/Pairs=ends",
            "Contact/ends/Bodies=block, second"};
  }

  constexpr double strain = 1e-4;

  /**
   * The column under uniform strain has a uniform stress: that of its length
   * in series with the layer between the surfaces,
   *
   *   stress = -strain / (1 / M + thickness / M).
   */
  template <int dim>
  void
  check_patch(const std::string &kind, const Overrides &overrides)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    const bool solid   = dim == 3;
    const auto columns = run_scene<dim>(
      kind,
      overrides +
        Overrides{
          "Boundary conditions/bottom/Type=slip",
          "Boundary conditions/left/Type=slip",
          "Boundary conditions/right/Type=slip",
          "Boundary conditions/top/Type=normal displacement",
          "Boundary conditions/top/Value=-1e-4*t",
          "Output/Point fields=cauchy_stress",
          "Output/Probes=lo, hi, across",
          "Output/lo/Kind=smallest",
          "Output/lo/Field=cauchy_stress",
          "Output/lo/Component=4",
          "Output/hi/Kind=largest",
          "Output/hi/Field=cauchy_stress",
          "Output/hi/Component=4",
          "Output/across/Kind=largest",
          "Output/across/Field=cauchy_stress",
          "Output/across/Component=1",
          "Output/Reactions=above, below",
          "Output/above/On=top",
          std::string("Output/above/Direction=0, 1") + (solid ? ", 0" : ""),
          "Output/below/On=bottom",
          std::string("Output/below/Direction=0, -1") + (solid ? ", 0" : "")} +
        (solid ? Overrides{"Boundary conditions/back/Type=slip",
                           "Boundary conditions/front/Type=slip"} :
                 Overrides{}));
    const double nu = 0.3, M = (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    const double thickness = ContactSpec().thickness * 0.25;
    const double stress    = strain * M / (1 + thickness);
    EXPECT_NEAR(columns.at("lo")[0] / -stress, 1, 1e-5);
    EXPECT_NEAR(columns.at("hi")[0] / -stress, 1, 1e-5);
    EXPECT_NEAR(columns.at("above")[0] / stress, 1, 1e-5);
    EXPECT_NEAR(columns.at("below")[0] / stress, 1, 1e-5);
    EXPECT_NEAR(columns.at("across")[0] / stress, 0, 1e-5);
  }
} // namespace


TEST(LayersMpi, TwoBlocksAreAColumn)
{
  for (const std::string kind : {"frictionless", "bonded"})
    for (const std::string method : {"GIMP", "MPM"})
      {
        // Off the lines of the grid.
        const Overrides how = {"Contact/ends/Kind=" + kind,
                               "Grid/Method=" + method};
        check_patch<2>("plane strain", two_blocks<2>("0.53") + how);
        check_patch<2>("plane strain",
                       two_blocks<2>("0.53") + how +
                         Overrides{"Grid/Local refinements=1",
                                   "Grid/Refine where=y - 0.8"});
        check_patch<2>("plane strain",
                       two_blocks<2>("0.53") + how +
                         Overrides{"Grid/Local refinements=1",
                                   "Grid/Refine where=0.2 - y"});
        check_patch<3>("3D", two_blocks<3>("0.53") + how);
      }
}


namespace
{
  /** The second block stands by a gap beside the first, which moves away from
   * it. Returns the velocities of both at the end. */
  template <int dim>
  std::pair<double, double>
  part(const std::string &kind, const double gap, const Overrides &overrides)
  {
    const std::string left = std::to_string(0.9 + gap);
    const auto        columns =
      run_scene<dim>("plane strain",
                     Overrides{"Geometry/Shapes=box, other",
                               "Grid/Upper corner=2.5, 1",
                               "Grid/Cells=10, 4",
                               "Geometry/box/Lower corner=0.4, 0",
                               "Geometry/box/Upper corner=0.9, 1",
                               "Geometry/other/Lower corner=" + left + ", 0",
                               "Geometry/other/Upper corner=2, 1",
                               "Bodies/Names=block, second",
                               "Bodies/block/Velocity=-0.05; 0",
                               "Bodies/second/Shape=other",
                               "Bodies/second/Material=rubber",
                               "Contact/Pairs=ends",
                               "Contact/ends/Bodies=block, second",
                               "Contact/ends/Kind=" + kind,
                               "Time/Time step=0.2",
                               "Output/Probes=first, other",
                               "Output/first/Kind=mean",
                               "Output/first/Field=velocity",
                               "Output/first/Bodies=block",
                               "Output/other/Kind=mean",
                               "Output/other/Field=velocity",
                               "Output/other/Bodies=second"} +
                       with_inertia + overrides);
    return {columns.at("first").back(), columns.at("other").back()};
  }
} // namespace


// What shares nodes feels the other body over more than a cell.
TEST(LayersMpi, BodiesInOtherLayersDoNotFeelEachOther)
{
  for (const std::string method : {"MPM", "GIMP"})
    for (const double gap : {0.02, 0.2})
      {
        const Overrides how = {"Grid/Method=" + method};
        for (const std::string kind : {"frictionless", "Coulomb"})
          {
            const auto [first, other] = part<2>(kind, gap, how);
            EXPECT_NEAR(first, -0.05, 1e-14);
            EXPECT_NEAR(other, 0, 1e-14);
          }
        const auto [first, other] = part<2>("glue", gap, how);
        EXPECT_LT(other, -1e-4);
      }
}


namespace
{
  /** Three bodies of which some are apart. */
  Scene<2>
  three_bodies(const Overrides &overrides)
  {
    return scene_from<2>(block_scene("plane strain"),
                         Overrides{"Geometry/Shapes=box, b, c",
                                   "Geometry/box/Upper corner=0.3, 1",
                                   "Geometry/b/Lower corner=0.35, 0",
                                   "Geometry/b/Upper corner=0.6, 1",
                                   "Geometry/c/Lower corner=0.65, 0",
                                   "Geometry/c/Upper corner=1, 1",
                                   "Bodies/Names=block, b, c",
                                   "Bodies/b/Shape=b",
                                   "Bodies/b/Material=rubber",
                                   "Bodies/c/Shape=c",
                                   "Bodies/c/Material=rubber"} +
                           overrides);
  }

  Overrides
  pair(const std::string &name,
       const std::string &bodies,
       const std::string &kind = "frictionless")
  {
    return {"Contact/" + name + "/Bodies=" + bodies,
            "Contact/" + name + "/Kind=" + kind};
  }

  std::vector<unsigned int>
  layers_of(const Scene<2> &scene)
  {
    std::vector<unsigned int> layers;
    for (const auto &body : scene.bodies)
      {
        layers.push_back(body.layer);
        EXPECT_LT(body.layer, scene.grid.n_layers);
      }
    return layers;
  }
} // namespace


TEST(Layers, WhatIsGluedSharesOne)
{
  using Layers = std::vector<unsigned int>;
  EXPECT_EQ(layers_of(three_bodies({})), (Layers{0, 0, 0}));
  const auto scene =
    three_bodies(Overrides{"Contact/Pairs=p, q"} + pair("p", "block, b") +
                 pair("q", "block, c"));
  EXPECT_EQ(layers_of(scene), (Layers{0, 1, 1}));
  EXPECT_EQ(scene.grid.n_layers, 2u);
  EXPECT_EQ(layers_of(three_bodies(
              Overrides{"Contact/Pairs=p, q, r"} + pair("p", "block, b") +
              pair("q", "block, c", "bonded") + pair("r", "b, c"))),
            (Layers{0, 1, 2}));
  EXPECT_EQ(layers_of(three_bodies(
              Overrides{"Contact/Pairs=p, q, r"} + pair("p", "block, b") +
              pair("q", "block, c", "glue") + pair("r", "b, c"))),
            (Layers{0, 1, 0}));
}


TEST(Layers, GluedByWayOfAnother)
{
  for (const Overrides &third :
       {Overrides{"Contact/Pairs=p"},
        Overrides{"Contact/Pairs=p, q"} + pair("q", "b, c", "glue")})
    try
      {
        three_bodies(third + pair("p", "block, b"));
        FAIL() << "is taken";
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, "Contact/Pairs");
        for (const std::string word : {"'block'", "'b'", "glued"})
          EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << error.what();
      }
}
