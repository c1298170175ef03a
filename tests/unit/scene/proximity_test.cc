#include <impm/scene/proximity.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "create_shape.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** Places around the unit box and ball. */
  template <int dim>
  std::vector<Point<dim>>
  random_places(const unsigned int n)
  {
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> coordinate(-2.5, 2.5);
    std::vector<Point<dim>>                places(n);
    for (auto &place : places)
      for (unsigned int d = 0; d < dim; ++d)
        place[d] = coordinate(generator);
    return places;
  }

  template <int dim>
  NamedShapes<dim>
  some_shapes()
  {
    NamedShapes<dim> shapes;
    const bool       is_plane = dim == 2;
    shapes["box"] =
      create<dim>("box",
                  {{"Lower corner", is_plane ? "-1, -0.5" : "-1, -0.5, -0.2"},
                   {"Upper corner", is_plane ? "0.7, 1" : "0.7, 1, 0.6"}});
    shapes["endless"] = create<dim>(
      "box",
      {{"Lower corner", is_plane ? "-1e308, -1" : "-1e308, -1, -1e308"},
       {"Upper corner", is_plane ? "1e308, 1e300" : "1, 1e300, 1e308"}});
    shapes["ball"] =
      create<dim>("ball",
                  {{"Centre", is_plane ? "0.3, 0.4" : "0.3, 0.4, -0.2"},
                   {"Radius", "0.8"}});
    if constexpr (dim == 3)
      shapes["cylinder"] = create<3>("cylinder",
                                     {{"Axis from", "-0.6, 0.2, 0.3"},
                                      {"Axis to", "0.7, 0.8, -0.2"},
                                      {"Radius", "0.7"}});
    shapes["union"] = create<dim>("union", {{"Of", "ball, box"}}, shapes);
    shapes["difference"] =
      create<dim>("difference", {{"Of", "box, ball"}}, shapes);
    return shapes;
  }

  template <int dim>
  void
  expect_finite(const Proximity<dim> &found)
  {
    EXPECT_TRUE(std::isfinite(found.distance));
    EXPECT_NEAR(found.normal.norm(), 1, 1e-14);
    EXPECT_TRUE(std::isfinite(found.curvature.norm()));
  }

  template <int dim>
  bool
  is_endless(const Shape<dim> &shape)
  {
    return shape.is_box && shape.bounding_box->side_length(1) > 1e10;
  }

  /** Normal and curvature are what differences of distance and normal are. */
  template <int dim>
  void
  expect_derivatives(const Shape<dim> &shape)
  {
    const double step = 1e-5;
    for (const auto &place : random_places<dim>(2000))
      {
        const auto found = shape.proximity(place);
        expect_finite(found);
        // Round-off of a box with an end far away is as large as that.
        if (!is_endless(shape))
          EXPECT_EQ(found.distance <= 0, shape.contains(place)) << place;

        Tensor<1, dim> normal;
        Tensor<2, dim> curvature;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const Tensor<1, dim> shift  = step * Point<dim>::unit_vector(d);
            const auto           before = shape.proximity(place - shift);
            const auto           after  = shape.proximity(place + shift);
            normal[d]    = (after.distance - before.distance) / (2 * step);
            curvature[d] = (after.normal - before.normal) / (2 * step);
          }
        // What is left out grows with the second power of the curvature, and a
        // far end takes digits.
        const double scale = 1 + found.curvature.norm();
        if (std::abs(found.distance) < 1e10)
          EXPECT_LT((normal - found.normal).norm(), 1e-9 * scale * scale)
            << place;
        EXPECT_LT((curvature - Tensor<2, dim>(found.curvature)).norm(),
                  1e-9 * scale * scale * scale)
          << place;
      }
  }

  template <int dim>
  void
  expect_derivatives_of_all()
  {
    for (const auto &[name, shape] : some_shapes<dim>())
      {
        SCOPED_TRACE(name);
        expect_derivatives(*shape);
      }
  }

  /** The distance is that to the nearest of places which lie on the surface, no
   * farther apart than `spacing`. */
  template <int dim>
  void
  expect_nearest(const Shape<dim>              &shape,
                 const std::vector<Point<dim>> &surface,
                 const double                   spacing)
  {
    for (const auto &place : random_places<dim>(200))
      {
        double nearest = std::numeric_limits<double>::max();
        for (const auto &other : surface)
          nearest = std::min(nearest, place.distance(other));
        const double distance = std::abs(shape.proximity(place).distance);
        EXPECT_LT(distance, nearest + 1e-12);
        EXPECT_GT(std::hypot(distance, spacing) + 1e-12, nearest);
      }
  }
} // namespace


