#include <deal.II/base/utilities.h>

#include <impm/scene/surface_of_shape.h>

#include <gtest/gtest.h>

#include <cmath>

#include "create_shape.h"

using namespace dealii;
using namespace impm;

namespace
{
  template <int dim>
  Tensor<1, dim>
  repeat(const double value)
  {
    Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = value;
    return result;
  }

  template <int dim>
  std::shared_ptr<const Shape<dim>>
  function(const std::string &expression)
  {
    return create<dim>("function", {{"Inside where negative", expression}});
  }

  /** All of the surface in n^dim cells from a corner on. */
  template <int dim>
  std::vector<SurfacePiece<dim>>
  collect(const Shape<dim>  &shape,
          const Point<dim>  &lower,
          const double       cell_size,
          const unsigned int n,
          const unsigned int divisions = 2)
  {
    std::array<unsigned int, dim> all_divisions;
    all_divisions.fill(divisions);
    std::vector<SurfacePiece<dim>> pieces;
    for (unsigned int i = 0; i < Utilities::fixed_power<dim>(n); ++i)
      {
        // with the round-off of a grid that is not a power of two
        Point<dim> corner;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
          corner[d] = lower[d] + rest % n * cell_size;
        const auto found = surface_in_box<dim>(shape,
                                               corner,
                                               repeat<dim>(cell_size),
                                               all_divisions);
        for (const auto &[position, area] : found)
          for (unsigned int d = 0; d < dim; ++d)
            {
              EXPECT_GT(position[d], corner[d] - 1e-9);
              EXPECT_LT(position[d], corner[d] + cell_size + 1e-9);
            }
        pieces.insert(pieces.end(), found.begin(), found.end());
      }
    return pieces;
  }

  template <int dim>
  struct Sums
  {
    double         measure = 0, volume = 0;
    Tensor<1, dim> forwards, backwards; ///< of all that look one way
  };

  template <int dim>
  Sums<dim>
  add_up(const std::vector<SurfacePiece<dim>> &pieces)
  {
    Sums<dim> sums;
    for (const auto &[position, area] : pieces)
      {
        sums.measure += area.norm();
        sums.volume += position * area / dim;
        for (unsigned int d = 0; d < dim; ++d)
          (area[d] > 0 ? sums.forwards : sums.backwards)[d] += area[d];
      }
    return sums;
  }

  /** To what the margin around corners on the surface lets pass. */
  template <int dim>
  void
  expect_closed(const Sums<dim> &sums, const double tolerance = 1e-10)
  {
    EXPECT_LT((sums.forwards + sums.backwards).norm(),
              tolerance * sums.measure);
  }

  /** Measure and volume of a shape in [-1, 1]^dim with finer and finer cells;
   * the errors, which scatter, against those of an order of two or one. */
  template <int dim>
  void
  expect_orders(const Shape<dim> &shape,
                const double      measure,
                const double      volume,
                const double      least_order_of_measure)
  {
    const std::vector<unsigned int> n = dim == 2 ?
                                          std::vector<unsigned int>{7, 112} :
                                          std::vector<unsigned int>{5, 20};
    std::vector<double>             errors[2];
    for (const auto n_cells : n)
      {
        const auto sums = add_up(
          collect(shape, Point<dim>(repeat<dim>(-1)), 2. / n_cells, n_cells));
        expect_closed(sums);
        errors[0].push_back(std::abs(sums.measure / measure - 1));
        errors[1].push_back(std::abs(sums.volume / volume - 1));
      }
    for (const unsigned int i : {0, 1})
      {
        const double order =
          std::log(errors[i][0] / errors[i][1]) / std::log(double(n[1]) / n[0]);
        EXPECT_GT(order, i == 0 ? least_order_of_measure : 1.8)
          << errors[i][0] << ' ' << errors[i][1];
      }
  }

  /** As a box and as a function, which knows of no round-off. */
  template <int dim>
  std::vector<std::shared_ptr<const Shape<dim>>>
  boxes(const std::vector<std::string> &lower,
        const std::vector<std::string> &upper)
  {
    std::string corner[2], faces;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const std::string separator = d == 0 ? "" : ", ";
        const std::string x(1, "xyz"[d]);
        corner[0] += separator + lower[d];
        corner[1] += separator + upper[d];
        faces +=
          separator + lower[d] + " - " + x + ", " + x + " - (" + upper[d] + ")";
      }
    return {create<dim>("box",
                        {{"Lower corner", corner[0]},
                         {"Upper corner", corner[1]}}),
            function<dim>("max(" + faces + ")")};
  }
} // namespace


