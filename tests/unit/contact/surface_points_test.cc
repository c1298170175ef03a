#include <gtest/gtest.h>

#include <map>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  /** The body meets a rigid one that is far away, so that its surface is
   * followed. */
  Overrides
  with_surface(const unsigned int dim)
  {
    const std::string third = dim == 3 ? ", 0" : "";
    return {"Geometry/Shapes=box, far",
            "Geometry/far/Lower corner=-9, -9" + third,
            "Geometry/far/Upper corner=-8, -8" +
              std::string(dim == 3 ? ", 1" : ""),
            "Bodies/Names=block, wall",
            "Bodies/wall/Kind=rigid",
            "Bodies/wall/Contact=surface",
            "Bodies/wall/Shape=far",
            "Contact/Pairs=side",
            "Contact/side/Bodies=block, wall",
            "Contact/side/Kind=frictionless"};
  }

  Overrides
  box(const std::string &lower, const std::string &upper)
  {
    return {"Geometry/box/Lower corner=" + lower,
            "Geometry/box/Upper corner=" + upper};
  }

  // Of all ranks.
  template <int dim>
  struct Sums
  {
    explicit Sums(const SurfacePoints<dim> &points)
    {
      for (unsigned int s = 0; s < points.size(); ++s)
        {
          area += points.area(s).norm();
          vector += points.area(s);
        }
      number = Utilities::MPI::sum(points.size(), points.communicator);
      area   = Utilities::MPI::sum(area, points.communicator);
      vector = Utilities::MPI::sum(vector, points.communicator);
    }

    unsigned int   number;
    double         area = 0;
    Tensor<1, dim> vector; ///< nothing where the surface closes
  };

  template <int dim>
  void
  expect_surface(const std::string    &kind,
                 const Overrides      &overrides,
                 const unsigned int    number,
                 const double          area,
                 const double          tolerance = 1e-9,
                 const Tensor<1, dim> &open      = {})
  {
    SCOPED_TRACE(kind + ", " + overrides.back());
    const Model<dim> model(block_scene(kind), with_surface(dim) + overrides);
    const Sums<dim>  sums(*model.surfaces);
    if (number > 0)
      EXPECT_EQ(sums.number, number);
    EXPECT_NEAR(sums.area / area, 1, tolerance);
    EXPECT_LT((sums.vector - open).norm(), 1e-9 * area);
    for (unsigned int s = 0; s < model.surfaces->size(); ++s)
      EXPECT_EQ(model.surfaces->pair(s), -1);
    // Alone on each rank.
    const Model<dim> alone(block_scene(kind),
                           with_surface(dim) + overrides,
                           MPI_COMM_SELF);
    const Sums<dim>  same(*alone.surfaces);
    EXPECT_EQ(sums.number, same.number);
    EXPECT_NEAR(sums.area, same.area, 1e-12 * area);
  }
} // namespace


TEST(SurfacePointsMpi, CoverTheSurface)
{
  const double pi = numbers::PI;
  // Four cells each way, two points per cell each way.
  const auto middle = box("0.25, 0.25", "0.75, 0.75");
  expect_surface<2>("plane strain", middle, 16, 2);
  expect_surface<2>("plane strain",
                    middle + Overrides{"Bodies/block/Points per cell=3"},
                    24,
                    2);
  expect_surface<2>("plane strain", middle + refined, 0, 2);
  // Not aligned with anything: corners are cut off.
  expect_surface<2>(
    "plane strain", box("0.22, 0.26", "0.7, 0.8"), 0, 2.04, 0.08);
  // None on the axis; the lateral surface and two ends.
  expect_surface<2>("axisymmetric",
                    box("0, 0.25", "0.5, 0.75"),
                    12,
                    2 * pi * 0.5 * 0.5 + 2 * pi * 0.25,
                    1e-9,
                    Tensor<1, 2>({2 * pi * 0.5 * 0.5, 0}));
  expect_surface<3>("3D",
                    box("0.25, 0.25, 0.25", "0.75, 0.75, 0.75"),
                    6 * 16,
                    6 * 0.25);
}


