#include <impm/scene/shared_cells.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "expect_blame.h"
#include "mesh_writer.h"

using namespace dealii;
using namespace impm;

namespace
{
  const Overrides cut = {"Bodies/block/Surface=cut cells"};

  /** The block as a ball, or what else a shape is. */
  Overrides
  ball(const std::string &centre, const std::string &radius)
  {
    return {"Geometry/Shapes=box, ball",
            "Geometry/ball/Kind=ball",
            "Geometry/ball/Centre=" + centre,
            "Geometry/ball/Radius=" + radius,
            "Bodies/block/Shape=ball"};
  }

  Overrides
  function(const std::string &expression)
  {
    return {"Geometry/Shapes=box, function",
            "Geometry/function/Kind=function",
            "Geometry/function/Inside where negative=" + expression,
            "Bodies/block/Shape=function"};
  }

  /** A hole in the block, and what fills it as another body. */
  Overrides
  inclusion(const std::string &radius)
  {
    return {"Geometry/Shapes=box, hole, ball, rest",
            "Geometry/hole/Kind=ball",
            "Geometry/hole/Centre=0.5, 0.5",
            "Geometry/hole/Radius=0.3",
            "Geometry/ball/Kind=ball",
            "Geometry/ball/Centre=0.5, 0.5",
            "Geometry/ball/Radius=" + radius,
            "Geometry/rest/Kind=difference",
            "Geometry/rest/Of=box, hole",
            "Bodies/Names=block, ball",
            "Bodies/block/Shape=rest",
            "Bodies/ball/Shape=ball",
            "Bodies/ball/Material=rubber",
            "Bodies/ball/Surface=cut cells"};
  }

  /** Volume of all points, and its first moments. */
  template <int dim>
  std::pair<double, Point<dim>>
  moments(const Model<dim> &model)
  {
    double         volume = 0;
    Tensor<1, dim> first;
    unsigned int   p = 0;
    for (const auto &particle : model.points.sorted.particles)
      {
        const double V = model.points.initial_volume(p++);
        volume += V;
        first += V * particle.get_location();
        EXPECT_TRUE(
          particle.get_surrounding_cell()->bounding_box().point_inside(
            particle.get_location(), 1e-12));
        for (unsigned int d = 0; d < dim; ++d)
          EXPECT_NEAR(particle.get_surrounding_cell()->vertex(0)[d] +
                        particle.get_reference_location()[d] *
                          particle.get_surrounding_cell()->extent_in_direction(
                            d),
                      particle.get_location()[d],
                      1e-14);
      }
    volume = Utilities::MPI::sum(volume, MPI_COMM_WORLD);
    first  = Utilities::MPI::sum(first, MPI_COMM_WORLD);
    return {volume, Point<dim>(first / volume)};
  }

  template <int dim>
  void
  expect_moments(const std::string &kind,
                 const Overrides   &shape,
                 const double       volume,
                 const Point<dim>  &centre,
                 const double       tolerance)
  {
    for (const auto &overrides :
         {Overrides{}, refined, Overrides{"Grid/Method=GIMP"}})
      for (const std::string n : {"2", "3"})
        {
          const Model<dim> model(block_scene(kind),
                                 cut + shape + overrides +
                                   Overrides{"Bodies/block/Points per cell=" +
                                             n});
          const auto [found, place] = moments(model);
          EXPECT_NEAR(found / volume, 1, tolerance) << kind;
          EXPECT_NEAR(place.distance(centre), 0, tolerance) << kind;
        }
  }
} // namespace


TEST(SeedingMpi, CutCellsHaveTheVolumeOfTheShape)
{
  const double pi = numbers::PI;
  expect_moments<2>(
    "plane strain", ball("0.45, 0.5", "0.4"), pi * 0.16, {0.45, 0.5}, 2e-3);
  expect_moments<2>("plane stress",
                    function("(x - 0.45)^2 + (y - 0.5)^2 - 0.16"),
                    pi * 0.16,
                    {0.45, 0.5},
                    2e-3);
  // the ring of Pappus; its centroid is that by volume
  expect_moments<2>("axisymmetric",
                    ball("0.5, 0.5", "0.4"),
                    2 * pi * 0.5 * pi * 0.16,
                    {0.5 + 0.16 / 4 / 0.5, 0.5},
                    4e-3);
  expect_moments<3>("3D",
                    ball("0.5, 0.45, 0.5", "0.4"),
                    4 * pi / 3 * 0.064,
                    {0.5, 0.45, 0.5},
                    4e-3);
}


// The facets of a sphere hold less than it by the square of their size.
TEST(SeedingMpi, ASphereFromAFileConverges)
{
  const double ball  = 4 * numbers::PI / 3 * 0.064;
  double       error = 0;
  for (const unsigned int n : {2, 4, 8})
    {
      const MeshFile file(binary_stl(sphere_triangles({500, 450, 500}, 400, n)),
                          ".stl");
      const Overrides mesh = {"Geometry/Shapes=box, mesh",
                              "Geometry/mesh/Kind=mesh",
                              "Geometry/mesh/File=" + file.name,
                              "Geometry/mesh/Scale=0.001",
                              "Bodies/block/Shape=mesh",
                              "Bodies/block/Points per cell=4"};
      const Model<3>  model(block_scene("3D"), cut + mesh);
      const auto [volume, centre] = moments(model);
      EXPECT_NEAR(centre.distance({0.5, 0.45, 0.5}), 0, 1e-3);
      if (n > 2)
        EXPECT_NEAR(error / (1 - volume / ball), 4, 0.7);
      error = 1 - volume / ball;
      // other points, the same body
      for (const std::string surface : {"points", "whole cells"})
        EXPECT_NEAR(moments(Model<3>(block_scene("3D"),
                                     mesh + Overrides{"Bodies/block/Surface=" +
                                                      surface}))
                        .first /
                      volume,
                    1,
                    surface == "points" ? 0.1 : 0.4);
    }
}


