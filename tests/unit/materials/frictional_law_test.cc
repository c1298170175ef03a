#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "law_scene.h"
#include "material_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const Tensor<2, 3> one = unit_symmetric_tensor<3>();

  const std::vector<std::string> both = {"log-strain Drucker-Prager",
                                         "log-strain Mohr-Coulomb"};

  const double K = unit_elasticity.bulk, G = unit_elasticity.shear;

  double
  field(const LawPoint &point, const std::string &name)
  {
    return point.history[point.layout.offset(name)];
  }

  void
  step(LawPoint &point, const Tensor<2, 3> &increment)
  {
    ASSERT_TRUE(point.evaluate(increment));
    point.commit();
  }

  // tau in the frame where nothing turns
  const SymmetricTensor<2, 3> &
  tau(const LawPoint &point)
  {
    return point.response.kirchhoff_stress;
  }

  Tensor<2, 3>
  stretched(const double x, const double y, const double z)
  {
    return diagonal(std::exp(x), std::exp(y), std::exp(z));
  }
} // namespace


TEST(FrictionalLaw, EntriesThatContradict)
{
  for (const auto &law : both)
    {
      const std::vector<std::pair<Entries, std::string>> bad = {
        {{{"Friction angle", "0"}}, "Cohesion"},
        {{{"Dilation angle", "31"}}, "Dilation angle"},
        {{{"Tension cut-off", "1"}}, "Tension cut-off"},
        {{{"Cohesion", "1"}, {"Tension cut-off", "1.74"}}, "Tension cut-off"}};
      for (const auto &[entries, blamed] : bad)
        try
          {
            listed_law(law, entries);
            ADD_FAILURE() << blamed;
          }
        catch (const InputError &error)
          {
            EXPECT_EQ(error.entry, blamed);
          }
      listed_law(law, {{"Cohesion", "1"}, {"Tension cut-off", "1.73"}});
      listed_law(law,
                 {{"Cohesion", "1"},
                  {"Friction angle", "0"},
                  {"Tension cut-off", "7"}});
      const auto sand = listed_law(law, {});
      EXPECT_FALSE(sand.law->has_symmetric_tangent());
      EXPECT_FALSE(sand.law->has_potential());
      const auto associated = listed_law(law, {{"Dilation angle", "30"}});
      EXPECT_TRUE(associated.law->has_symmetric_tangent());
      EXPECT_TRUE(associated.law->has_potential());
    }
}


// Pressed along one axis, held across: without dilation the volume is
// elastic, which with the ratio of the stresses gives them in closed form.
TEST(FrictionalLaw, OedometerInClosedForm)
{
  for (const auto &law : both)
    for (const double phi : {10., 30., 50.})
      {
        const auto named =
          listed_law(law, {{"Friction angle", std::to_string(phi)}});
        const double sine = std::sin(phi * numbers::PI / 180);
        const double N    = (1 + sine) / (1 - sine);
        LawPoint     point(named);
        for (unsigned int n = 1; n <= 5; ++n)
          {
            step(point, stretched(0., -0.1, 0.));
            const double axial = tau(point)[1][1], across = tau(point)[0][0];
            const double e      = -0.1 * n;
            const bool   yields = N < 1 / 0.3 - 1; // (1 - nu) / nu
            EXPECT_NEAR(axial,
                        yields ? 3 * K * e * N / (N + 2) :
                                 (K + 4. / 3. * G) * e,
                        1e-14);
            EXPECT_NEAR(across,
                        yields ? axial / N : (K - 2. / 3. * G) * e,
                        1e-14);
            EXPECT_NEAR(tau(point)[2][2], across, 1e-15);
          }
      }
}


// Triaxial tests at a lateral stress that is held: at failure
// N = (1 + sin phi) / (1 - sin phi), and the volume grows by the dilation.
TEST(FrictionalLaw, TriaxialFailure)
{
  const double pressure = 0.02, c = 0.005;
  for (const auto &law : both)
    for (const double sign : {-1., 1.}) // compression, extension
      {
        SCOPED_TRACE(law + (sign < 0 ? ", compression" : ", extension"));
        Entries entries = {{"Cohesion", std::to_string(c)},
                           {"Dilation angle", "12"}};
        if (law == both[0])
          entries["Match"] = sign < 0 ? "outer" : "inner";
        const auto named = listed_law(law, entries);
        LawPoint   point(named);
        step(point,
             stretched(-pressure / (3 * K),
                       -pressure / (3 * K),
                       -pressure / (3 * K)));
        double across = 0;
        for (unsigned int n = 0; n < 10; ++n)
          {
            // the lateral strain by Newton's method
            across = 0;
            for (unsigned int i = 0; i < 50; ++i)
              {
                ASSERT_TRUE(
                  point.evaluate(stretched(across, sign * 0.02, across)));
                const auto  &c4 = point.response.tangent;
                const double slope =
                  c4[0][0][0][0] + c4[0][0][2][2] + 2 * tau(point)[0][0];
                across -= (tau(point)[0][0] + pressure) / slope;
              }
            point.commit();
          }
        EXPECT_NEAR(tau(point)[0][0], -pressure, 1e-14);
        const double axial = -tau(point)[1][1]; // N = 3
        EXPECT_NEAR(axial,
                    sign < 0 ? 3 * pressure + 2 * c * std::sqrt(3) :
                               (pressure - 2 * c * std::sqrt(3)) / 3,
                    1e-14);
        // d eps_1 + (the two others) : 1 to 1 + sin psi over 1 - sin psi
        const double sine = std::sin(12 * numbers::PI / 180);
        const double N    = (1 + sine) / (1 - sine);
        EXPECT_NEAR(2 * across, sign < 0 ? 0.02 * N : -0.02 / N, 1e-14);
      }
}