TEST(Proximity, NormalAndCurvatureAreDerivativesOfTheDistance)
{
  expect_derivatives_of_all<2>();
  expect_derivatives_of_all<3>();
}


TEST(Proximity, OfABoxIsToTheNearestPlace)
{
  const unsigned int    n     = 60;
  const auto            shape = some_shapes<3>().at("box");
  std::vector<Point<3>> surface;
  for (unsigned int axis = 0; axis < 3; ++axis)
    for (unsigned int i = 0; i <= n; ++i)
      for (unsigned int j = 0; j <= n; ++j)
        for (const double side : {0., 1.})
          {
            Point<3> unit;
            unit[axis]           = side;
            unit[(axis + 1) % 3] = double(i) / n;
            unit[(axis + 2) % 3] = double(j) / n;
            surface.push_back(shape->bounding_box->unit_to_real(unit));
          }
  expect_nearest(*shape, surface, 1.7 / n);
}


TEST(Proximity, OfACylinderIsToTheNearestPlace)
{
  const unsigned int    n = 120;
  const Point<3>        from(-0.6, 0.2, 0.3), to(0.7, 0.8, -0.2);
  const double          radius = 0.7;
  const auto            axis   = to - from;
  auto                  u = cross_product_3d(axis, Point<3>::unit_vector(2));
  std::vector<Point<3>> surface;
  u /= u.norm();
  const auto v = cross_product_3d(axis / axis.norm(), u);
  for (unsigned int i = 0; i < 3 * n; ++i)
    {
      const double angle   = 2 * numbers::PI * i / (3 * n);
      const auto   outward = std::cos(angle) * u + std::sin(angle) * v;
      for (unsigned int j = 0; j <= n; ++j)
        {
          const double part = double(j) / n;
          surface.push_back(from + part * axis + radius * outward);
          surface.push_back(from + part * radius * outward);
          surface.push_back(to + part * radius * outward);
        }
    }
  expect_nearest(*some_shapes<3>().at("cylinder"), surface, 1.7 / n);
}


TEST(Proximity, OfABallInNumbers)
{
  const auto ball =
    create<2>("ball", {{"Centre", "1, 2"}, {"Radius", "0.5"}})->proximity;
  const auto outside = ball({1 + 1.2, 2 + 1.6});
  EXPECT_NEAR(outside.distance, 1.5, 1e-14);
  EXPECT_LT((outside.normal - Point<2>(0.6, 0.8)).norm(), 1e-14);
  EXPECT_NEAR(trace(outside.curvature), 1 / 2., 1e-14);
  EXPECT_NEAR(ball({1, 2.25}).distance, -0.25, 1e-14);
}


