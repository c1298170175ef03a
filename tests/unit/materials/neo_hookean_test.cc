#include <deal.II/base/parameter_handler.h>

#include <impm/materials/list.h>
#include <impm/materials/neo_hookean.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "material_fixture.h"
#include "scene_fixture.h"

namespace
{
  using namespace dealii;
  using namespace impm;

  template <typename Law>
  class NeoHookeanLaws : public testing::Test
  {
  protected:
    static Material::Response
    respond(const Tensor<2, 3> &F, const double poisson = 0.3)
    {
      const Law          law({1000.},
                    no_history,
                    ElasticConstants::from_young(1., poisson));
      Material::Response response;
      EXPECT_TRUE(
        law.evaluate_one({F, F, 0., nullptr, nullptr}, true, response));
      EXPECT_EQ(law.energy(F, nullptr).stored, response.potential);
      return response;
    }

    static bool
    is_refused(const Tensor<2, 3> &F)
    {
      const Law law({1000.}, no_history, ElasticConstants::from_young(1., 0.3));
      Material::Response response;
      return !law.evaluate_one({F, F, 0., nullptr, nullptr}, true, response);
    }
  };

  using Laws = testing::Types<NeoHookean<false>, NeoHookean<true>>;
  TYPED_TEST_SUITE(NeoHookeanLaws, Laws);
} // namespace


TYPED_TEST(NeoHookeanLaws, TangentOfRandomDeformations)
{
  std::mt19937 generator(1);
  for (const double poisson : {-0.5, 0., 0.3, 0.4999})
    for (unsigned int n = 0; n < 10; ++n)
      for (const bool planar : {true, false})
        {
          const auto respond = [&](const Tensor<2, 3> &F) {
            return this->respond(F, poisson);
          };
          const auto F = random_gradient(generator, planar) *
                         random_gradient(generator, planar);
          const auto   c    = respond(F).tangent;
          const double size = c.norm();
          EXPECT_LT(tangent_error(respond, F, 3e-3), 1e-12 * size) << F;
          EXPECT_LT(potential_error(respond, F, 3e-3), 1e-12 * size) << F;

          double asymmetry = 0;
          for (unsigned int a = 0; a < 6; ++a)
            for (unsigned int b = 0; b < 6; ++b)
              {
                using Stress  = SymmetricTensor<2, 3>;
                const auto ij = Stress::unrolled_to_component_indices(a);
                const auto kl = Stress::unrolled_to_component_indices(b);
                asymmetry     = std::max(asymmetry,
                                     std::abs(c[ij[0]][ij[1]][kl[0]][kl[1]] -
                                              c[kl[0]][kl[1]][ij[0]][ij[1]]));
              }
          EXPECT_LT(asymmetry, 1e-15 * size);
        }
}


TYPED_TEST(NeoHookeanLaws, TangentOfLargeStretches)
{
  const auto respond = [&](const Tensor<2, 3> &F) { return this->respond(F); };
  for (const auto &stretch : {diagonal(10., 0.1, 1.),
                              diagonal(0.1, 10., 0.1),
                              diagonal(10., 10., 0.1),
                              diagonal(10., 10., 10.),
                              diagonal(0.1, 0.1, 0.1)})
    for (const auto &q : {in_plane, in_space})
      {
        const auto   F = q * stretch * some_other;
        const double size =
          respond(F).tangent.norm() + respond(F).kirchhoff_stress.norm();
        EXPECT_LT(tangent_error(respond, F, 3e-3), 1e-11 * size) << F;
        EXPECT_LT(potential_error(respond, F, 3e-3), 1e-11 * size) << F;
      }
}


TYPED_TEST(NeoHookeanLaws, Objectivity)
{
  std::mt19937 generator(2);
  for (const bool planar : {true, false})
    {
      const auto F     = random_gradient(generator, planar);
      const auto still = this->respond(F);
      const auto tau   = still.kirchhoff_stress;
      for (const auto &q : {in_plane, in_space, some_other})
        {
          const auto after = this->respond(q * F);
          EXPECT_LT((after.kirchhoff_stress - turned(tau, q)).norm(), 1e-14);
          EXPECT_NEAR(after.potential, still.potential, 1e-15);
          EXPECT_LT((this->respond(F * q).kirchhoff_stress - tau).norm(),
                    1e-14);
        }
    }
}


