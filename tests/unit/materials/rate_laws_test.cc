#include <impm/balance/kinematics.h>
#include <impm/materials/hardening/bilinear.h>
#include <impm/materials/hardening/curve_hardening.h>
#include <impm/materials/linear_law.h>

#include <gtest/gtest.h>

#include <random>

#include "law_fixture.h"
#include "material_fixture.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const Tensor<2, 3> one = diagonal(1., 1., 1.);

  // P of a point as the forces see it, its tangent, and the potential.
  struct Carried
  {
    std::array<double, 9>  stress;
    std::array<double, 81> tangent;
    double                 potential;
  };

  Carried
  carry_back(LawPoint &point, const Tensor<2, 3> &increment)
  {
    const Kinematics<3>     kinematics(false);
    Kinematics<3>::Matrix<> spatial, result;
    Kinematics<3>::List<>   stress;
    EXPECT_TRUE(point.evaluate(increment));
    const auto form = point.law.form();
    const auto inverse =
      form == Material::Form::linearized ? one : invert(increment);
    kinematics.carry_back(kinematics.list(point.response.kirchhoff_stress),
                          inverse,
                          1.,
                          stress.data());
    kinematics.spatial_tangent(point.response, form, spatial.data());
    kinematics.carry_back_tangent(spatial.data(), inverse, 1., result.data());
    Carried carried;
    std::copy_n(stress.begin(), 9, carried.stress.begin());
    // rows of a 3D matrix are 9 wide
    std::copy_n(result.begin(), 81, carried.tangent.begin());
    carried.potential = point.response.potential;
    return carried;
  }

  struct Errors
  {
    double tangent = 0, stress = 0, asymmetry = 0;
  };

  Errors
  errors(LawPoint &point, const Tensor<2, 3> &increment)
  {
    const auto here = carry_back(point, increment);
    Errors     largest;
    for (unsigned int b = 0; b < 9; ++b)
      {
        const auto at = [&](const double h) {
          auto moved = increment;
          moved[b / 3][b % 3] += h;
          return carry_back(point, moved);
        };
        for (unsigned int a = 0; a < 9; ++a)
          {
            const double difference =
              derivative([&](const double h) { return at(h).stress[a]; }, 1e-4);
            largest.tangent =
              std::max(largest.tangent,
                       std::abs(difference - here.tangent[9 * a + b]));
            largest.asymmetry = std::max(largest.asymmetry,
                                         std::abs(here.tangent[9 * a + b] -
                                                  here.tangent[9 * b + a]));
          }
        largest.stress =
          std::max(largest.stress,
                   std::abs(
                     here.stress[b] -
                     derivative([&](const double h) { return at(h).potential; },
                                1e-3)));
      }
    return largest;
  }

  // Stress of its own in some direction, and plastic strain.
  void
  give_a_past(LawPoint &point, std::mt19937 &generator)
  {
    for (unsigned int n = 0; n < 2; ++n)
      {
        ASSERT_TRUE(point.evaluate(random_gradient(generator, false, 0.05)));
        point.commit();
      }
  }
} // namespace


TEST(AllLaws, TangentsAreDerivatives)
{
  std::mt19937 generator(1);
  for (const auto &named : all_laws())
    {
      SCOPED_TRACE(named.name);
      for (unsigned int n = 0; n < 8; ++n)
        {
          LawPoint point(named);
          if (n > 0)
            give_a_past(point, generator);
          // large, small, and none at all where nothing yields there
          const double size      = n < 5 ? 0.15 : n < 7 ? 2e-3 : 0.;
          const auto   increment = random_gradient(generator, false, size);
          if (n >= 5 && point.plastic_strain() > 0)
            continue; // on the yield limit, where there is a kink
          const auto error = errors(point, increment);
          EXPECT_LT(error.tangent, 2e-10) << n;
          if (named.law->has_potential())
            {
              EXPECT_LT(error.stress, 1e-10) << n;
            }
          if (named.law->has_symmetric_tangent())
            {
              EXPECT_LT(error.asymmetry, 1e-14) << n;
            }
        }
    }
}


// Yielding from the yield limit, by a strain that leads outwards.
TEST(AllLaws, TangentsOfSmallPlasticSteps)
{
  std::mt19937 generator(2);
  for (const auto &named : all_laws())
    {
      SCOPED_TRACE(named.name);
      LawPoint   point(named);
      const auto increment = random_gradient(generator, false, 0.05);
      ASSERT_TRUE(point.evaluate(increment));
      point.commit();
      // differences of 3e-4 must not leave it
      const auto error = errors(point, one + 0.05 * (increment - one));
      EXPECT_LT(error.tangent, 1e-9);
    }
}