// Shapes and velocities are given in space, not on the box of the grid.
TEST(SeedingMpi, ShapesAreInSpaceUnderAMap)
{
  const Overrides lagrangian = {"Grid/Method=Lagrangian",
                                "Grid/Map=2 + x + 0.5*y; 3 + y*(1 + x)"};
  const Overrides shape      = {"Geometry/box/Lower corner=2, 3",
                                "Geometry/box/Upper corner=3.5, 5"};
  const Model<2>  model(block_scene("plane strain"),
                       lagrangian + function("1.9 - x") + shape);
  double          volume = 0;
  for (unsigned int p = 0; p < model.points.size(); ++p)
    volume += model.points.initial_volume(p);
  EXPECT_NEAR(Utilities::MPI::sum(volume, MPI_COMM_WORLD), 1.25, 1e-12);
  expect_blame(block_scene("plane strain"),
               lagrangian + function("x - 1") + shape,
               "Bodies/block/Shape",
               {"has no points"});
}


TEST(SeedingMpi, BoxesThatFitTheGridStayAsTheyAre)
{
  for (const std::string kind : {"plane strain", "axisymmetric"})
    for (const auto &overrides :
         {Overrides{},
          refined,
          Overrides{"Geometry/box/Lower corner=0.125, 0.25"}})
      {
        const Model<2> model(block_scene(kind),
                             overrides +
                               Overrides{"Bodies/block/Surface=points"}),
          other(block_scene(kind), cut + overrides);
        ASSERT_EQ(model.points.size(), other.points.size());
        auto particle = other.points.sorted.particles.begin();
        for (const auto &one : model.points.sorted.particles)
          {
            EXPECT_EQ(one.get_location(), particle->get_location());
            EXPECT_EQ(one.get_reference_location(),
                      particle->get_reference_location());
            ++particle;
          }
        for (unsigned int p = 0; p < model.points.size(); ++p)
          EXPECT_EQ(model.points.initial_volume(p),
                    other.points.initial_volume(p));
      }
}


TEST(SeedingMpi, AnInterfaceIsNoOverlap)
{
  const Model<2> model(block_scene("plane strain"), cut + inclusion("0.3"));
  EXPECT_NEAR(moments(model).first, 1, 1e-3);
  // by a tenth of a point, too little for any of their places
  expect_blame(block_scene("plane strain"),
               cut + inclusion("0.3125"),
               "Bodies/block/Shape",
               {"overlap", "'ball'"});
}


TEST(SeedingMpi, WholeCellsServeOneMaterial)
{
  const Overrides whole = {"Bodies/block/Surface=whole cells",
                           "Bodies/ball/Surface=whole cells"};
  for (const auto &overrides : {Overrides{}, refined})
    {
      const Model<2>        model(block_scene("plane strain"),
                           inclusion("0.3") + whole + overrides);
      std::map<CellId, int> body;
      unsigned int          p = 0;
      std::array<double, 2> volumes{};
      for (const auto &particle : model.points.sorted.particles)
        {
          const int  here = model.points.body(p);
          const auto id   = particle.get_surrounding_cell()->id();
          EXPECT_EQ(body.emplace(id, here).first->second, here);
          volumes[here] += model.points.initial_volume(p++);
        }
      for (double &volume : volumes)
        volume = Utilities::MPI::sum(volume, MPI_COMM_WORLD);
      EXPECT_NEAR(volumes[0] + volumes[1], 1, 1e-12);
      EXPECT_NEAR(volumes[1], 0.09 * numbers::PI, 0.04);
    }
  // they leave no room for what another body has of its cells
  expect_blame(block_scene("plane strain"),
               cut + inclusion("0.3") + Overrides{whole[1]},
               "Bodies/block/Shape",
               {"overlap", "'ball'"});
}


// Two materials in one cell are told of, one in two bodies is not.
TEST(SeedingMpi, CellsOfTwoMaterialsAreTold)
{
  const Overrides other = {"Materials/Names=rubber, stone",
                           "Materials/stone/Density=1",
                           "Materials/stone/Law=log-strain elastic",
                           "Materials/stone/Young's modulus=100",
                           "Bodies/ball/Material=stone"};
  const Overrides whole = {"Bodies/block/Surface=whole cells",
                           "Bodies/ball/Surface=whole cells"};
  const auto      told  = [&](const Overrides &overrides) {
    return find_shared_cells(
      Model<2>(block_scene("plane strain"), inclusion("0.3") + overrides)
        .points);
  };
  EXPECT_EQ(told(cut), "");
  EXPECT_EQ(told(other + whole), "");
  const auto text = told(cut + other);
  EXPECT_NE(text.find("'block' and 'ball'"), std::string::npos) << text;
}


TEST(Seeding, QuasiStaticBodiesAreCut)
{
  const auto surface = [](const Overrides &overrides) {
    return scene_from<2>(block_scene("plane strain"), overrides)
      .bodies[0]
      .surface;
  };
  EXPECT_EQ(surface({}), SurfaceSeeding::cut_boxes);
  EXPECT_EQ(surface(with_inertia), SurfaceSeeding::whole_boxes);
  EXPECT_EQ(surface(with_inertia + cut), SurfaceSeeding::cut_boxes);
  // Gauss points of cells that fit the body
  EXPECT_EQ(surface({"Grid/Method=Lagrangian"}), SurfaceSeeding::whole_boxes);
}