// The stress and the energy of small strains keep their digits, also where the
// material hardly changes its volume.
TYPED_TEST(NeoHookeanLaws, SmallStrainsAreLinear)
{
  for (const double poisson : {-0.5, 0., 0.3, 0.4999})
    {
      const auto constants = ElasticConstants::from_young(1., poisson);
      const auto unit      = unit_symmetric_tensor<3>();
      const auto c         = constants.lame() * outer_product(unit, unit) +
                     2. * constants.shear * identity_tensor<3>();
      const auto at_rest = this->respond(unit, poisson);
      EXPECT_EQ(at_rest.kirchhoff_stress.norm(), 0.);
      EXPECT_EQ(at_rest.potential, 0.);
      EXPECT_LT((at_rest.tangent - c).norm(), 1e-15 * c.norm());

      std::mt19937 generator(3);
      for (const double size : {1e-4, 1e-6, 1e-8})
        {
          const auto F = random_gradient(generator, false, size);
          const SymmetricTensor<2, 3> strain   = symmetrize(F) - unit;
          const SymmetricTensor<2, 3> stress   = c * strain;
          const auto                  response = this->respond(F, poisson);
          EXPECT_LT((response.kirchhoff_stress - stress).norm(),
                    10 * size * c.norm() * size);
          // terms of order size of the energy cancel
          const double energy = 0.5 * stress * strain;
          EXPECT_NEAR(response.potential,
                      energy,
                      10 * size * c.norm() * size * size + 1e-15 * size)
            << size;
        }
    }
}


TYPED_TEST(NeoHookeanLaws, RefusesWhatHasNoStress)
{
  EXPECT_TRUE(this->is_refused(diagonal(-1., 1., 1.)));
  EXPECT_TRUE(this->is_refused(diagonal(0., 1., 1.)));
  EXPECT_TRUE(this->is_refused(Tensor<2, 3>()));
  EXPECT_TRUE(this->is_refused(diagonal(1e200, 1e-200, 1.)));

  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        {
          auto F  = diagonal(1., 1., 1.);
          F[i][j] = bad;
          EXPECT_TRUE(this->is_refused(F)) << i << j << bad;
        }
}


// Figures by hand at F = diag(2, 1, 1): b = diag(4, 1, 1), ln J = ln 2.
TEST(NeoHookean, FiguresByHand)
{
  const double            mu = 3., kappa = 11., lame = kappa - 2. * mu / 3.;
  const auto              constants = ElasticConstants::from_moduli(mu, kappa);
  const auto              F         = diagonal(2., 1., 1.);
  const double            log_J     = std::log(2.);
  Material::Response      response;
  const NeoHookean<false> coupled({1.}, no_history, constants);
  ASSERT_TRUE(
    coupled.evaluate_one({F, F, 0., nullptr, nullptr}, false, response));
  EXPECT_NEAR(response.kirchhoff_stress[0][0], 3 * mu + lame * log_J, 1e-14);
  EXPECT_NEAR(response.kirchhoff_stress[1][1], lame * log_J, 1e-14);
  EXPECT_NEAR(response.potential,
              mu / 2 * (3 - 2 * log_J) + lame / 2 * log_J * log_J,
              1e-14);

  const double           shrink = std::pow(2., -2. / 3.);
  const NeoHookean<true> decoupled({1.}, no_history, constants);
  ASSERT_TRUE(
    decoupled.evaluate_one({F, F, 0., nullptr, nullptr}, false, response));
  EXPECT_NEAR(response.kirchhoff_stress[0][0],
              2 * mu * shrink + kappa * log_J,
              1e-14);
  EXPECT_NEAR(response.kirchhoff_stress[1][1],
              -mu * shrink + kappa * log_J,
              1e-14);
  EXPECT_NEAR(response.potential,
              mu / 2 * (6 * shrink - 3) + kappa / 2 * log_J * log_J,
              1e-14);
}


TEST(NeoHookean, EntriesAreThoseOfTheChosenPair)
{
  const Overrides law   = {"Materials/rubber/Law=decoupled neo-Hookean"};
  const auto      check = [&](const Overrides &overrides) {
    // the block sets Young's modulus and Poisson's ratio
    return scene_from<2>(block_scene("plane strain"), law + overrides)
      .bodies[0]
      .material;
  };
  const auto by_young = check({});
  EXPECT_DOUBLE_EQ(by_young->stiffness(), 1.);
  // those of the other pair do nothing, and warn
  EXPECT_DOUBLE_EQ(check({"Materials/rubber/Shear modulus=6"})->stiffness(),
                   1.);
  EXPECT_NO_THROW(
    check({"Materials/rubber/Constants from=shear and bulk modulus"}));

  std::string text = block_scene("plane strain");
  const auto  from = text.find("    set Young's modulus");
  const auto  to   = text.find("  end", from);
  text.replace(from,
               to - from,
               "    set Constants from = shear and bulk modulus\n"
               "    set Shear modulus  = 6\n"
               "    set Bulk modulus   = 60\n");
  const auto by_moduli = scene_from<2>(text, law).bodies[0].material;
  EXPECT_DOUBLE_EQ(by_moduli->stiffness(), 9. * 60 * 6 / (3 * 60 + 6));
  EXPECT_DOUBLE_EQ(by_moduli->wave_speed(), std::sqrt(68.));
  EXPECT_TRUE(by_moduli->has_potential());
}
