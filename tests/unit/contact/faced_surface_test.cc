#include <impm/contact/faced_surface.h>
#include <impm/scene/surface_of_shape.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "create_shape.h"

using namespace dealii;
using namespace impm;

namespace
{
  constexpr double spacing = 0.1;

  /** Any direction. */
  template <int dim>
  Tensor<1, dim>
  tilted()
  {
    Tensor<1, dim> n;
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = d == 1 ? 0.8 : 0.3 + 0.2 * d;
    return n / n.norm();
  }

  /** Directions along a plane. */
  template <int dim>
  std::array<Tensor<1, dim>, dim - 1>
  along(const Tensor<1, dim> &n)
  {
    if constexpr (dim == 2)
      return {{cross_product_2d(n)}};
    else
      {
        Tensor<1, 3> t = cross_product_3d(n, Tensor<1, 3>({1, 0, 0}));
        t /= t.norm();
        return {{t, cross_product_3d(n, t)}};
      }
  }

  /** Through the origin: eleven patches each way, moved along the plane by up
   * to a part of their spacing. */
  template <int dim>
  std::vector<SurfacePatch<dim>>
  plane_of_patches(const double scatter, const unsigned int body = 1)
  {
    const auto                             n = tilted<dim>();
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> uniform(-scatter, scatter);
    std::vector<SurfacePatch<dim>>         patches;
    for (int i = -5; i <= 5; ++i)
      for (int j = -5; j <= 5; ++j)
        {
          if (dim == 2 && j != 0)
            continue;
          Point<dim> place;
          place += spacing * (i + uniform(generator)) * along<dim>(n)[0];
          if constexpr (dim == 3)
            place += spacing * (j + uniform(generator)) * along<dim>(n)[1];
          patches.push_back({place, n, spacing, body});
        }
    return patches;
  }

  template <int dim>
  void
  check_plane(const double scatter)
  {
    SCOPED_TRACE(scatter);
    const auto              n = tilted<dim>();
    const FacedSurface<dim> surface(plane_of_patches<dim>(scatter));
    std::mt19937            generator(2);
    std::uniform_real_distribution<double> inside(-0.3, 0.3);
    for (unsigned int i = 0; i < 100; ++i)
      {
        const double gap = 0.25 * inside(generator);
        Point<dim>   place;
        place += gap * n;
        for (const auto &t : along<dim>(n))
          place += inside(generator) * t;
        const auto found = surface.find(place, -n, 1, 0.2);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->gap, gap, 1e-14);
        EXPECT_LT((found->normal - n).norm(), 1e-14);
      }
  }

  /** Largest error of the gap in front of a circle, or a cylinder, of radius 1,
   * for whose circumference there are so many patches. */
  template <int dim>
  double
  error_at_circle(const unsigned int n_patches)
  {
    const double                   angle = 2 * numbers::PI / n_patches;
    std::vector<SurfacePatch<dim>> patches;
    const int                      reach = dim == 2 ? 0 : 4;
    for (unsigned int i = 0; i < n_patches; ++i)
      for (int j = -reach; j <= reach; ++j)
        {
          Tensor<1, dim> n;
          n[0] = std::cos(i * angle);
          n[1] = std::sin(i * angle);
          Point<dim> place(n);
          if constexpr (dim == 3)
            place[2] = j * angle;
          patches.push_back({place, n, angle, 0});
        }
    const FacedSurface<dim> surface(patches);
    double                  error = 0;
    for (unsigned int i = 0; i < 50; ++i)
      {
        Tensor<1, dim> n;
        n[0] = std::cos(0.137 * i);
        n[1] = std::sin(0.137 * i);
        for (const double gap : {-0.01, 0.02})
          {
            const auto found =
              surface.find(Point<dim>((1 + gap) * n), -n, 0, 0.4);
            EXPECT_TRUE(found);
            if (found)
              error = std::max(error, std::abs(found->gap - gap));
          }
      }
    return error;
  }
} // namespace


TEST(FacedSurface, APlaneIsExact)
{
  for (const double scatter : {0., 0.04})
    {
      check_plane<2>(scatter);
      check_plane<3>(scatter);
    }
}


// Planes through what is near, and the normals with them, are so where it is
// curved.
TEST(FacedSurface, SecondOrderWhereItIsCurved)
{
  const double coarse = error_at_circle<2>(40), fine = error_at_circle<2>(80);
  EXPECT_LT(fine, 0.7 * std::pow(2 * numbers::PI / 80, 2));
  EXPECT_NEAR(coarse / fine, 4, 0.3);
  EXPECT_NEAR(error_at_circle<3>(40) / error_at_circle<3>(80), 4, 0.3);
}


template <int dim>
void
check_end()
{
  const auto              n = tilted<dim>();
  const FacedSurface<dim> surface(plane_of_patches<dim>(0));
  const auto              is_found = [&](const double way) {
    return surface
      .find(Point<dim>(way * along<dim>(n)[0] + 0.01 * n), -n, 1, 0.2)
      .has_value();
  };
  // The last patch, in the middle of what it stands for, is at 0.5.
  EXPECT_TRUE(is_found(0.5));
  EXPECT_TRUE(is_found(0.54));
  EXPECT_TRUE(is_found(-0.54));
  EXPECT_FALSE(is_found(dim == 2 ? 0.56 : 0.61));
  EXPECT_FALSE(is_found(-0.62));
  EXPECT_FALSE(is_found(0.7));
}