TEST(SurfaceOfShape, OfACircleAndASphereConvergesAtSecondOrder)
{
  const double r = 0.7, pi = numbers::PI;
  expect_orders<2>(*create<2>("ball",
                              {{"Centre", "0.11, -0.07"}, {"Radius", "0.7"}}),
                   2 * pi * r,
                   pi * r * r,
                   1.8);
  expect_orders<3>(
    *create<3>("ball", {{"Centre", "0.11, -0.07, 0.03"}, {"Radius", "0.7"}}),
    4 * pi * r * r,
    4 * pi * r * r * r / 3,
    1.8);
}


TEST(SurfaceOfShape, Closes)
{
  const auto circle =
    create<2>("ball", {{"Centre", "0.11, -0.07"}, {"Radius", "0.7"}});
  expect_closed(add_up(collect<2>(*circle, {-1, -1}, 0.1, 20)), 1e-12);
  const auto sphere =
    create<3>("ball", {{"Centre", "0.11, -0.07, 0.03"}, {"Radius", "0.7"}});
  expect_closed(add_up(collect<3>(*sphere, {-1, -1, -1}, 0.1, 20)), 1e-12);
}


TEST(SurfaceOfShape, OfATurnedBoxIsCutOffAtItsEdges)
{
  // cos 0.8 and sin 0.6
  const std::string u = "abs(0.8*x + 0.6*y - 0.02)",
                    v = "abs(0.8*y - 0.6*x - 0.01)";
  expect_orders<2>(*function<2>("max(" + u + " - 0.5," + v + " - 0.3)"),
                   3.2,
                   0.6,
                   0.8);
  expect_orders<3>(*function<3>("max(" + u + " - 0.5, " + v +
                                " - 0.3, abs(z) - 0.4)"),
                   2 * (0.6 + 0.48 + 0.8),
                   0.48,
                   0.8);
}


TEST(SurfaceOfShape, OfABoxOnTheLatticeIsThatOfTheBox)
{
  for (const unsigned int divisions : {1, 2, 3})
    {
      for (const auto &shape : boxes<2>({"0.1", "0.3"}, {"0.4", "0.5"}))
        {
          const auto pieces = collect<2>(*shape, {-0.1, 0}, 0.1, 8, divisions);
          const auto sums   = add_up(pieces);
          expect_closed(sums);
          EXPECT_EQ(pieces.size(), 10 * divisions);
          EXPECT_NEAR(sums.forwards[0], 0.2, 1e-10);
          EXPECT_NEAR(sums.forwards[1], 0.3, 1e-10);
          EXPECT_NEAR(sums.measure, 1, 1e-10);
          EXPECT_NEAR(sums.volume, 0.06, 1e-10);
        }
      for (const auto &shape :
           boxes<3>({"0.1", "0.3", "-0.2"}, {"0.4", "0.5", "0.2"}))
        {
          const auto pieces =
            collect<3>(*shape, {-0.1, 0, -0.3}, 0.1, 7, divisions);
          const auto sums = add_up(pieces);
          expect_closed(sums);
          EXPECT_EQ(pieces.size(), 52 * divisions * divisions);
          EXPECT_NEAR(sums.forwards[0], 0.08, 1e-10);
          EXPECT_NEAR(sums.forwards[1], 0.12, 1e-10);
          EXPECT_NEAR(sums.forwards[2], 0.06, 1e-10);
          EXPECT_NEAR(sums.measure, 0.52, 1e-10);
          EXPECT_NEAR(sums.volume, 0.024, 1e-10);
        }
    }
}


TEST(SurfaceOfShape, RoundOffOnTheLatticeDecidesNothing)
{
  // Cells of 0.1 and 1/3 from a place without digits in common with them: the
  // faces of the function lie an ulp to either side of the lattice.
  for (const double size : {0.1, 1. / 3, 0.7})
    for (const double origin : {0.123456789, -7.77, 100.1})
      {
        const auto text = [&](const double cells) {
          return "(" + Utilities::to_string(origin, 17) + " + " +
                 std::to_string(cells) + "*" + Utilities::to_string(size, 17) +
                 ")";
        };
        const auto shape =
          function<2>("max(" + text(2) + " - x, x - " + text(7) + ", " +
                      text(1) + " - y, y - " + text(5) + ")");
        const auto pieces = collect<2>(*shape, {origin, origin}, size, 9, 1);
        EXPECT_EQ(pieces.size(), 18);
        const auto sums = add_up(pieces);
        expect_closed(sums);
        EXPECT_NEAR(sums.measure, 18 * size, 1e-9 * size);
      }
}


