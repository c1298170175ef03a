#include <impm/base/exceptions.h>
#include <impm/scene/mesh_file.h>
#include <impm/scene/surface_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "mesh_writer.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** Random ones, and those of a lattice with planes through edges and corners
   * of a box from 0 to 1. */
  template <int dim>
  std::vector<Point<dim>>
  some_places()
  {
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> coordinate(-0.7, 1.7);
    std::vector<Point<dim>>                places(1000);
    for (auto &place : places)
      for (unsigned int d = 0; d < dim; ++d)
        place[d] = coordinate(generator);
    for (unsigned int i = 0; i < std::pow(9, dim); ++i)
      {
        auto        &place = places.emplace_back();
        unsigned int rest  = i;
        for (unsigned int d = 0; d < dim; ++d, rest /= 9)
          place[d] = 0.25 * (rest % 9) - 0.5;
      }
    return places;
  }

  FacettedSurface<3>
  surface_of(const Triangles &triangles)
  {
    return read_mesh_file<3>(MeshFile(ascii_stl(triangles), ".stl").name);
  }

  Triangles
  operator+(Triangles first, const Triangles &second)
  {
    first.insert(first.end(), second.begin(), second.end());
    return first;
  }

  /** The polygon, facets from each vertex to the next one. */
  FacettedSurface<2>
  polygon(const std::vector<Point<2>> &vertices)
  {
    FacettedSurface<2> surface{vertices, {}};
    for (unsigned int i = 0; i < vertices.size(); ++i)
      surface.facets.push_back(
        {{i, static_cast<unsigned int>((i + 1) % vertices.size())}});
    return surface;
  }

  template <int dim>
  void
  expect_refused(const FacettedSurface<dim> &surface, const std::string &words)
  {
    try
      {
        SurfaceMesh<dim> mesh(surface);
        FAIL() << "taken, though " << words;
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, "");
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
          << error.what();
      }
  }

  /** Distance and normal, and curvature unless what is nearest is ambiguous,
   * as they are for a box from 0 to 1. */
  template <int dim>
  void
  expect_box(const SurfaceMesh<dim> &mesh)
  {
    Point<dim> upper;
    for (unsigned int d = 0; d < dim; ++d)
      upper[d] = 1;
    for (const auto &place : some_places<dim>())
      {
        const auto found  = mesh.proximity(place);
        const auto wanted = proximity_to_box(place, Point<dim>(), upper);
        EXPECT_NEAR(found.distance, wanted.distance, 1e-14) << place;
        EXPECT_NEAR(found.normal.norm(), 1, 1e-14) << place;
        EXPECT_EQ(mesh.contains(place), wanted.distance <= 0) << place;
        // One of those around is taken where there are several.
        const double step = 1e-4;
        const auto   back = place - step * found.normal;
        EXPECT_NEAR(found.distance - proximity_to_box(back, {}, upper).distance,
                    step,
                    wanted.distance > 0 ? 1e-12 : 2 * step)
          << place;
        if (wanted.distance > 1e-9)
          {
            EXPECT_LT((found.normal - wanted.normal).norm(), 1e-12) << place;
            // It jumps where a face ends.
            bool is_at_end = false;
            for (unsigned int d = 0; d < dim; ++d)
              is_at_end = is_at_end || place[d] == 0 || place[d] == 1;
            if (!is_at_end)
              EXPECT_LT((found.curvature - wanted.curvature).norm(), 1e-9)
                << place;
          }
        else
          EXPECT_LT(found.curvature.norm(), 1e-9) << place;
      }
  }
} // namespace

TEST(SurfaceMesh, ABoxOfFacetsIsABox)
{
  expect_box(
    SurfaceMesh<2>(polygon({{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0, 1}})));
  expect_box(SurfaceMesh<3>(surface_of(box_triangles({0, 0, 0}, {1, 1, 1}))));
  for (const unsigned int n : {1, 2, 3})
    {
      const BlockMesh<2> square({0, 0}, {1, 1}, n);
      const BlockMesh<3> cube({0, 0, 0}, {1, 1, 1}, n);
      expect_box(
        SurfaceMesh<2>(read_mesh_file<2>(MeshFile(square.msh(), ".msh").name)));
      expect_box(
        SurfaceMesh<3>(read_mesh_file<3>(MeshFile(cube.msh(), ".msh").name)));
    }
}