// Each with a past of its own, one without any, one that goes back; where one
// has no stress, none has.
TEST(AllLaws, LanesAreTheirPointsOneByOne)
{
  std::mt19937 generator(5);
  for (const auto &named : all_laws())
    {
      SCOPED_TRACE(named.name);
      std::vector<LawPoint>               points(n_lanes, LawPoint(named));
      Tensor<2, 3, Lanes>                 increment, total;
      std::array<const double *, n_lanes> histories;
      std::array<double *, n_lanes>       trials;
      Material::Responses                 responses;
      std::vector<std::vector<double>>    ends(
        n_lanes, std::vector<double>(named.history.size()));
      for (unsigned int i = 0; i < n_lanes; ++i)
        {
          if (i != 1)
            give_a_past(points[i], generator);
          const double size = i == 2 ? 1e-4 : 0.1;
          const auto   step = random_gradient(generator, false, size);
          ASSERT_TRUE(points[i].evaluate(step));
          for (unsigned int a = 0; a < 3; ++a)
            for (unsigned int b = 0; b < 3; ++b)
              {
                increment[a][b][i] = step[a][b];
                total[a][b][i]     = points[i].trial_F[a][b];
              }
          histories[i] = points[i].history.data();
          trials[i]    = ends[i].data();
        }
      const auto evaluate = [&]() {
        return named.law->evaluate(
          {increment, total, points[0].dt, histories, trials}, true, responses);
      };
      ASSERT_TRUE(evaluate());
      const bool is_full = named.law->form() == Material::Form::full;
      for (unsigned int i = 0; i < n_lanes; ++i)
        {
          // by units in the last place, of stiffness 1
          const double round_off  = 1e-14;
          const auto  &one_by_one = points[i].response;
          EXPECT_NEAR(responses.potential[i], one_by_one.potential, round_off);
          for (unsigned int a = 0; a < 6; ++a)
            {
              EXPECT_NEAR(responses.kirchhoff_stress.access_raw_entry(a)[i],
                          one_by_one.kirchhoff_stress.access_raw_entry(a),
                          round_off);
              for (unsigned int b = 0; !is_full && b < 6; ++b)
                EXPECT_NEAR(responses.tangent.access_raw_entry(6 * a + b)[i],
                            one_by_one.tangent.access_raw_entry(6 * a + b),
                            10 * round_off);
            }
          for (unsigned int a = 0; is_full && a < 81; ++a)
            {
              const unsigned int j = a / 27, k = a / 9 % 3, l = a / 3 % 3;
              EXPECT_NEAR(responses.full_tangent[j][k][l][a % 3][i],
                          one_by_one.full_tangent[j][k][l][a % 3],
                          10 * round_off);
            }
          for (unsigned int a = 0; a < ends[i].size(); ++a)
            EXPECT_NEAR(ends[i][a], points[i].trial_history[a], round_off);
        }
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          total[a][b][n_lanes - 1] *= -1;
      EXPECT_FALSE(evaluate());
    }
}


TEST(AllLaws, WithoutAnIncrementTheStressIsTheOldOne)
{
  std::mt19937 generator(3);
  for (const auto &named : all_laws())
    {
      SCOPED_TRACE(named.name);
      LawPoint point(named);
      give_a_past(point, generator);
      const auto before = point.cauchy_stress();
      EXPECT_GT(before.norm(), 1e-3);
      const auto energy = named.law->energy(point.F, point.history.data());
      EXPECT_GT(energy.stored, 0.);
      EXPECT_EQ(energy.dissipated > 0,
                point.plastic_strain() > 0 ||
                  named.history.find("viscous_work"));
      point.dt = 0;
      ASSERT_TRUE(point.evaluate(one));
      EXPECT_LT((point.cauchy_stress() - before).norm(), 1e-15);
      const auto same = named.law->energy(point.F, point.trial_history.data());
      EXPECT_NEAR(same.stored, energy.stored, 1e-15);
      EXPECT_NEAR(same.dissipated, energy.dissipated, 1e-15);
    }
}