TEST(Proximity, IsFiniteOnSurfacesAxesAndCorners)
{
  for (const std::string corner : {"0", "1e300"})
    {
      const auto box = create<3>("box",
                                 {{"Lower corner", "-1e300, 0, 0"},
                                  {"Upper corner", "1, 1, 1" + corner}})
                         ->proximity;
      for (const double x : {-1e5, 0., 0.5, 1., 1 + 1e-15, 1e5})
        for (const double y : {-5e-324, 0., 0.5, 1., 1 + 1e-15})
          for (const double z : {-5e-324, -1e-300, 0., 0.5, 10., 1e300})
            expect_finite(box({x, y, z}));
    }

  const auto ball =
    create<2>("ball", {{"Centre", "1, 2"}, {"Radius", "0.5"}})->proximity;
  for (const double x : {1., 1 + 1e-15, 1.5})
    expect_finite(ball({x, 2}));
  EXPECT_EQ(ball({1, 2}).distance, -0.5);

  const auto cylinder = create<3>("cylinder",
                                  {{"Axis from", "0, 0, 0"},
                                   {"Axis to", "1, 1, 0"},
                                   {"Radius", "0.5"}})
                          ->proximity;
  for (const double along : {-1., 0., 0.3, 0.5, 1., 2.})
    for (const double z : {0., 1e-15, 0.2, 0.5})
      expect_finite(cylinder({along, along, z}));
}


TEST(Proximity, OfAUnionIsToItsNearestPart)
{
  const auto shapes = some_shapes<2>();
  for (const auto &place : random_places<2>(100))
    EXPECT_EQ(shapes.at("union")->proximity(place).distance,
              std::min(shapes.at("box")->proximity(place).distance,
                       shapes.at("ball")->proximity(place).distance));
}


TEST(Proximity, OfADifferenceLooksIntoTheHole)
{
  NamedShapes<2> shapes;
  shapes["block"] =
    create<2>("box", {{"Lower corner", "-1, -1"}, {"Upper corner", "1, 1"}});
  shapes["hole"] = create<2>("ball", {{"Centre", "0, 0"}, {"Radius", "0.5"}});
  const auto rest =
    create<2>("difference", {{"Of", "block, hole"}}, shapes)->proximity;

  const auto in_hole = rest({0.4, 0});
  EXPECT_NEAR(in_hole.distance, 0.1, 1e-14);
  EXPECT_LT((in_hole.normal - Point<2>(-1, 0)).norm(), 1e-14);
  EXPECT_NEAR(in_hole.curvature[1][1], -1 / 0.4, 1e-12);
  EXPECT_NEAR(rest({0.6, 0}).distance, -0.1, 1e-14);
  EXPECT_NEAR(rest({0.9, 0}).distance, -0.1, 1e-14);
  EXPECT_NEAR(rest({2, 2}).distance, std::sqrt(2.), 1e-14);
}


TEST(Proximity, OfAFunctionIsOfFirstOrder)
{
  const auto ball =
    create<3>("function", {{"Inside where negative", "x^2 + y^2 + z^2 - 4"}})
      ->proximity;
  const auto radial = Point<3>(2, -1, 2) / 3;
  for (const double distance : {-0.1, -0.01, -0.001, 0., 0.001, 0.01, 0.1})
    {
      const auto found = ball(Point<3>((2 + distance) * radial));
      EXPECT_NEAR(found.distance, distance, 0.3 * distance * distance + 1e-9);
      EXPECT_LT((found.normal - radial).norm(), 1e-8);
      EXPECT_EQ(found.curvature.norm(), 0);
    }
}


TEST(Proximity, OfAFunctionIsFiniteWhereItIsFlatOrNoNumber)
{
  const auto at = [](const std::string &text, const Point<2> &place) {
    const auto found = create<2>("function", {{"Inside where negative", text}})
                         ->proximity(place);
    expect_finite(found);
    return found.distance;
  };
  EXPECT_NEAR(at("x^2 + y^2 - 1", {0, 0}), -1, 1e-14);
  EXPECT_EQ(at("x < 1 ? -2 : 3", {0, 0}), -2);
  EXPECT_EQ(at("x < 1 ? -2 : 3", {4, 0}), 3);
  EXPECT_GT(at("sqrt(x) - 1", {-1, 0}), 1e100);
  EXPECT_EQ(at("sqrt(x) - 1", {0, 0}), -1);
  EXPECT_GT(at("1/x", {0, 0}), 1e100);
  EXPECT_LT(at("-1/x", {0, 0}), -1e100);
  EXPECT_GT(at("1e200*exp(1e3*x) + 1e-320*y", {0, 1e3}), 1e-4);
}