TEST(SurfacePointsMpi, CoverADisc)
{
  const Overrides ball = {"Geometry/Shapes=box, far, ball",
                          "Geometry/ball/Kind=ball",
                          "Geometry/ball/Radius=0.31",
                          "Bodies/block/Shape=ball"};
  expect_surface<2>("plane strain",
                    ball + Overrides{"Geometry/ball/Centre=0.5, 0.5",
                                     "Grid/Cells=8, 8"},
                    0,
                    2 * numbers::PI * 0.31,
                    0.01);
  expect_surface<3>("3D",
                    ball + Overrides{"Geometry/ball/Centre=0.5, 0.5, 0.5",
                                     "Grid/Cells=8, 8, 8"},
                    0,
                    4 * numbers::PI * 0.31 * 0.31,
                    0.02);
}


namespace
{
  template <int dim>
  struct Piece
  {
    Point<dim>     place;
    Tensor<1, dim> area;
  };

  // By number, of this rank.
  template <int dim>
  std::map<types::particle_index, Piece<dim>>
  pieces_of(const SurfacePoints<dim> &points)
  {
    std::map<types::particle_index, Piece<dim>> pieces;
    unsigned int                                s = 0;
    for (const auto &particle : points.sorted.particles)
      pieces[particle.get_id()] = {particle.get_location(), points.area(s++)};
    return pieces;
  }

  template <int dim>
  void
  check_nanson(const std::string    &kind,
               const Overrides      &overrides,
               const Tensor<2, dim> &gradient)
  {
    SCOPED_TRACE(kind + ", " + overrides.back());
    Model<dim>      model(block_scene(kind), with_surface(dim) + overrides);
    const auto      before = pieces_of(*model.surfaces);
    const Sums<dim> at_first(*model.surfaces);
    Tensor<2, dim>  total  = unit_symmetric_tensor<dim>();
    const Tensor<2, dim> F = total + gradient;
    for (unsigned int step = 0; step < 2; ++step)
      {
        model.begin_step();
        const Vector u = model.linear_field(gradient);
        ASSERT_TRUE(model.balance().evaluate(u).admissible);
        model.commit(u);
        total = F * total;
      }
    const double hoop = kind == "axisymmetric" ? total[0][0] : 1.; // u_r = a r
    const auto cofactor = hoop * determinant(total) * transpose(invert(total));
    unsigned int n      = 0;
    // Points that have changed the rank are left to that.
    for (const auto &[id, piece] : pieces_of(*model.surfaces))
      if (const auto old = before.find(id); old != before.end())
        {
          ++n;
          EXPECT_LT(
            (piece.place - Point<dim>(total * old->second.place)).norm(),
            1e-14);
          EXPECT_LT((piece.area - cofactor * old->second.area).norm(),
                    1e-13 * old->second.area.norm());
        }
    EXPECT_GT(Utilities::MPI::sum(n, MPI_COMM_WORLD), 0u);
    EXPECT_EQ(Sums<dim>(*model.surfaces).number, at_first.number);
  }
} // namespace


TEST(SurfacePointsMpi, AreasFollowADeformation)
{
  const Tensor<2, 2> plane(
    {{0.1, 0.04}, {-0.03, -0.08}}); // shear and a change of volume
  for (const std::string method : {"MPM", "GIMP"})
    {
      const auto inner =
        box("0.27, 0.3", "0.7, 0.74") + Overrides{"Grid/Method=" + method};
      check_nanson<2>("plane strain", inner, plane);
      check_nanson<2>("plane strain", inner + refined, plane);
      check_nanson<2>("axisymmetric",
                      box("0, 0.3", "0.6, 0.7") +
                        Overrides{"Grid/Method=" + method},
                      Tensor<2, 2>({{0.1, 0}, {0.07, -0.08}}));
      check_nanson<3>("3D",
                      box("0.27, 0.3, 0.25", "0.7, 0.74, 0.7") +
                        Overrides{"Grid/Method=" + method},
                      Tensor<2, 3>({{0.1, 0.04, 0.01},
                                    {-0.03, -0.08, 0.02},
                                    {0.05, -0.01, 0.03}}));
    }
}


