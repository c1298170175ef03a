#include <deal.II/base/utilities.h>

#include <impm/scene/part_of_box.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace impm;
using namespace dealii;

namespace
{
  template <int dim>
  BoundingBox<dim>
  unit_box()
  {
    return create_unit_bounding_box<dim>();
  }

  /** Measure and first and second moments along x of what lies inside, from
   * n^dim boxes over [0, 1.3]^dim. */
  template <int dim, typename Contains>
  std::vector<double>
  add_up(const unsigned int n, const Contains &contains)
  {
    const double        edge = 1.3 / n;
    std::vector<double> sums(3);
    for (unsigned int i = 0; i < Utilities::fixed_power<dim>(n); ++i)
      {
        Point<dim> lower, upper;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
          {
            lower[d] = rest % n * edge;
            upper[d] = lower[d] + edge;
          }
        const auto part =
          find_part<dim>(contains, BoundingBox<dim>({lower, upper}));
        double box = 1;
        for (unsigned int d = 0; d < dim; ++d)
          box *= part.extents[d];
        EXPECT_NEAR(box, part.share * std::pow(edge, dim), 1e-12);
        const double x = part.centroid[0], h = part.extents[0];
        sums[0] += box;
        sums[1] += box * x;
        sums[2] += box * (x * x + h * h / 12);
      }
    return sums;
  }

  /** Errors have to be below those of second order in the edges of the boxes:
   * they scatter with where the surface cuts them. */
  template <int dim, typename Contains>
  void
  converge(const Contains &contains, const std::vector<double> &exact)
  {
    for (const unsigned int n : {8, 16, dim == 2 ? 128 : 32})
      {
        const auto sums = add_up<dim>(n, contains);
        for (unsigned int i = 0; i < 3; ++i)
          EXPECT_NEAR(sums[i] / exact[i], 1, 0.15 / (n * n)) << n << ' ' << i;
      }
  }
} // namespace


TEST(PartOfBox, WholeAndNone)
{
  for (const double x : {1., 1 - 5e-3, 1 + 1e-4})
    {
      const auto below =
        find_part<2>([&](const Point<2> &place) { return place[0] <= x; },
                     unit_box<2>());
      EXPECT_EQ(below.share, 1);
      EXPECT_EQ(below.centroid, Point<2>(0.5, 0.5));
      EXPECT_EQ(below.extents, Point<2>(1, 1));
      const auto above =
        find_part<2>([&](const Point<2> &place) { return place[0] >= x; },
                     unit_box<2>());
      EXPECT_EQ(above.share, 0);
    }
}


TEST(PartOfBox, FlatSurfacesAcrossAnAxis)
{
  const BoundingBox<2> box({Point<2>(1, 2), Point<2>(3, 6)});
  const auto           part =
    find_part<2>([](const Point<2> &x) { return x[1] <= 3; }, box);
  EXPECT_NEAR(part.share, 0.25, 2e-5);
  EXPECT_NEAR(part.centroid.distance({2, 2.5}), 0, 1e-4);
  EXPECT_NEAR(part.extents[0], 2, 1e-4);
  EXPECT_NEAR(part.extents[1], 1, 1e-4);

  // a film within the box, thinner than its half
  const auto film =
    find_part<3>([](const Point<3> &x) { return x[2] >= 0.31 && x[2] <= 0.63; },
                 unit_box<3>());
  EXPECT_NEAR(film.share, 0.32, 2e-5);
  EXPECT_NEAR(film.centroid.distance({0.5, 0.5, 0.47}), 0, 1e-4);
  EXPECT_NEAR(film.extents[2], 0.32, 1e-4);
}


TEST(PartOfBox, ACorner)
{
  // a right triangle: centroid at a third, edges that have its second moments
  const double a = 0.7;
  const auto   part =
    find_part<2>([&](const Point<2> &x) { return x[0] + x[1] <= a; },
                 unit_box<2>());
  EXPECT_NEAR(part.share, a * a / 2, 2e-3);
  EXPECT_NEAR(part.centroid.distance({a / 3, a / 3}), 0, 2e-3);
  EXPECT_NEAR(part.extents[0], part.extents[1], 5e-3);
}


TEST(PartOfBox, MomentsOfABallConvergeAtSecondOrder)
{
  const double pi = numbers::PI;
  converge<2>([](const auto &x) { return x.norm_square() <= 1; },
              {{pi / 4, 1. / 3, pi / 16}});
  converge<3>([](const auto &x) { return x.norm_square() <= 1; },
              {{pi / 6, pi / 16, pi / 30}});
  // off the lattice, and not convex
  const Point<2> centre(0.31, 0.27);
  const double   r = 0.2;
  converge<2>(
    [&](const Point<2> &x) {
      return x.norm_square() <= 1 && x.distance(centre) > r;
    },
    {{pi / 4 - pi * r * r,
      1. / 3 - pi * r * r * centre[0],
      pi / 16 - pi * r * r * (centre[0] * centre[0] + r * r / 4)}});
}
