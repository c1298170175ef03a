#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace impm;

// What neither slivers of material nor stiffness, units, places, or the length
// of a step may change.
namespace
{
  double
  sum(const std::vector<double> &values)
  {
    return std::accumulate(values.begin(), values.end(), 0.);
  }

  std::string
  number(const double x)
  {
    std::ostringstream text;
    text.precision(17);
    text << x;
    return text.str();
  }

  std::string
  pair(const std::array<double, 2> &x)
  {
    return number(x[0]) + ", " + number(x[1]);
  }

  std::string
  constants(const double share, const double h)
  {
    return "General/Constants=share = " + number(share) + ", h = " + number(h) +
           ", E1 = 1e7, E2 = 1e7, density = 1000, gravity = 1";
  }

  // How far two blocks sink under their weight (prm/extreme/two_blocks.prm) is
  // exact but for the square of the cell size and up to twice the gap; linear
  // iterations are few, as without cuts.
  template <int dim>
  void
  expect_no_sign_of_cuts(const double h, const Overrides &overrides)
  {
    const double unit = 1e-4; // density g H^2 / E
    for (const double share : {0., 1e-1, 1e-2, 1e-4, 1e-8, 1e-11, 1e-14})
      {
        SCOPED_TRACE(share);
        const auto columns =
          run_file<dim>("extreme/two_blocks",
                        overrides + Overrides{constants(share, h)});
        const double allowed = h * (h + 2.1 * share) * unit;
        EXPECT_NEAR(columns.at("lower_sinking").back() + share * h,
                    5. / 24 * unit,
                    allowed);
        EXPECT_NEAR(columns.at("upper_sinking").back() + share * h,
                    11. / 24 * unit,
                    allowed);
        EXPECT_EQ(columns.at("newton_iterations").back(), 1);
        // Neither without the finest level nor more for a thinner sliver.
        EXPECT_GT(columns.at("linear_iterations").back(), 5);
        EXPECT_LE(columns.at("linear_iterations").back(), 16);
      }
  }

  /** The billet of prm/billet_dynamic.prm elsewhere, in other units. */
  struct Frame
  {
    double                length = 1, mass = 1, time = 1;
    unsigned int          turns = 0; ///< by 90 degrees
    std::array<double, 2> shift = {{0, 0}};

    std::array<double, 2>
    turned(std::array<double, 2> x) const
    {
      for (unsigned int i = 0; i < turns; ++i)
        x = {{-x[1], x[0]}};
      return x;
    }

    std::array<double, 2>
    place(const std::array<double, 2> &x) const
    {
      const auto y = turned(x);
      return {{length * (y[0] + shift[0]), length * (y[1] + shift[1])}};
    }

    Overrides
    box(const std::string           &name,
        const std::array<double, 2> &from,
        const std::array<double, 2> &to) const
    {
      const auto a = place(from), b = place(to);
      return {
        name + "/Lower corner=" +
          pair({{std::min(a[0], b[0]), std::min(a[1], b[1])}}),
        name + "/Upper corner=" +
          pair({{std::max(a[0], b[0]), std::max(a[1], b[1])}}),
      };
    }

    double
    stress() const
    {
      return mass / (length * time * time);
    }

    Columns
    press(const std::string &method,
          const std::string &preconditioner = "multigrid") const
    {
      const double      speed = 50 * length / time;
      const auto        down = turned({{0, -1}}), right = turned({{1, 0}});
      const bool        upright              = turns % 2 == 0;
      const std::string along                = upright ? "1" : "0",
                        across               = upright ? "0" : "1";
      const std::array<std::string, 4> faces = {
        {"right", "top", "left", "bottom"}};

      Overrides all = box("Geometry/billet", {{0, 0}}, {{10, 10}}) +
                      box("Geometry/plate", {{0, 10}}, {{20, 11}}) +
                      box("Grid", {{0, 0}}, {{20, 11}});
      for (unsigned int i = 0; i < 4; ++i)
        all.push_back("Boundary conditions/" + faces[(i + turns) % 4] +
                      "/Type=" + (i < 2 ? "free" : "slip"));
      return run_file(
        "billet_dynamic",
        all +
          Overrides{
            "Grid/Method=" + method,
            std::string("Grid/Cells=") + (upright ? "20, 11" : "11, 20"),
            "Materials/rubber/Density=" +
              number(10 * mass / std::pow(length, 3)),
            "Materials/rubber/Shear modulus=" + number(6e6 * stress()),
            "Materials/rubber/Bulk modulus=" + number(6e7 * stress()),
            "General/Constants=speed = " + number(speed),
            "Bodies/platen/Displacement=" + number(down[0]) + "*speed*t; " +
              number(down[1]) + "*speed*t",
            "Time/End time=" + number(0.1 * time),
            "Time/Time step=" + number(0.005 * time),
            "Solver/Linear solver=CG",
            "Solver/Preconditioner=" + preconditioner,
            "Solver/Linear tolerance=1e-8",
            "Output/compression/Component=" + along,
            "Output/corner_displacement/Position=" + pair(place({{10, 0}})),
            "Output/corner_displacement/Component=" + across,
            "Output/corner_displacement/Factor=" + number(right[0] + right[1]),
            "Output/platen_load/Direction=" + pair({{-down[0], -down[1]}}),
          });
    }
  };