TEST(FacedSurface, NothingBeyondItsEnd)
{
  check_end<2>();
  check_end<3>();
}


// A thin plate has a second side behind the one that is met, which looks away
// and must not be taken for it.
TEST(FacedSurface, WhatLooksAwayIsNotFaced)
{
  const auto n       = tilted<2>();
  auto       patches = plane_of_patches<2>(0);
  for (auto back : plane_of_patches<2>(0))
    {
      back.place -= 0.05 * n;
      back.normal = -n;
      patches.push_back(back);
    }
  const FacedSurface<2> plate(patches);
  const Point<2>        inside(-0.04 * n);
  const auto            from_front = plate.find(inside, -n, 1, 0.2);
  ASSERT_TRUE(from_front);
  EXPECT_NEAR(from_front->gap, -0.04, 1e-14);
  const auto from_back = plate.find(inside, n, 1, 0.2);
  ASSERT_TRUE(from_back);
  EXPECT_NEAR(from_back->gap, -0.01, 1e-14);
  // across
  EXPECT_FALSE(plate.find(inside, along<2>(n)[0], 1, 0.2));
}


TEST(FacedSurface, OtherBodiesAndWhatIsFarAreNotSeen)
{
  const auto n       = tilted<2>();
  auto       patches = plane_of_patches<2>(0);
  for (auto patch : plane_of_patches<2>(0, 7))
    {
      patch.place += 0.05 * n;
      patches.push_back(patch);
    }
  const FacedSurface<2> both(patches);
  const Point<2>        place(0.06 * n);
  EXPECT_NEAR(both.find(place, -n, 1, 0.2)->gap, 0.06, 1e-14);
  EXPECT_NEAR(both.find(place, -n, 7, 0.2)->gap, 0.01, 1e-14);
  EXPECT_FALSE(both.find(place, -n, 2, 0.2));
  EXPECT_FALSE(both.find(place, -n, 1, 0.05));
  EXPECT_FALSE(FacedSurface<2>({}).find(place, -n, 1, 0.2));
}


namespace
{
  struct OfBall
  {
    double missed = 0, largest_error = 0; ///< share of places, and of the gap
  };

  /** In front of the surface of a ball as cells with two points each way find
   * it, some of whose pieces are small. */
  template <int dim>
  OfBall
  look_at_ball(const unsigned int n_cells)
  {
    const Point<dim> centre = [] {
      Point<dim> c;
      for (unsigned int d = 0; d < dim; ++d)
        c[d] = 0.51 + 0.01 * d;
      return c;
    }();
    const double radius = 0.37;
    const auto   ball =
      create<dim>("ball",
                  {{"Centre", dim == 2 ? "0.51, 0.52" : "0.51, 0.52, 0.53"},
                   {"Radius", "0.37"}});
    std::array<unsigned int, dim> divisions;
    divisions.fill(2);
    const double                   h = 1. / n_cells;
    std::vector<SurfacePatch<dim>> patches;
    for (unsigned int c = 0; c < std::pow(n_cells, dim) - 0.5; ++c)
      {
        Point<dim>     lower;
        Tensor<1, dim> extents;
        for (unsigned int d = 0, rest = c; d < dim; ++d, rest /= n_cells)
          {
            lower[d]   = h * (rest % n_cells);
            extents[d] = h;
          }
        for (const auto &piece :
             surface_in_box<dim>(*ball, lower, extents, divisions))
          patches.push_back({piece.position,
                             piece.area / piece.area.norm(),
                             std::pow(piece.area.norm(), 1. / (dim - 1)),
                             0});
      }
    const FacedSurface<dim>                surface(patches);
    std::mt19937                           generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    OfBall                                 result;
    const unsigned int                     n_places = 2000;
    for (unsigned int i = 0; i < n_places; ++i)
      {
        Tensor<1, dim> n;
        for (unsigned int d = 0; d < dim; ++d)
          n[d] = uniform(generator);
        n /= n.norm();
        const double gap = 0.02 * h * uniform(generator);
        if (const auto found =
              surface.find(centre + (radius + gap) * n, -n, 0, h))
          result.largest_error =
            std::max(result.largest_error, std::abs(found->gap - gap));
        else
          result.missed += 1. / n_places;
      }
    return result;
  }
} // namespace


TEST(FacedSurface, SmallPiecesLeaveNoHoles)
{
  for (const unsigned int n : {8, 16, 32})
    {
      const auto plane = look_at_ball<2>(n), space = look_at_ball<3>(n);
      EXPECT_EQ(plane.missed, 0);
      EXPECT_EQ(space.missed, 0);
      EXPECT_LT(plane.largest_error * n * n, 0.5);
      EXPECT_LT(space.largest_error * n * n, 0.7);
    }
}