TEST(AllLaws, ShapeCountsWhereTheySaySo)
{
  const auto shear   = one + Tensor<2, 3>({{0, 0.4, 0}, {0, 0, 0}, {0, 0, 0}});
  const auto stretch = 1.02 * one;
  for (const auto &named : all_laws())
    {
      SCOPED_TRACE(named.name);
      LawPoint first(named), second(named);
      first.F  = stretch;
      second.F = stretch * shear;
      ASSERT_TRUE(first.evaluate(one + 0.01 * shear));
      ASSERT_TRUE(second.evaluate(one + 0.01 * shear));
      const double difference =
        (first.response.kirchhoff_stress - second.response.kirchhoff_stress)
          .norm();
      const double energy =
        std::abs(first.law.energy(first.trial_F, first.history.data()).stored -
                 first.law.energy(second.trial_F, first.history.data()).stored);
      if (named.law->depends_on_shape())
        {
          EXPECT_GT(difference, 1e-3);
          EXPECT_GT(energy, 1e-3);
        }
      else
        {
          EXPECT_LT(difference, 1e-14);
          EXPECT_LT(energy, 1e-14);
        }
    }
}


TEST(AllLaws, RefuseWhatHasNoStress)
{
  for (const auto &named : all_laws())
    {
      LawPoint point(named);
      EXPECT_FALSE(point.evaluate(diagonal(-1., 1., 1.))) << named.name;
      EXPECT_FALSE(point.evaluate(diagonal(0., 1., 1.))) << named.name;
      EXPECT_FALSE(point.evaluate(diagonal(1., std::nan(""), 1.)))
        << named.name;
      EXPECT_FALSE(point.evaluate(rotation_z(numbers::PI) * 1e200))
        << named.name;
    }
}


TEST(JaumannLaw, StressTurnsWithTheMaterial)
{
  for (const auto &named : all_laws())
    if (named.law->form() == Material::Form::full)
      for (const auto &q : {in_plane, in_space, some_other})
        {
          std::mt19937 generator(4);
          LawPoint     point(named);
          give_a_past(point, generator);
          if (point.law.remaining_stiffness(point.history.data()) <
              point.law.stiffness())
            continue; // what fails loses its stress in the next step
          const auto before = point.cauchy_stress();
          if (named.law->is_solid())
            point.dt = 0; // or a stress that depends on the rate relaxes
          ASSERT_TRUE(point.evaluate(q));
          const auto expected =
            named.law->is_solid() ?
              turned(before, q) :
              1 * (1 - 1 / determinant(point.F)) * unit_symmetric_tensor<3>();
          EXPECT_LT((point.cauchy_stress() - expected).norm(), 1e-15)
            << named.name;
        }
}


// d sigma_12 / d gamma = G - sigma_11, d sigma_11 / d gamma = sigma_12.
TEST(JaumannLaw, SimpleShear)
{
  const auto            law = listed_law("Jaumann elastic", {});
  const double          G = unit_elasticity.shear, gamma = 4.;
  std::array<double, 2> error;
  for (const unsigned int refinement : {0, 1})
    {
      const unsigned int n = 40u << refinement;
      LawPoint           point(law);
      auto               increment = one;
      increment[0][1]              = gamma / n;
      for (unsigned int i = 0; i < n; ++i)
        {
          ASSERT_TRUE(point.evaluate(increment));
          point.commit();
        }
      const auto sigma  = point.cauchy_stress();
      error[refinement] = std::hypot(sigma[0][1] - G * std::sin(gamma),
                                     sigma[0][0] - G * (1 - std::cos(gamma)));
      EXPECT_NEAR(sigma[0][0] + sigma[1][1], 0., 1e-14);
    }
  EXPECT_LT(error[1], 1e-3 * G);
  EXPECT_NEAR(error[0] / error[1], 4., 0.05);
}


