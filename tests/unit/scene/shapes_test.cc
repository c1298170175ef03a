#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "create_shape.h"

using namespace impm;
using dealii::BoundingBox;
using dealii::Point;

namespace
{
  /** Expects an InputError about `entry` that says all of `words`. */
  template <typename Action>
  void
  expect_error(const Action                   &action,
               const std::string              &entry,
               const std::vector<std::string> &words)
  {
    try
      {
        action();
        FAIL() << "no error about '" << entry << "'";
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, entry);
        for (const auto &word : words)
          EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << "no \"" << word << "\" in: " << error.what();
      }
  }

  template <int dim>
  void
  expect_box(const std::optional<BoundingBox<dim>> &box,
             const Point<dim>                      &lower,
             const Point<dim>                      &upper)
  {
    ASSERT_TRUE(box.has_value());
    EXPECT_LT(box->get_boundary_points().first.distance(lower), 1e-14);
    EXPECT_LT(box->get_boundary_points().second.distance(upper), 1e-14);
  }

  NamedShapes<2>
  two_boxes()
  {
    return {
      {"left",
       create<2>("box", {{"Lower corner", "0, 0"}, {"Upper corner", "1, 1"}})},
      {"right",
       create<2>("box", {{"Lower corner", "1, 0"}, {"Upper corner", "2, 3"}})}};
  }
} // namespace

TEST(Shapes, ListNamesTheKinds)
{
  const auto names = [](const auto &list) {
    std::vector<std::string> result;
    for (const auto &entry : list)
      {
        EXPECT_FALSE(entry.documentation.empty()) << entry.name;
        result.push_back(entry.name);
      }
    return result;
  };
  EXPECT_EQ(names(shape_list<2>()),
            (std::vector<std::string>{"box",
                                      "ball",
                                      "union",
                                      "difference",
                                      "intersection",
                                      "mesh",
                                      "function"}));
  EXPECT_EQ(names(shape_list<3>()),
            (std::vector<std::string>{"box",
                                      "ball",
                                      "cylinder",
                                      "union",
                                      "difference",
                                      "intersection",
                                      "mesh",
                                      "function"}));
}

TEST(Shapes, EntriesHaveToBeSet)
{
  for (const auto &entry : shape_list<3>())
    {
      dealii::ParameterHandler prm;
      entry.declare(prm);
      EXPECT_THROW(prm.assert_that_entries_have_been_set(),
                   dealii::ExceptionBase)
        << entry.name;
      EXPECT_THROW(entry.create(prm, {}, {}), InputError) << entry.name;
    }
}

TEST(Shapes, Box)
{
  const auto box =
    create<3>("box",
              {{"Lower corner", "0.1, 0, -1"}, {"Upper corner", "0.4, 2, 1"}});
  EXPECT_TRUE(box->contains({0.2, 1, 0}));
  EXPECT_TRUE(box->contains({0.1, 0, -1}));
  EXPECT_TRUE(box->contains({0.4, 2, 1}));
  EXPECT_TRUE(box->contains({0.1 + 0.1 + 0.1 + 0.1, 2, 1}));
  EXPECT_FALSE(box->contains({0.4 + 1e-9, 1, 0}));
  EXPECT_FALSE(box->contains({0.2, -1e-9, 0}));
  EXPECT_FALSE(box->contains({0.2, 1, 1.1}));
  expect_box<3>(box->bounding_box, {0.1, 0, -1}, {0.4, 2, 1});
}

TEST(Shapes, BoxWithoutEndStaysSharpElsewhere)
{
  const auto box =
    create<2>("box",
              {{"Lower corner", "-1e308, 0"}, {"Upper corner", "1e308, 1"}});
  EXPECT_TRUE(box->contains({1e6, 0.5}));
  EXPECT_FALSE(box->contains({1e6, 1.001}));
}