// A corner of 3 degrees, where normals of faces alone could not tell.
TEST(SurfaceMesh, SharpCornersHaveTheirOutside)
{
  const SurfaceMesh<2> wedge(polygon({{0, 0}, {1, -0.025}, {1, 0.025}}));
  const SurfaceMesh<2> notch(polygon(
    {{-1, -1}, {1, -1}, {1, -0.02}, {0, 0}, {1, 0.02}, {1, 1}, {-1, 1}}));
  for (double angle = 0.05; angle < 3.1; angle += 0.05)
    for (const double side : {-1., 1.})
      {
        const Point<2> place(-0.1 * std::cos(angle),
                             side * 0.1 * std::sin(angle));
        EXPECT_EQ(wedge.contains(place), false) << place;
        EXPECT_EQ(notch.contains(place),
                  !(std::abs(place[1]) < 0.02 * place[0]))
          << place;
      }
  EXPECT_TRUE(wedge.contains({0.1, 0.001}));
  EXPECT_FALSE(notch.contains({0.1, 0.001}));

  // a needle with a square foot, seen from around its point
  const Point<3> tip(0, 0, 1);
  const Point<3> foot[4] = {{-0.02, -0.02, 0},
                            {0.02, -0.02, 0},
                            {0.02, 0.02, 0},
                            {-0.02, 0.02, 0}};
  Triangles      needle  = {{{foot[0], foot[2], foot[1]}},
                            {{foot[0], foot[3], foot[2]}}};
  for (unsigned int i = 0; i < 4; ++i)
    needle.push_back({{foot[i], foot[(i + 1) % 4], tip}});
  const SurfaceMesh<3>             mesh(surface_of(needle));
  std::mt19937                     generator(2);
  std::normal_distribution<double> normal;
  for (unsigned int i = 0; i < 1000; ++i)
    {
      Tensor<1, 3> way;
      for (unsigned int d = 0; d < 3; ++d)
        way[d] = normal(generator);
      const Point<3> place  = tip + 0.05 / way.norm() * way;
      const double   across = std::max(std::abs(place[0]), std::abs(place[1]));
      EXPECT_EQ(mesh.contains(place), across <= 0.02 * (1 - place[2])) << place;
    }
}

// Places on the surface, and beside it by less than round-off: inside, with the
// normal of a facet. Beside it by more they are not.
TEST(SurfaceMesh, RoundOffDoesNotDecide)
{
  const auto           triangles = sphere_triangles({0.3, 0.2, 0.1}, 0.7, 6);
  const SurfaceMesh<3> mesh(surface_of(triangles));
  for (const auto &[a, b, c] : triangles)
    for (const double u : {0., 0.3, 0.5, 1.})
      for (const double v : {0., 0.25, 0.5})
        {
          // to the digits of the file
          const Point<3> place = a + u * (1 - v) * (b - a) + v * u * (c - a);
          const auto     found = mesh.proximity(place);
          EXPECT_NEAR(found.distance, 0, 1e-8);
          EXPECT_NEAR(found.normal.norm(), 1, 1e-14);
          EXPECT_GT(found.normal * (place - Point<3>(0.3, 0.2, 0.1)), 0.5);
          EXPECT_TRUE(std::isfinite(found.curvature.norm()));
        }
  const SurfaceMesh<3> box(surface_of(box_triangles({0, 0, 0}, {0.4, 2, 1})));
  EXPECT_TRUE(box.contains({0.1 + 0.1 + 0.1 + 0.1, 2, 1}));
  EXPECT_TRUE(box.contains({0.4 + 1e-13, 1, 1}));
  EXPECT_FALSE(box.contains({0.4 + 1e-9, 1, 0}));
  for (const auto &corner : {Point<3>(0, 0, 0), Point<3>(0.4, 2, 1)})
    {
      const auto found = box.proximity(corner);
      EXPECT_EQ(found.distance, 0);
      EXPECT_EQ(found.normal.norm(), 1);
      EXPECT_EQ(found.curvature.norm(), 0);
    }
}