// At the axial strain e = s / E + alpha the stress is s = H(alpha), and the
// sides contract by nu s / E + alpha / 2.
TEST(LinearLaw, UniaxialTensionByHand)
{
  const double            sigma_y = 0.02, c_1 = 0.1, limit = 0.05, c_2 = 0.15;
  const BilinearHardening hardening({sigma_y, c_1}, limit, c_2);
  const auto law = make_law<LinearLaw<CurveHardening<BilinearHardening>>>(
    "", GeometryKind::three_d, unit_elasticity, hardening);
  // alpha, H(alpha)
  const double highest = sigma_y + c_1 * limit;
  for (const auto &[alpha, stress] : {std::pair<double, double>(0., 0.015),
                                      {0.03, sigma_y + c_1 * 0.03},
                                      {0.09, highest - c_2 * 0.04},
                                      {0.4, 0.}})
    for (const unsigned int n : {1u, 7u})
      {
        LawPoint     point(law);
        const double axial = stress + alpha, side = -0.3 * stress - alpha / 2;
        for (unsigned int i = 0; i < n; ++i)
          {
            ASSERT_TRUE(point.evaluate(
              diagonal(1 + axial / n, 1 + side / n, 1 + side / n)));
            point.commit();
          }
        auto expected  = SymmetricTensor<2, 3>();
        expected[0][0] = stress;
        EXPECT_NEAR(point.plastic_strain(), alpha, 1e-15);
        EXPECT_LT((point.cauchy_stress() - expected).norm(), 1e-14)
          << alpha << " in " << n;
        const auto energy = law.law->energy(point.F, point.history.data());
        EXPECT_NEAR(energy.stored,
                    determinant(point.F) * stress * stress / 2,
                    1e-16);
      }
  EXPECT_NEAR(hardening.work(0.03), (sigma_y + 0.5 * c_1 * 0.03) * 0.03, 1e-17);
  EXPECT_NEAR(hardening.work(0.07),
              (sigma_y + 0.5 * c_1 * limit) * limit +
                (highest - 0.5 * c_2 * 0.02) * 0.02,
              1e-17);
  EXPECT_NEAR(hardening.work(9.) - hardening.work(1.), 0., 1e-17);
}


TEST(NewtonianFluid, ShearAndCompression)
{
  const double K = 7., mu = 0.3, lambda = 0.2, dt = 0.01;
  PointLayout  history(GeometryKind::three_d);
  EXPECT_EQ(NewtonianFluid({2.}, history, {K, mu, lambda}).wave_speed(),
            std::sqrt(K / 2));
  const auto fluid = fluid_law(K, mu, lambda);
  LawPoint   point(fluid, dt);
  auto       shear = one;
  shear[0][1]      = 5 * dt;
  for (unsigned int n = 0; n < 3; ++n)
    {
      ASSERT_TRUE(point.evaluate(shear));
      point.commit();
      auto expected  = SymmetricTensor<2, 3>();
      expected[0][1] = mu * 5;
      EXPECT_LT((point.cauchy_stress() - expected).norm(), 1e-14);
    }
  EXPECT_NEAR(fluid.law->energy(point.F, point.history.data()).dissipated,
              3 * mu * 25 * dt,
              1e-15);

  LawPoint other(fluid, dt);
  ASSERT_TRUE(other.evaluate(diagonal(0.9, 1., 1.)));
  other.commit();
  const double rate = -0.1 / 0.95 / dt, p = K * (1 / 0.9 - 1);
  EXPECT_NEAR(other.cauchy_stress()[0][0],
              -p + (lambda + 2 * mu) * rate,
              1e-12);
  EXPECT_NEAR(other.cauchy_stress()[1][1], -p + lambda * rate, 1e-12);
  // at rest only the pressure is left
  ASSERT_TRUE(other.evaluate(one));
  EXPECT_NEAR(other.cauchy_stress()[0][0], -p, 1e-14);
  EXPECT_NEAR(fluid.law->energy(other.F, other.history.data()).stored,
              K * (-0.1 - std::log(0.9)),
              1e-15);
}


// One solve is Newton's method; the matrix does not know where it is taken.
TEST(LinearLawMpi, AnElasticStepIsALinearProblem)
{
  const Overrides shear = {"Materials/rubber/Law=linear elastic",
                           "Boundary conditions/bottom/Type=fixed",
                           "Boundary conditions/left/Type=normal displacement",
                           "Boundary conditions/left/Value=0.05*t",
                           "Grid/Upper corner=1.5, 1.5",
                           "Grid/Cells=6, 6",
                           "Loads/Body force=0.02; 0.01*y"};
  for (const std::string kind :
       {"plane strain", "plane stress", "axisymmetric"})
    for (const auto &inertia : {Overrides(), with_inertia})
      {
        Model<2> model(block_scene(kind), shear + inertia);
        for (unsigned int n = 0; n < 2; ++n)
          {
            impm::Vector u;
            const auto   result = model.solve(u);
            EXPECT_TRUE(result.converged) << kind << result.failure;
            EXPECT_LE(result.iterations, 1u) << kind;

            impm::Vector s = model.random_direction(3), Ks = model.vector(),
                         Kt = model.vector();
            model.balance().vmult(Ks, s);
            ASSERT_TRUE(model.balance()
                          .evaluate(model.random_increment(4, 0.02))
                          .admissible);
            model.balance().vmult(Kt, s);
            Kt -= Ks;
            EXPECT_LT(Kt.l2_norm(), 1e-13 * Ks.l2_norm());
            ASSERT_TRUE(model.balance().evaluate(u).admissible);
            model.commit(u);
          }
      }
}