  /** In units of the first frame; rounding is `tolerance`. */
  void
  expect_same(const Columns &one,
              const Columns &other,
              const Frame   &frame,
              const double   tolerance)
  {
    const auto compare = [&](const std::string &name, const double unit) {
      ASSERT_EQ(one.at(name).size(), other.at(name).size());
      const double largest =
        *std::max_element(one.at(name).begin(), one.at(name).end());
      for (unsigned int i = 0; i < one.at(name).size(); ++i)
        EXPECT_NEAR(other.at(name)[i] / unit,
                    one.at(name)[i],
                    tolerance * largest)
          << name;
    };
    compare("newton_iterations", 1);
    compare("step_cuts", 1);
    compare("corner_displacement", frame.length);
    compare("largest_stress", frame.stress());
    compare("platen_load", frame.stress() * frame.length);
    compare("kinetic_energy", frame.stress() * frame.length * frame.length);
    EXPECT_NEAR(sum(other.at("linear_iterations")),
                sum(one.at("linear_iterations")),
                2);
  }

  // What a shock leaves of a rod of log-strain law that hits a wall at a share
  // of the wave speed: (speed/c)^2 = (1 - lambda) (-ln lambda) / lambda.
  double
  stretch_behind_shock(const double speed)
  {
    double low = 1e-3, high = 1;
    while (high - low > 1e-12)
      {
        const double x = (low + high) / 2;
        ((1 - x) * -std::log(x) / x > speed * speed ? low : high) = x;
      }
    return low;
  }
} // namespace


TEST(ScalesMpi, SliversOfCellsDoNotMatter)
{
  for (const std::string method : {"GIMP", "MPM"})
    {
      SCOPED_TRACE(method);
      expect_no_sign_of_cuts<2>(0.025, {"Grid/Method=" + method});
    }
}


TEST(Scales, SliversOfCellsDoNotMatterOnAnAdaptedGrid)
{
  expect_no_sign_of_cuts<2>(0.0125,
                            {"Grid/Adaptation/Criteria=surface",
                             "Grid/Adaptation/Highest level=1",
                             "Grid/Adaptation/surface/Kind=free surface"});
}


TEST(ScalesNightly, SliversOfCellsDoNotMatterInSpace)
{
  expect_no_sign_of_cuts<3>(
    1. / 12,
    {"Geometry/Kind=3D",
     "Geometry/lower/Lower corner=0, 0, 0",
     "Geometry/lower/Upper corner=1, 0.5, 0.5",
     "Geometry/upper/Lower corner=0, 0.5, 0",
     "Geometry/upper/Upper corner=1, 1, 0.5",
     "Grid/Lower corner=0, 0, 0",
     "Grid/Upper corner=1.25, 1.25, 0.75",
     "Grid/Cells=15, 15, 9",
     "Boundary conditions/back/Type=normal displacement",
     "Boundary conditions/back/Value=share*h*min(t, 1)",
     "Loads/Body force=0; -if(t > 1.5, gravity, 0); 0"});
}


// Two blocks on each other, one of them up to 1e8 times as stiff.
TEST(ScalesMpi, StiffnessMayDifferByAnyFactor)
{
  const double h = 0.025, soft = 1e7, weight = 1000;
  for (const std::string preconditioner : {"AMG", "multigrid"})
    for (const std::string stiff : {"lower", "upper"})
      for (const double ratio : {1., 1e2, 1e4, 1e6, 1e8})
        {
          SCOPED_TRACE(preconditioner + ", " + stiff + " " + number(ratio));
          const auto columns =
            run_file("extreme/two_blocks",
                     {"Solver/Preconditioner=" + preconditioner,
                      "Materials/" + stiff +
                        "/Young's modulus=" + number(ratio * soft)});
          const double lower   = stiff == "lower" ? ratio * soft : soft,
                       upper   = stiff == "upper" ? ratio * soft : soft;
          const double allowed = h * h; // of a height of 1/2, over 4
          EXPECT_NEAR(columns.at("lower_sinking").back() * lower / weight,
                      5. / 24,
                      5. / 24 * 2 * allowed);
          const double sinking = weight * (3. / 8 / lower + 1. / 12 / upper);
          EXPECT_NEAR(columns.at("upper_sinking").back() / sinking,
                      1.,
                      2 * allowed);
          EXPECT_EQ(columns.at("newton_iterations").back(), 1);
          EXPECT_GT(columns.at("linear_iterations").back(), 5);
          EXPECT_LE(columns.at("linear_iterations").back(), 15);
        }
}