TEST(Shapes, BoxErrors)
{
  const auto try_corners = [](const std::string &lower,
                              const std::string &upper) {
    return [=]() {
      create<2>("box", {{"Lower corner", lower}, {"Upper corner", upper}});
    };
  };
  expect_error(try_corners("0, 0", "1, 0"),
               "Upper corner",
               {"found '1, 0'", "allowed", "'0, 0'"});
  expect_error(try_corners("2, 0", "1, 1"), "Upper corner", {"found '1, 1'"});
  expect_error(try_corners("0, 0, 0", "1, 1"),
               "Lower corner",
               {"found '0, 0, 0'", "allowed", "2"});
  expect_error(try_corners("0, 0", "1"),
               "Upper corner",
               {"found '1'", "allowed", "2"});
  EXPECT_THROW(try_corners("0, zero", "1, 1")(), dealii::ExceptionBase);
}

TEST(Shapes, Ball)
{
  const auto ball =
    create<2>("ball", {{"Centre", "0.3, 0.4"}, {"Radius", "0.5"}});
  EXPECT_TRUE(ball->contains({0.3, 0.4}));
  EXPECT_TRUE(ball->contains({0, 0}));
  EXPECT_TRUE(ball->contains({0.8, 0.4}));
  EXPECT_TRUE(ball->contains({0.8 + 1e-13, 0.4}));
  EXPECT_FALSE(ball->contains({0.8 + 1e-9, 0.4}));
  EXPECT_FALSE(ball->contains({0.7, 0.8}));
  expect_box<2>(ball->bounding_box, {-0.2, -0.1}, {0.8, 0.9});
}

TEST(Shapes, BallErrors)
{
  expect_error(
    []() {
      create<3>("ball", {{"Centre", "0, 0"}, {"Radius", "1"}});
    },
    "Centre",
    {"found '0, 0'", "allowed", "3"});
  expect_error(
    []() {
      create<3>("ball", {{"Centre", "0, 0, 0"}, {"Radius", "0"}});
    },
    "Radius",
    {"found '0'", "allowed", "> 0"});
  EXPECT_THROW(create<2>("ball", {{"Centre", "0, 0"}, {"Radius", "-1"}}),
               dealii::ExceptionBase);
}

TEST(Shapes, CylinderAlongAnAxis)
{
  const auto cylinder = create<3>("cylinder",
                                  {{"Axis from", "1, 1, 3"},
                                   {"Axis to", "1, 1, 0"},
                                   {"Radius", "0.5"}});
  EXPECT_TRUE(cylinder->contains({1, 1, 2}));
  EXPECT_TRUE(cylinder->contains({1.5, 1, 3}));
  EXPECT_TRUE(cylinder->contains({1.3, 1.4, 0}));
  EXPECT_FALSE(cylinder->contains({1.5 + 1e-9, 1, 1}));
  EXPECT_FALSE(cylinder->contains({1.4, 1.4, 1}));
  EXPECT_FALSE(cylinder->contains({1, 1, 3 + 1e-9}));
  EXPECT_FALSE(cylinder->contains({1, 1, -1e-9}));
  expect_box<3>(cylinder->bounding_box, {0.5, 0.5, 0}, {1.5, 1.5, 3});
}

TEST(Shapes, ObliqueCylinder)
{
  // Along (3, 4, 0), so that (-4, 3, 0)/5 and the z axis are across.
  const auto cylinder = create<3>("cylinder",
                                  {{"Axis from", "0, 0, 0"},
                                   {"Axis to", "3, 4, 0"},
                                   {"Radius", "1"}});
  EXPECT_TRUE(cylinder->contains({-0.8, 0.6, 0}));
  EXPECT_TRUE(cylinder->contains({3 + 0.8, 4 - 0.6, 0}));
  EXPECT_TRUE(cylinder->contains({1.5, 2, 1}));
  EXPECT_FALSE(cylinder->contains({-0.81, 0.61, 0}));
  EXPECT_FALSE(cylinder->contains({3.01, 4.01, 0}));
  EXPECT_FALSE(cylinder->contains({1.5, 2, 1.01}));
  expect_box<3>(cylinder->bounding_box, {-0.8, -0.6, -1}, {3.8, 4.6, 1});
}