// A bar and a block that are torn: planes of tension, the mean stress.
TEST(FrictionalLaw, TensionIsCutOff)
{
  const double  T       = 0.004;
  const Entries entries = {{"Cohesion", "0.01"}, {"Tension cut-off", "0.004"}};
  {
    const auto named = listed_law(both[1], entries);
    LawPoint   point(named);
    step(point, stretched(0., 0.1, 0.));
    const double e = T / (K + 4. / 3. * G); // what is elastic of it
    EXPECT_NEAR(tau(point)[1][1], T, 1e-16);
    EXPECT_NEAR(tau(point)[0][0], (K - 2. / 3. * G) * e, 1e-16);
    EXPECT_NEAR(field(point, "plastic_work"), T * (0.1 - e), 1e-16);
    EXPECT_EQ(field(point, "opening"), 0.);
  }
  for (const auto &law : both)
    {
      const auto named = listed_law(law, entries);
      LawPoint   point(named);
      step(point, stretched(0.2, 0.2, 0.2));
      EXPECT_LT((tau(point) - T * unit_symmetric_tensor<3>()).norm(), 1e-15);
      EXPECT_LT(field(point, "equivalent_plastic_strain"), 1e-15);
      // it has flowed: the way back is elastic from there
      step(point, stretched(-0.001, -0.001, -0.001));
      EXPECT_NEAR(tau(point)[0][0], T - 3 * K * 0.001, 1e-15);
    }
}


// Grains that come apart bear nothing until their volume is what it was, in
// whatever steps, and then what they would have borne without the gap.
TEST(FrictionalLaw, GrainsMeetAgainWhereTheyParted)
{
  std::mt19937 generator(1);
  for (const auto &law : both)
    for (const std::string dilation : {"0", "30"})
      {
        const auto named = listed_law(law, {{"Dilation angle", dilation}});
        LawPoint   point(named), never_parted(named);
        step(point, stretched(-0.01, -0.01, -0.01));
        step(never_parted, stretched(-0.01, -0.01, -0.01));
        for (unsigned int n = 0; n < 20; ++n)
          {
            step(point, stretched(0.11, 0.1, 0.09));
            EXPECT_EQ(tau(point).norm(), 0.);
            EXPECT_EQ(named.law->energy(point.F, point.history.data()).stored,
                      0.);
          }
        EXPECT_NEAR(field(point, "opening"), 6. - 0.03, 1e-13);
        // they may even tumble
        step(point, rotation_z(1.));
        EXPECT_NEAR(field(point, "opening"), 6. - 0.03, 1e-13);
        for (unsigned int n = 0; n < 9; ++n)
          {
            step(point, stretched(-0.22, -0.22, -0.22));
            EXPECT_EQ(tau(point).norm(), 0.);
          }
        EXPECT_NEAR(field(point, "opening"), 6. - 0.03 - 5.94, 1e-13);
        step(point, stretched(-0.02, -0.02, -0.02));
        EXPECT_LT((tau(point) - tau(never_parted)).norm(), 1e-13);
        EXPECT_EQ(field(point, "opening"), 0.);
        EXPECT_EQ(field(point, "plastic_work"), 0.);
        // nothing is left of it
        const auto more = stretched(-0.01, -0.03, -0.01);
        step(point, more);
        step(never_parted, more);
        EXPECT_LT((tau(point) - tau(never_parted)).norm(), 1e-13);
      }
}


// Linear in the equivalent plastic strain at the start of a step, until there
// is none.
TEST(FrictionalLaw, CohesionSoftens)
{
  for (const auto &law : both)
    {
      const auto named = listed_law(law,
                                    {{"Cohesion", "0.01"},
                                     {"Friction angle", "0"},
                                     {"Cohesion hardening", "-0.04"}});
      LawPoint   point(named);
      double     c = 0.01, before = 0;
      for (unsigned int n = 0; n < 12; ++n)
        {
          step(point, stretched(0.02, -0.02, 0.));
          const auto  &t      = tau(point);
          const double radius = (t[0][0] - t[1][1]) / 2;
          // in shear the outer cone is 2 / sqrt(3) as strong
          const double strength = law == both[0] ? 2 / std::sqrt(3) : 1.;
          EXPECT_NEAR(radius, strength * c, 1e-15);
          const double alpha = field(point, "equivalent_plastic_strain");
          // all of the strain but for what is elastic
          EXPECT_NEAR(alpha,
                      2 / std::sqrt(3) * (0.02 * (n + 1) - radius / (2 * G)),
                      1e-14);
          EXPECT_GT(alpha, before);
          before = alpha;
          c      = std::max(0., 0.01 - 0.04 * alpha);
          // a state is what it is while no time passes
          point.dt = 0;
          ASSERT_TRUE(point.evaluate(one));
          EXPECT_NEAR(tau(point)[0][0], t[0][0], 1e-16);
          EXPECT_EQ(point.trial_history, point.history);
          point.dt = 0.5;
        }
      EXPECT_EQ(c, 0.);
    }
}