TEST(ScalesNightly, UnitsDoNotMatter)
{
  const auto reference = Frame{}.press("GIMP");
  const auto with_amg  = Frame{}.press("GIMP", "AMG");
  EXPECT_EQ(reference.at("time").size(), 20u);
  for (const double power : {-1., -0.5, -0.05, 0.05, 1.})
    for (const unsigned int unit : {0, 1, 2})
      {
        // So that stress and density stay within 1e-120 and 1e120.
        Frame frame;
        if (unit == 0)
          frame.length = std::pow(10., 40 * power);
        else if (unit == 1)
          frame.mass = std::pow(10., 120 * power);
        else
          frame.time = std::pow(10., 60 * power);
        SCOPED_TRACE(number(frame.length) + " m, " + number(frame.mass) +
                     " kg, " + number(frame.time) + " s");
        expect_same(reference, frame.press("GIMP"), frame, 1e-9);
        expect_same(with_amg, frame.press("GIMP", "AMG"), frame, 1e-9);
      }
}


// A shift takes away digits of coordinates.
TEST(ScalesMpi, PlaceAndDirectionDoNotMatter)
{
  const auto reference = Frame{}.press("GIMP");
  const auto with_amg  = Frame{}.press("GIMP", "AMG");
  for (const unsigned int turns : {1, 2, 3})
    for (const double shift : {0., 1e3, 1e6})
      {
        SCOPED_TRACE(std::to_string(turns) + " turns, " + number(shift));
        Frame frame;
        frame.turns           = turns;
        frame.shift           = {{shift, -3 * shift}};
        const double rounding = 1e-9 + 1e-13 * shift;
        expect_same(reference, frame.press("GIMP"), frame, rounding);
        expect_same(with_amg, frame.press("GIMP", "AMG"), frame, rounding);
      }
}


// A cantilever under ten times P L^2 / EI at once, whose end turns by 80
// degrees, is where many steps take it; elastica: prm/cantilever.prm.
TEST(Scales, AllLoadInOneStep)
{
  const auto bend = [](const std::string &step) {
    return run_file("cantilever",
                    {"Grid/Method=Lagrangian",
                     "Grid/Cells=88, 88",
                     "Time/Growth=1",
                     "Time/Largest time step=10",
                     "Time/Time step=" + step});
  };
  const auto one = bend("10"), many = bend("0.5");
  EXPECT_EQ(one.at("time").size(), 1u);
  EXPECT_EQ(many.at("time").size(), 20u);
  EXPECT_LE(one.at("newton_iterations").back(), 30);
  for (const auto &[name, exact] :
       {std::make_pair("down", 0.81061), std::make_pair("back", 0.55500)})
    {
      EXPECT_NEAR(one.at(name).back(), many.at(name).back(), 1e-6);
      EXPECT_NEAR(one.at(name).back(), exact, 0.01);
    }
}


// Plastic, by points that may not leave their cells in a step: wide cells.
TEST(Scales, UpsettingInOneStep)
{
  for (const std::string method : {"GIMP", "MPM"})
    {
      const auto columns = run_file("upsetting_frictionless",
                                    {"Grid/Method=" + method,
                                     "Grid/Cells=2, 8",
                                     "Time/Time step=0.009"});
      EXPECT_EQ(columns.at("time").size(), 1u);
      EXPECT_LE(columns.at("newton_iterations").back(), 10);
      EXPECT_NEAR(columns.at("platen_load").back() / 764.5e3, 1., 1e-4);
      EXPECT_NEAR(columns.at("largest_radius").back() / 15.796e-3, 1., 1e-4);
    }
}


// At half the wave speed and more a rod meets a wall with a shock, which takes
// energy; see prm/extreme/studies/fast_rod.prm.
TEST(Scales, ARodHitsAWallNearlyAsFastAsWaves)
{
  const double length = 1, c = 5000, h = 0.02;
  for (const std::string method : {"GIMP", "MPM"})
    for (const double share : {0.5, 0.9})
      {
        SCOPED_TRACE(method + " " + number(share));
        const double speed = share * c, lambda = stretch_behind_shock(share),
                     at_rest = length * (1 - lambda) / speed,
                     energy  = std::pow(std::log(lambda) / share, 2);
        const auto columns =
          run_file("rod_impact",
                   {"Grid/Method=" + method,
                    "Grid/Upper corner=2.2, 0.02",
                    "Grid/Cells=110, 1",
                    "General/Constants=speed = " + number(speed) +
                      ", length = 1, density = 8000, c = 5000, h = 0.02",
                    "Time/End time=" + number(3.5 * at_rest)});
        const auto &v    = columns.at("mean_velocity");
        const auto turns = std::find_if(v.begin(), v.end(), [](const double x) {
          return x > 0;
        });
        ASSERT_NE(turns, v.end());
        // It feels the wall up to a cell late, and that softly.
        const auto  &t = columns.at("time");
        const size_t i = turns - v.begin();
        const double stops =
          t[i] - (t[i] - t[i - 1]) * v[i] / (v[i] - v[i - 1]);
        EXPECT_GT((stops - at_rest) * speed / h, 0);
        EXPECT_LT((stops - at_rest) * speed / h, 1.25);
        const double most = std::sqrt(energy);
        EXPECT_LT(v.back() / speed, most);
        EXPECT_GT(v.back() / speed, 0.75 * most);
        const auto &total = columns.at("total_energy");
        EXPECT_LE(*std::max_element(total.begin(), total.end()),
                  (1 + 1e-6) * total.front());
      }
}