// A surface that presses on a face of the domain is a little way beyond it.
TEST(SurfacePointsMpi, PlacesBeyondAFace)
{
  Model<2>   model(block_scene("plane strain"),
                 with_surface(2) + box("0.25, 0.25", "0.75, 0.75") +
                   Overrides{"Grid/Lower corner=0, 0.2"});
  auto      &surfaces = *model.surfaces;
  const auto before   = Sums<2>(surfaces).number;
  int        n_moved  = 0;
  for (auto &particle : surfaces.sorted.particles)
    {
      auto place = particle.get_location();
      n_moved += place[1] < 0.26 || place[0] > 0.74;
      if (place[1] < 0.26)
        place[1] = 0.19;
      if (place[0] > 0.74)
        place[0] = 1.01;
      particle.set_location(place);
    }
  // However often they are sorted.
  for (unsigned int i = 0; i < 2; ++i)
    {
      surfaces.sort();
      EXPECT_EQ(Sums<2>(surfaces).number, before);
      int n_beyond = 0;
      for (const auto &particle : surfaces.sorted.particles)
        {
          const auto inside = particle.get_location(),
                     place  = surfaces.place(particle);
          EXPECT_GE(inside[1], 0.2);
          EXPECT_LE(inside[0], 1);
          if (place[1] < 0.2 || place[0] > 1)
            {
              ++n_beyond;
              EXPECT_TRUE(std::abs(place[1] - 0.19) < 1e-15 ||
                          std::abs(place[0] - 1.01) < 1e-15);
            }
        }
      EXPECT_EQ(Utilities::MPI::sum(n_beyond - n_moved, MPI_COMM_WORLD), 0);
    }
  EXPECT_GE(Utilities::MPI::sum(n_moved, MPI_COMM_WORLD), 8);
  // Those that come back are where they are.
  for (auto &particle : surfaces.sorted.particles)
    particle.set_location(particle.get_location() + Point<2>(-0.05, 0.05));
  surfaces.sort();
  for (const auto &particle : surfaces.sorted.particles)
    EXPECT_EQ(surfaces.place(particle).distance(particle.get_location()), 0);
}


// Nothing lies outside of the domain, but what the body meets there.
TEST(SurfacePointsMpi, OnFacesThatTheBodyMeets)
{
  const auto block =
    box("0, 0", "0.5, 1") +
    Overrides{"Contact/Pairs=side, foot", "Contact/foot/Kind=frictionless"};
  expect_surface<2>("plane strain",
                    block + Overrides{"Contact/foot/Bodies=block, bottom"},
                    4 + 8,
                    0.5 + 1,
                    1e-9,
                    Tensor<1, 2>({1, -0.5}));
  expect_surface<2>("plane strain",
                    block + Overrides{"Contact/foot/Bodies=block, left"},
                    8 + 8,
                    2);
  expect_surface<2>("axisymmetric",
                    block + Overrides{"Contact/foot/Bodies=block, top"},
                    4 + 8,
                    numbers::PI * (0.25 + 1),
                    1e-9,
                    numbers::PI * Tensor<1, 2>({1, 0.25}));
  expect_surface<3>("3D",
                    box("0, 0, 0", "0.5, 1, 1") +
                      Overrides{"Contact/Pairs=side, foot",
                                "Contact/foot/Kind=frictionless",
                                "Contact/foot/Bodies=front, block"},
                    4 * 8 + 8 * 8,
                    0.5 + 1,
                    1e-9,
                    Tensor<1, 3>({1, 0, 0.5}));
}


// A bond between bodies that are apart would do nothing, and so would a body
// without a surface.
TEST(SurfacePoints, PairsThatCouldDoNothingAreRefused)
{
  const Overrides two   = {"Geometry/Shapes=box, other",
                           "Geometry/box/Upper corner=1, 0.4",
                           "Geometry/other/Lower corner=0, 0.4",
                           "Geometry/other/Upper corner=1, 0.9",
                           "Bodies/Names=block, second",
                           "Bodies/second/Shape=other",
                           "Bodies/second/Material=rubber",
                           "Contact/Pairs=p",
                           "Contact/p/Bodies=block, second",
                           "Contact/p/Kind=bonded"};
  const Overrides apart = {"Geometry/other/Lower corner=0, 0.7"};
  const Overrides full  = {"Geometry/Shapes=box, far",
                           "Geometry/far/Lower corner=8, 8",
                           "Geometry/far/Upper corner=9, 9",
                           "Bodies/Names=block, tool",
                           "Bodies/tool/Kind=rigid",
                           "Bodies/tool/Contact=surface",
                           "Bodies/tool/Shape=far",
                           "Contact/Pairs=p",
                           "Contact/p/Bodies=block, tool",
                           "Contact/p/Kind=frictionless"};
  const auto      make  = [](const Overrides &overrides) {
    Model<2> model(block_scene("plane strain"), overrides);
  };
  EXPECT_NO_THROW(make(two));
  EXPECT_THROW(make(two + apart), InputError);
  EXPECT_THROW(make(full), InputError);
}