TEST(SurfaceOfShape, OnTheBoundaryOfAllBoxesThereIsNone)
{
  const auto shape = boxes<2>({"0", "0"}, {"1", "1"})[0];
  const auto sums  = add_up(collect<2>(*shape, {0, -1}, 0.5, 4));
  EXPECT_NEAR(sums.backwards[0], 0, 1e-12);
  EXPECT_NEAR(sums.forwards[0], 1, 1e-9);
  EXPECT_NEAR(sums.backwards[1], -1, 1e-9);
}


TEST(SurfaceOfShape, OfAPlateHasBothSides)
{
  // no corner in it, one row of corners, many
  const auto none = boxes<3>({"-2", "0.31", "-2"}, {"2", "0.45", "2"});
  for (const auto &shape : none)
    EXPECT_TRUE(collect<3>(*shape, {-1, -1, -1}, 0.5, 4).empty());
  for (const std::string lower : {"0.21", "-0.6"})
    for (const auto &shape : boxes<3>({"-2", lower, "-2"}, {"2", "0.3", "2"}))
      {
        const auto pieces = collect<3>(*shape, {-1, -1, -1}, 0.5, 4);
        EXPECT_EQ(pieces.size(), 128);
        for (const auto &[position, area] : pieces)
          {
            EXPECT_NEAR(position[1],
                        area[1] > 0 ? 0.3 : std::stod(lower),
                        1e-9);
            EXPECT_NEAR(std::abs(area[1]), 0.25 * 0.25, 1e-9);
          }
      }
}


TEST(SurfaceOfShape, SidesInOnePartStayApart)
{
  const auto plate = function<2>("abs(y - x) - 0.1");
  const auto sides = surface_in_box<2>(*plate, {0, 0}, repeat<2>(1), {{1, 1}});
  ASSERT_EQ(sides.size(), 2);
  for (const auto &[position, area] : sides)
    {
      const Tensor<1, 2> outwards({-area[1] / std::abs(area[1]), 1});
      EXPECT_LT(position.distance(area[1] > 0 ? Point<2>(0.45, 0.55) :
                                                Point<2>(0.55, 0.45)),
                1e-9);
      EXPECT_NEAR(area[0], -area[1], 1e-9);
      EXPECT_NEAR(area.norm(), 0.9 * std::sqrt(2.), 1e-9);
    }

  const auto layer = function<3>("abs(y - x) - 0.1");
  const auto sums =
    add_up(surface_in_box<3>(*layer, {0, 0, 0}, repeat<3>(1), {{1, 1, 1}}));
  EXPECT_NEAR(sums.measure, 2 * 0.9 * std::sqrt(2.), 1e-9);
  EXPECT_LT((sums.forwards - Point<3>(0.9, 0.9, 0)).norm(), 1e-9);
}


TEST(SurfaceOfShape, LooksOutOfTheMaterialIntoItsHole)
{
  NamedShapes<2> shapes;
  shapes["block"]  = boxes<2>({"-0.5", "-0.5"}, {"0.5", "0.5"})[0];
  shapes["hole"]   = create<2>("ball", {{"Centre", "0, 0"}, {"Radius", "0.3"}});
  shapes["window"] = boxes<2>({"-0.2", "-0.1"}, {"0.1", "0.3"})[1];

  const auto round  = create<2>("difference", {{"Of", "block, hole"}}, shapes);
  const auto pieces = collect<2>(*round, {-1, -1}, 0.1, 20);
  auto       sums   = add_up(pieces);
  expect_closed(sums);
  EXPECT_NEAR(sums.volume, 1 - numbers::PI * 0.09, 1e-3);
  EXPECT_NEAR(sums.measure, 4 + 0.6 * numbers::PI, 3e-3);
  for (const auto &[position, area] : pieces)
    {
      const auto found = round->proximity(position);
      EXPECT_LT(std::abs(found.distance), 2e-3);
      EXPECT_GT(found.normal * area, 0.99 * area.norm());
    }

  // A hole whose sides lie on the lattice: edges that look inwards are cut off,
  // which takes nothing from what looks along an axis.
  const auto square =
    create<2>("difference", {{"Of", "block, window"}}, shapes);
  sums = add_up(collect<2>(*square, {-1, -1}, 0.1, 20));
  expect_closed(sums);
  EXPECT_NEAR(sums.forwards[0], 1.4, 1e-9);
  EXPECT_NEAR(sums.forwards[1], 1.3, 1e-9);
  EXPECT_NEAR(sums.measure, 5.4, 0.15);
  EXPECT_NEAR(sums.volume, 1 - 0.12, 5e-3);
}