TEST(FrictionalLaw, StressTurnsWithTheMaterial)
{
  std::mt19937 generator(2);
  for (const auto &named : all_soils())
    {
      SCOPED_TRACE(named.name);
      for (const auto &q : {in_plane, in_space, some_other})
        {
          LawPoint here(named), there(named);
          for (unsigned int n = 0; n < 6; ++n)
            {
              const auto increment = random_gradient(generator, false, 0.15);
              step(here, increment);
              // each step in a frame that has turned once more
              step(there,
                   n == 0 ? q * increment : q * increment * transpose(q));
              EXPECT_LT((tau(there) - turned(tau(here), q)).norm(), 1e-14);
              EXPECT_NEAR(field(there, "plastic_work"),
                          field(here, "plastic_work"),
                          1e-14);
            }
        }
    }
}


// Steps of half of the length, there and back: always a stress within the
// limit, and work that is never negative.
TEST(FrictionalLaw, LargeSteps)
{
  std::mt19937 generator(3);
  for (const std::string poisson : {"0", "0.3", "0.4999"})
    for (const std::string phi : {"0.001", "30", "80"})
      for (const std::string c : {"0", "0.01"})
        for (const auto &law : both)
          {
            const auto named = listed_law(law,
                                          {{"Poisson's ratio", poisson},
                                           {"Friction angle", phi},
                                           {"Cohesion", c}});
            LawPoint   point(named);
            for (unsigned int n = 0; n < 100; ++n)
              {
                const double work      = field(point, "plastic_work");
                auto         increment = random_gradient(generator, n % 2, 0.5);
                if (determinant(increment) <= 0)
                  continue;
                step(point, increment);
                EXPECT_GE(field(point, "plastic_work"), work - 1e-14);
                EXPECT_GE(field(point, "opening"), 0.);
                EXPECT_TRUE(std::isfinite(point.response.tangent.norm()));
              }
          }
}


// F_n = 1: the tangent in turned frames, on edges and in corners, too, from
// both sides of where strains meet.
TEST(FrictionalLaw, TangentsWhereStrainsMeet)
{
  for (const auto &named : all_soils())
    for (const double apart : {0., 1e-15, 1e-12, 1e-9, 1e-6})
      for (const auto &strain : {std::array<double, 3>{{-0.4, -0.1, -0.1}},
                                 std::array<double, 3>{{-0.4, -0.4, -0.1}},
                                 std::array<double, 3>{{0.3, 0.3, 0.2}}})
        {
          SCOPED_TRACE(named.name + ", " + std::to_string(strain[0]));
          LawPoint   point(named);
          const auto F = in_space *
                         stretched(strain[0], strain[1] + apart, strain[2]) *
                         transpose(some_other);
          const auto respond = [&](const Tensor<2, 3> &increment) {
            EXPECT_TRUE(point.evaluate(increment));
            return point.response;
          };
          EXPECT_LT(tangent_error(respond, F, 1e-4), 1e-9) << apart;
        }
}


// Sand that flies apart has inertia only, beside faces that hold it: no stress
// and a gap that is all of the change of volume.
TEST(FrictionalLawMpi, SandFliesApart)
{
  Model<2>     model(law_scene("plane strain",
                           {"Law = log-strain Mohr-Coulomb",
                                "Density = 1",
                                "Young's modulus = 1"}),
                 {"Stabilization/Ghost penalty=0",
                      "Geometry/box/Upper corner=0.75, 0.75",
                      "Boundary conditions/left/Type=slip",
                      "Boundary conditions/bottom/Type=slip",
                      "Bodies/block/Velocity=x; 2*y",
                      "Time/Integrator=theta",
                      "Time/Time step=0.05"});
  impm::Vector u;
  const auto   result = model.solve(u);
  ASSERT_TRUE(result.converged) << result.failure;
  model.commit(u);
  const auto offset =
    model.points.offset_history + model.points.history_layout.offset("opening");
  for (unsigned int p = 0; p < model.points.size(); ++p)
    {
      const double volume = determinant(model.points.layout.load_tensor(
        model.points.fields(p) + model.points.offset_deformation));
      EXPECT_GT(volume, 1.05);
      EXPECT_NEAR(model.points.fields(p)[offset], std::log(volume), 1e-13);
    }
}