TEST(Shapes, CylinderErrors)
{
  const auto try_axis = [](const std::string &from,
                           const std::string &to,
                           const std::string &radius) {
    return [=]() {
      create<3>("cylinder",
                {{"Axis from", from}, {"Axis to", to}, {"Radius", radius}});
    };
  };
  expect_error(try_axis("1, 2, 3", "1, 2, 3.0", "1"),
               "Axis to",
               {"found '1, 2, 3.0'", "allowed", "Axis from"});
  expect_error(try_axis("1, 2", "1, 2, 3", "1"), "Axis from", {"found '1, 2'"});
  expect_error(try_axis("1, 2, 3", "", "1"), "Axis to", {"found ''"});
  expect_error(try_axis("0, 0, 0", "0, 0, 1", "0"), "Radius", {"found '0'"});
}

TEST(Shapes, Union)
{
  const auto both = create<2>("union", {{"Of", "left, right"}}, two_boxes());
  EXPECT_TRUE(both->contains({0.5, 0.5}));
  EXPECT_TRUE(both->contains({1.5, 2.5}));
  EXPECT_TRUE(both->contains({1, 0.5}));
  EXPECT_FALSE(both->contains({0.5, 2.5}));
  expect_box<2>(both->bounding_box, {0, 0}, {2, 3});

  const auto one = create<2>("union", {{"Of", "left"}}, two_boxes());
  EXPECT_FALSE(one->contains({1.5, 0.5}));
  expect_box<2>(one->bounding_box, {0, 0}, {1, 1});
}

TEST(Shapes, UnionWithAFunctionHasNoBoundingBox)
{
  auto others    = two_boxes();
  others["half"] = create<2>("function", {{"Inside where negative", "y + 1"}});
  for (const std::string names : {"left, half, right", "half, left, right"})
    {
      const auto all = create<2>("union", {{"Of", names}}, others);
      EXPECT_FALSE(all->bounding_box.has_value()) << names;
      EXPECT_TRUE(all->contains({7, -2}));
      EXPECT_TRUE(all->contains({1.5, 2}));
      EXPECT_FALSE(all->contains({0.5, 2}));
    }
}

TEST(Shapes, Difference)
{
  auto others     = two_boxes();
  others["hole"]  = create<2>("ball", {{"Centre", "0, 0"}, {"Radius", "0.5"}});
  const auto rest = create<2>("difference", {{"Of", "left, hole"}}, others);
  EXPECT_TRUE(rest->contains({0.6, 0}));
  EXPECT_TRUE(rest->contains({1, 1}));
  EXPECT_FALSE(rest->contains({0.1, 0.1}));
  EXPECT_FALSE(rest->contains({0.5, 0}));
  EXPECT_FALSE(rest->contains({1.5, 1}));
  expect_box<2>(rest->bounding_box, {0, 0}, {1, 1});
}

TEST(Shapes, TouchingCutsLeaveNothingBetween)
{
  auto others = two_boxes();
  others["soil"] =
    create<2>("box", {{"Lower corner", "-1, -1"}, {"Upper corner", "4, 4"}});
  const auto rest =
    create<2>("difference", {{"Of", "soil, left, right"}}, others);
  EXPECT_FALSE(rest->contains({1, 0.5}));
  EXPECT_TRUE(rest->contains({0.5, 2}));
}

TEST(Shapes, Intersection)
{
  auto others    = two_boxes();
  others["disc"] = create<2>("ball", {{"Centre", "0, 0"}, {"Radius", "0.5"}});
  others["half"] = create<2>("function", {{"Inside where negative", "y - x"}});
  const auto wedge =
    create<2>("intersection", {{"Of", "left, disc, half"}}, others);
  EXPECT_TRUE(wedge->contains({0.3, 0.2}));
  EXPECT_FALSE(wedge->contains({0.2, 0.3}));
  EXPECT_FALSE(wedge->contains({0.6, 0.1}));
  EXPECT_FALSE(wedge->contains({0.3, -0.2}));
  expect_box<2>(wedge->bounding_box, {0, 0}, {0.5, 0.5});
  EXPECT_NEAR(wedge->proximity({0.3, 0}).distance, 0, 1e-12);
  EXPECT_NEAR(wedge->proximity({0.6, 0.1}).distance,
              std::hypot(0.6, 0.1) - 0.5,
              1e-12);
  others["far"] = create<2>("ball", {{"Centre", "9, 9"}, {"Radius", "0.5"}});
  expect_error(
    [&]() {
      create<2>("intersection", {{"Of", "disc, far"}}, others);
    },
    "Of",
    {"found 'disc, far'", "shapes that overlap"});
}