// However facets look in the file, and whatever lies in what.
TEST(SurfaceMesh, FacetsLookOutwards)
{
  const auto   outer  = box_triangles({0, 0, 0}, {1, 1, 1});
  const auto   cavity = box_triangles({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8});
  const auto   core   = box_triangles({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
  const auto   apart  = box_triangles({2, 0, 0}, {3, 1, 1});
  auto         all    = outer + cavity + core + apart;
  std::mt19937 generator(3);
  for (unsigned int run = 0; run < 10; ++run)
    {
      std::shuffle(all.begin(), all.end(), generator);
      for (auto &[a, b, c] : all)
        if (generator() % 2)
          std::swap(a, b);
      const SurfaceMesh<3> mesh(surface_of(all));
      EXPECT_TRUE(mesh.contains({0.1, 0.5, 0.5}));
      EXPECT_FALSE(mesh.contains({0.3, 0.5, 0.5}));
      EXPECT_TRUE(mesh.contains({0.5, 0.5, 0.5}));
      EXPECT_FALSE(mesh.contains({1.5, 0.5, 0.5}));
      EXPECT_TRUE(mesh.contains({2.5, 0.5, 0.5}));
      EXPECT_NEAR(mesh.proximity({0.3, 0.5, 0.5}).distance, 0.1, 1e-14);
      EXPECT_NEAR(mesh.proximity({0.5, 0.5, 0.5}).distance, -0.1, 1e-14);
    }
  for (const bool turned : {false, true})
    {
      auto vertices = std::vector<Point<2>>{{0, 0}, {1, 0}, {0.5, 1}};
      if (turned)
        std::reverse(vertices.begin(), vertices.end());
      const SurfaceMesh<2> mesh(polygon(vertices));
      EXPECT_TRUE(mesh.contains({0.5, 0.5}));
      EXPECT_FALSE(mesh.contains({0, 0.5}));
    }
}

// Two boxes with an edge, or a corner, in common.
TEST(SurfaceMesh, PartsMayTouch)
{
  for (const double z : {0., 1.})
    {
      const SurfaceMesh<3> mesh(
        surface_of(box_triangles({0, 0, 0}, {1, 1, 1}) +
                   box_triangles({1, 1, z}, {2, 2, z + 1})));
      EXPECT_TRUE(mesh.contains({0.99, 0.99, 0.99}));
      EXPECT_TRUE(mesh.contains({1.01, 1.01, z + 0.01}));
      EXPECT_TRUE(mesh.contains({1, 1, 1}));
      EXPECT_FALSE(mesh.contains({0.99, 1.01, 0.5}));
      EXPECT_FALSE(mesh.contains({1.01, 0.99, z + 0.5}));
      EXPECT_NEAR(mesh.proximity({1.1, 1.1, z - 0.1}).distance, 0.1, 1e-14);
    }
}

TEST(SurfaceMesh, ASphereConverges)
{
  const Point<3> centre(0.1, 0.2, 0.3);
  double         error = 0;
  for (const unsigned int n : {4, 8, 16, 32})
    {
      const SurfaceMesh<3> mesh(surface_of(sphere_triangles(centre, 0.5, n)));
      double               largest = 0;
      for (const auto &place : some_places<3>())
        {
          const auto found  = mesh.proximity(place);
          const auto wanted = proximity_to_ball(place, centre, 0.5);
          largest =
            std::max(largest, std::abs(found.distance - wanted.distance));
        }
      if (n > 4)
        EXPECT_GT(error / largest, 3.4) << n;
      error = largest;
    }
  EXPECT_LT(error, 1e-3);
}

TEST(SurfaceMesh, WhatEnclosesNothingIsRefused)
{
  auto open = box_triangles({0, 0, 0}, {1, 1, 1});
  open.pop_back();
  expect_refused(surface_of(open),
                 "is not closed: 3 edges with an odd number of facets, one of "
                 "them around (");
  expect_refused<2>({{{0, 0}, {1, 0}, {0, 1}}, {{{0, 1}}, {{1, 2}}}},
                    "is not closed: 2 vertices with an odd number of segments, "
                    "one of them at (0 0)");
  const Point<3> a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
  // twice the same square, of two ways to cut it
  expect_refused(surface_of(
                   {{{a, b, d}}, {{a, d, c}}, {{a, b, c}}, {{b, d, c}}}),
                 "encloses nothing");
  expect_refused<2>({{{0, 0}, {1e60, 0}, {0, 1e60}},
                     {{{0, 1}}, {{1, 2}}, {{2, 0}}}},
                    "has a size of 1.4142");

  // a Klein bottle
  FacettedSurface<3> bottle;
  const unsigned int n      = 8;
  const auto         vertex = [&](unsigned int i, unsigned int j) {
    if (i == n)
      {
        i = 0;
        j = (n - j) % n;
      }
    return i * n + j % n;
  };
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j)
      {
        const double u = 2 * numbers::PI * i / n, v = 2 * numbers::PI * j / n;
        bottle.vertices.emplace_back((2 + std::cos(v)) * std::cos(u),
                                     (2 + std::cos(v)) * std::sin(u),
                                     std::sin(v) * std::cos(u / 2));
        const unsigned int corners[] = {vertex(i, j),
                                        vertex(i + 1, j),
                                        vertex(i, j + 1),
                                        vertex(i + 1, j + 1)};
        bottle.facets.push_back({{corners[0], corners[1], corners[2]}});
        bottle.facets.push_back({{corners[1], corners[3], corners[2]}});
      }
  expect_refused(bottle, "has one side only, around (");
}