// A floor: what its lower end lies at must not blur its upper one.
TEST(Shapes, ABoxThatReachesFarIsSharpAtItsOtherEnd)
{
  const auto floor = create<2>("box",
                               {{"Lower corner", "-1e300, -1e300"},
                                {"Upper corner", "1e300, 1"}});
  const auto post =
    create<2>("box", {{"Lower corner", "0, -1"}, {"Upper corner", "1, 1e300"}});
  EXPECT_TRUE(post->contains({0.5, -1}));
  EXPECT_FALSE(post->contains({0.5, -1.001}));
  EXPECT_TRUE(post->contains({0.5, 1e200}));
  EXPECT_TRUE(floor->contains({0, 1}));
  EXPECT_FALSE(floor->contains({0, 1.001}));
}

TEST(Shapes, UnionAndDifferenceErrors)
{
  const auto try_names = [](const std::string    &kind,
                            const std::string    &names,
                            const NamedShapes<2> &others) {
    return [=]() { create<2>(kind, {{"Of", names}}, others); };
  };
  for (const std::string kind : {"union", "difference", "intersection"})
    {
      expect_error(
        try_names(kind, "left, lift", two_boxes()),
        "Of",
        {"found 'lift', allowed are the shapes named before it: left, right"});
      expect_error(try_names(kind, "", two_boxes()), "Of", {"found ''"});
      expect_error(try_names(kind, "left", {}),
                   "Of",
                   {"found 'left'", "named before it: none"});
    }
  expect_error(try_names("difference", "left", two_boxes()),
               "Of",
               {"found 'left'", "2 or more", "left, right"});
}

TEST(Shapes, Function)
{
  const auto plane = create<2>("function",
                               {{"Inside where negative", "y - slope*x"}},
                               {},
                               {{"slope", 0.5}});
  EXPECT_TRUE(plane->contains({2, 0.9}));
  EXPECT_TRUE(plane->contains({2, 1}));
  EXPECT_FALSE(plane->contains({2, 1.1}));
  EXPECT_FALSE(plane->bounding_box.has_value());

  const auto ball =
    create<3>("function",
              {{"Inside where negative", "sqrt(x^2 + y^2 + z^2) - 1"}});
  EXPECT_TRUE(ball->contains({0, 0.6, 0.6}));
  EXPECT_FALSE(ball->contains({0.6, 0.6, 0.6}));
}

TEST(Shapes, FunctionThatIsNoNumberIsOutside)
{
  const auto shape =
    create<2>("function", {{"Inside where negative", "sqrt(x) - 1"}});
  EXPECT_TRUE(shape->contains({0.5, 0}));
  EXPECT_FALSE(shape->contains({-0.5, 0}));
}

TEST(Shapes, FunctionErrors)
{
  const auto try_expression =
    [](const std::string                   &text,
       const std::map<std::string, double> &constants = {}) {
      return [=]() {
        create<2>("function", {{"Inside where negative", text}}, {}, constants);
      };
    };
  const std::string entry = "Inside where negative";

  testing::internal::CaptureStderr();
  expect_error(try_expression("x +* y"),
               entry,
               {"found 'x +* y'", "allowed", "Unexpected operator"});
  expect_error(try_expression("x + z"),
               entry,
               {"x,y", "Unexpected token \"z\""});
  expect_error(try_expression("slope*x"), entry, {"Unexpected token \"slope"});
  expect_error(try_expression("x; y"), entry, {"found 'x; y'"});
  expect_error(try_expression(""), entry, {"found ''"});
  expect_error(try_expression("x", {{"a b", 1.}}), entry, {"constant"});
  expect_error(try_expression("x", {{"x", 1.}}), entry, {"constant"});

  // The message is in the exception, so it shall not be printed as well; and
  // the screen works again.
  std::cerr << "screen";
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "screen");
}
