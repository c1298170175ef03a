#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/orthotropic_elastic.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "expect_blame.h"
#include "law_scene.h"
#include "material_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // Carbon fibres in epoxy (GPa), along axis 1.
  const Entries carbon = {{"Young's moduli", "140, 10, 9"},
                          {"Poisson's ratios", "0.3, 0.45, 0.25"},
                          {"Shear moduli", "5, 3.5, 4.5"}};

  const ElasticConstants steel     = ElasticConstants::from_young(2., 0.3);
  const Entries          isotropic = {{"Young's moduli", "2, 2, 2"},
                                      {"Poisson's ratios", "0.3, 0.3, 0.3"},
                                      {"Shear moduli",
                                       "0.7692307692307692, 0.7692307692307692, "
                                                "0.7692307692307692"}};

  std::string
  text_of(const Tensor<1, 3> &vector)
  {
    std::ostringstream text;
    text.precision(17);
    text << vector[0] << ", " << vector[1] << ", " << vector[2];
    return text.str();
  }

  /** Axes 1 and 2 are the first columns of a rotation. */
  Entries
  with_axes(Entries entries, const Tensor<2, 3> &q)
  {
    entries["First axis"]  = text_of(Tensor<1, 3>({q[0][0], q[1][0], q[2][0]}));
    entries["Second axis"] = text_of(Tensor<1, 3>({q[0][1], q[1][1], q[2][1]}));
    return entries;
  }

  Material::Response
  respond(const Material &law, const Tensor<2, 3> &F)
  {
    Material::Response response;
    EXPECT_TRUE(law.evaluate_one({F, F, 0., nullptr, nullptr}, true, response));
    EXPECT_NEAR(law.energy(F, nullptr).stored,
                response.potential,
                1e-14 * response.tangent.norm());
    return response;
  }

  OrthotropicElastic
  law_of(const Entries &entries)
  {
    return {{1.}, no_history, orthotropic_constants(entries)};
  }

  /** Two or three stretches that are equal or nearly so, along turned axes. */
  std::vector<Tensor<2, 3>>
  deformations()
  {
    std::vector<Tensor<2, 3>> all = {diagonal(1., 1., 1.),
                                     diagonal(2., 2., 2.),
                                     diagonal(1.5, 1.5, 0.7)};
    for (const double gap : {1e-12, 1e-8, 1e-5, 1e-3, 0.02, 0.026, 0.1})
      for (const auto &[x, y, z] :
           {std::array<double, 3>{{1.3, 1.3 * (1 + gap), 0.8}},
            std::array<double, 3>{{1.3, 1.3 * (1 + gap), 1.3 * (1 - gap)}}})
        all.push_back(some_other * diagonal(x, y, z) * transpose(in_space));
    std::mt19937 generator(1);
    for (unsigned int n = 0; n < 10; ++n)
      all.push_back(random_gradient(generator, n % 2 == 0) *
                    random_gradient(generator, n % 2 == 0));
    return all;
  }
} // namespace


TEST(Orthotropic, EqualConstantsAreHencky)
{
  const LogStrainElastic hencky({1.}, no_history, steel);
  for (const auto &axes : {diagonal(1., 1., 1.), in_plane, in_space})
    {
      const auto law = law_of(with_axes(isotropic, axes));
      EXPECT_NEAR(law.stiffness(), hencky.stiffness(), 1e-14);
      EXPECT_NEAR(law.wave_speed(), hencky.wave_speed(), 1e-12);
      for (const auto &F : deformations())
        {
          const auto   expected = respond(hencky, F), found = respond(law, F);
          const double size = expected.tangent.norm();
          EXPECT_LT((found.kirchhoff_stress - expected.kirchhoff_stress).norm(),
                    1e-14 * size)
            << F;
          EXPECT_LT((found.tangent - expected.tangent).norm(), 1e-12 * size)
            << F;
          EXPECT_NEAR(found.potential, expected.potential, 1e-14 * size);
        }
    }
}


TEST(Orthotropic, TangentsOfMeetingStretches)
{
  const auto law = law_of(with_axes(carbon, in_space));
  for (const auto &F : deformations())
    {
      const auto   at = [&](const Tensor<2, 3> &G) { return respond(law, G); };
      const double scale = at(F).tangent.norm();
      EXPECT_LT(tangent_error(at, F, 1e-3), 1e-10 * scale) << F;
      EXPECT_LT(potential_error(at, F, 1e-3), 1e-10 * scale) << F;
    }
}


// Along the axes the logarithmic strains are those of a bar, however large.
TEST(Orthotropic, UniaxialStressInClosedForm)
{
  const double E[]     = {140, 10, 9};
  const double nu[][3] = {{0, 0.3, 0.25},
                          {0.3 * 10 / 140, 0, 0.45},
                          {0.25 * 9 / 140, 0.45 * 9 / 10, 0}};
  for (const auto &axes : {diagonal(1., 1., 1.), in_space})
    {
      const auto law = law_of(with_axes(carbon, axes));
      for (unsigned int i = 0; i < 3; ++i)
        for (const double strain : {-1.5, -0.3, 1e-6, 0.4, 1.})
          {
            auto stretch = diagonal(0., 0., 0.);
            for (unsigned int j = 0; j < 3; ++j)
              stretch[j][j] = std::exp(j == i ? strain : -nu[i][j] * strain);
            SymmetricTensor<2, 3> stress;
            stress[i][i] = E[i] * strain;
            const auto found =
              respond(law, axes * stretch * transpose(axes)).kirchhoff_stress;
            EXPECT_LT((found - turned(stress, axes)).norm(), 2e-13 * 140);
          }
    }
}


// A lamina under a small stress at an angle to its fibres: 1/E_x = c^4/E_1 +
// s^4/E_2 + c^2 s^2 (1/G_12 - 2 nu_12/E_1), and the shear that goes with it (R.
// M. Jones, Mechanics of Composite Materials, 2nd ed., 1999, sec. 2.6).
TEST(Orthotropic, OffAxisTensionInClosedForm)
{
  const double E1 = 140, E2 = 10, G = 5, nu12 = 0.3, nu13 = 0.25, nu23 = 0.45;
  for (double angle = 0; angle < 1.6; angle += 0.1)
    {
      const double c = std::cos(angle), s = std::sin(angle);
      const double stress = 1e-7;
      const double young  = 1 / (c * c * c * c / E1 + s * s * s * s / E2 +
                                c * c * s * s * (1 / G - 2 * nu12 / E1));
      SymmetricTensor<2, 3> strain;
      strain[0][0] = stress / young;
      strain[1][1] = stress * (c * c * s * s * (1 / E1 + 1 / E2 - 1 / G) -
                               (c * c * c * c + s * s * s * s) * nu12 / E1);
      strain[0][1] = 0.5 * stress *
                     (c * c * c * s * (2 / E1 + 2 * nu12 / E1 - 1 / G) -
                      c * s * s * s * (2 / E2 + 2 * nu12 / E1 - 1 / G));
      strain[2][2]   = -stress * (c * c * nu13 / E1 + s * s * nu23 / E2);
      const auto law = law_of(with_axes(carbon, rotation_z(angle)));
      const auto found =
        respond(law,
                Tensor<2, 3>(unit_symmetric_tensor<3>()) + Tensor<2, 3>(strain))
          .kirchhoff_stress;
      SymmetricTensor<2, 3> expected;
      expected[0][0] = stress;
      EXPECT_LT((found - expected).norm(), 1e-6 * stress) << angle;
    }
}


// Stretches along x and y, fibres at an angle: T = C : E with E of the two, and
// the shear of tau less than that of T by x / sinh x.
TEST(Orthotropic, StretchesAcrossTheFibres)
{
  const double          angle = 0.5, first = 0.6, second = -0.4;
  const auto            q         = rotation_z(angle);
  const auto            law       = law_of(with_axes(carbon, q));
  const auto            constants = orthotropic_constants(carbon);
  SymmetricTensor<2, 3> E;
  E[0][0]                       = first;
  E[1][1]                       = second;
  const auto            in_axes = turned(E, transpose(q));
  SymmetricTensor<2, 3> T;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      T[i][i] += constants.stiffness[i][j] * in_axes[j][j];
  T[0][1]       = 2 * 5 * in_axes[0][1];
  auto expected = turned(T, q);
  expected[0][1] *= (first - second) / std::sinh(first - second);
  const auto found =
    respond(law, diagonal(std::exp(first), std::exp(second), 1.));
  EXPECT_LT((found.kirchhoff_stress - expected).norm(), 1e-13 * 140);
  EXPECT_GT(std::abs(expected[0][1]), 10.);
}


// Turned behind the deformation stresses turn; turned before it, with the axes
// of the material, nothing changes.
TEST(Orthotropic, TurnsWithTheBody)
{
  for (const auto &F : deformations())
    for (const auto &q : {in_plane, in_space})
      {
        const auto law      = law_of(with_axes(carbon, some_other));
        const auto expected = respond(law, F);
        const auto behind   = respond(law, q * F);
        const auto before =
          respond(law_of(with_axes(carbon, q * some_other)), F * transpose(q));
        const double size = expected.tangent.norm();
        EXPECT_LT((behind.kirchhoff_stress -
                   turned(expected.kirchhoff_stress, q))
                    .norm(),
                  1e-13 * size);
        EXPECT_LT((before.kirchhoff_stress - expected.kirchhoff_stress).norm(),
                  1e-13 * size);
        EXPECT_LT((before.tangent - expected.tangent).norm(), 1e-12 * size);
        EXPECT_NEAR(behind.potential, expected.potential, 1e-13 * size);
      }
}


TEST(Orthotropic, WavesAndHugeStretches)
{
  // along the fibres C_11 is the largest
  const auto constants = orthotropic_constants(carbon);
  EXPECT_DOUBLE_EQ(constants.longitudinal_modulus(), constants.stiffness[0][0]);
  EXPECT_DOUBLE_EQ(law_of(carbon).stiffness(), 9.);
  // with a stiff shear waves between the axes are the fastest
  auto weave            = carbon;
  weave["Shear moduli"] = "200, 3.5, 4.5";
  EXPECT_GT(orthotropic_constants(weave).longitudinal_modulus(),
            1.5 * orthotropic_constants(weave).stiffness[0][0]);

  // differences have to be small against the ratio of the stretches
  const auto law = law_of(with_axes(carbon, in_space));
  for (const auto &F : {diagonal(0.1, 1., 10.), diagonal(0.02, 0.02, 1.)})
    {
      const auto   at = [&](const Tensor<2, 3> &G) { return respond(law, G); };
      const double scale = at(F).tangent.norm();
      EXPECT_LT(tangent_error(at, F, 1e-4), 1e-9 * scale) << F;
    }
  // along the axes: F^T F in others has lost the digits of the small ones
  const LogStrainElastic hencky({1.}, no_history, steel);
  const auto             equal = law_of(isotropic);
  for (const auto &F : {diagonal(1e-3, 1., 1e3),
                        diagonal(1e-6, 1e-6, 1.),
                        diagonal(1e4, 1., 1.)})
    {
      const auto expected = respond(hencky, F), found = respond(equal, F);
      EXPECT_LT((found.tangent - expected.tangent).norm(),
                1e-12 * expected.tangent.norm())
        << F;
      EXPECT_LT((found.kirchhoff_stress - expected.kirchhoff_stress).norm(),
                1e-12 * expected.tangent.norm())
        << F;
    }
  Material::Response response;
  for (const auto &F : {diagonal(-1., 1., 1.), diagonal(0., 1., 1.)})
    EXPECT_FALSE(
      law.evaluate_one({F, F, 0., nullptr, nullptr}, true, response));
}


TEST(Orthotropic, BadEntries)
{
  const auto blame = [](const std::string &kind,
                        const Lines       &entries,
                        const std::string &entry,
                        const Lines       &words) {
    Lines lines = entries;
    lines.insert(lines.begin(), "Law = orthotropic elastic");
    expect_blame(law_scene(kind, lines),
                 {},
                 entry.empty() ? entry : "Materials/rubber/" + entry,
                 words);
  };
  const std::string plane = "plane strain";
  blame(plane,
        {"Young's moduli = 1, 2"},
        "Young's moduli",
        {"'1, 2'", "three numbers"});
  blame(plane, {"Young's moduli = 1, 2, 0"}, "", {"Young's moduli"});
  blame(plane,
        {"Young's moduli = 1, 10, 1", "Poisson's ratios = 0.4, 0.3, 0.3"},
        "Poisson's ratios",
        {"nu_12^2 < E_1 / E_2", "0.1"});
  blame(plane,
        {"Young's moduli = 1, 1, 10", "Poisson's ratios = 0.3, 0.4, 0.3"},
        "Poisson's ratios",
        {"nu_23^2 < E_2 / E_3"});
  blame(plane,
        {"Poisson's ratios = 0.6, 0.6, 0.6"},
        "Poisson's ratios",
        {"nu_13 > 0"});
  blame(plane, {"First axis = 0, 0, 0"}, "First axis", {"other than 0"});
  blame(plane, {"First axis = 0, 2, 0"}, "Second axis", {"parallel"});
  blame(plane,
        {"First axis = 1, 0, 1", "Second axis = 1, 0, 0"},
        "First axis",
        {"perpendicular"});
}


TEST(Orthotropic, AxesThatAGeometryAllows)
{
  const auto allows = [](const std::string &first,
                         const std::string &second,
                         const GeometryKind geometry) {
    auto entries           = carbon;
    entries["First axis"]  = first;
    entries["Second axis"] = second;
    const auto constants   = orthotropic_constants(entries);
    try
      {
        constants.check_axes(geometry);
        return true;
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, "First axis");
        return false;
      }
  };
  const auto plane = GeometryKind::plane_stress,
             axis = GeometryKind::axisymmetric, space = GeometryKind::three_d;
  for (const auto &[first, second] :
       {std::array<std::string, 2>{{"1, 0, 0", "0, 1, 0"}},
        std::array<std::string, 2>{{"0, 0, 1", "0, -3, 0"}},
        std::array<std::string, 2>{{"0, 1, 0", "0, 1, 1"}}})
    for (const auto geometry : {plane, axis, space})
      EXPECT_TRUE(allows(first, second, geometry)) << first;
  EXPECT_TRUE(allows("1, 2, 0", "0, 1, 0", plane));
  EXPECT_FALSE(allows("1, 2, 0", "0, 1, 0", axis));
  EXPECT_TRUE(allows("0, 0, 1", "1, 1, 0", plane));
  EXPECT_FALSE(allows("0, 0, 1", "1, 1, 0", axis));
  EXPECT_FALSE(allows("1, 0, 1", "0, 1, 1", plane));
  EXPECT_TRUE(allows("1, 0, 1", "0, 1, 1", space));
}


// Alike across the axis along which they are drawn.
TEST(OrthotropicMpi, DrawnBlocks)
{
  const Lines entries = {"Law = orthotropic elastic",
                         "Young's moduli = 1, 2, 1",
                         "Poisson's ratios = 0.2, 0.4, 0.3",
                         "Shear moduli = 0.4, 0.4, 0.3"};
  for (const std::string kind :
       {"plane strain", "plane stress", "axisymmetric"})
    draw_block<2>(kind, entries);
  draw_block<3>("3D", entries);
}


// A cell of a lamina that is sheared: its tangent on a grid, with F-bar, too.
TEST(OrthotropicMpi, TangentsOnAGrid)
{
  for (const std::string f_bar : {"false", "true"})
    for (const std::string method : {"MPM", "GIMP"})
      {
        Model<2> model(law_scene("plane strain",
                                 {"Law = orthotropic elastic",
                                  "Young's moduli = 1, 0.1, 0.1",
                                  "Poisson's ratios = 0.3, 0.4, 0.3",
                                  "Shear moduli = 0.05, 0.04, 0.05",
                                  "First axis = 1, 2, 0",
                                  "F-bar = " + f_bar}),
                       {"Grid/Method=" + method});
        model.scatter_points(1);
        model.begin_step();
        impm::Vector u       = model.random_increment(1, 0.02);
        auto        &balance = model.balance();
        ASSERT_TRUE(balance.evaluate(u).admissible);
        const auto   s       = model.random_direction(1);
        impm::Vector tangent = model.vector();
        balance.vmult(tangent, s);
        const auto residual_at = [&](const double h) {
          impm::Vector moved = u;
          moved.add(h, s);
          EXPECT_TRUE(balance.evaluate(moved, false).admissible);
          return balance.residual();
        };
        const double h          = 1e-5;
        impm::Vector difference = residual_at(h);
        difference -= residual_at(-h);
        difference *= 8.;
        difference -= residual_at(2 * h);
        difference += residual_at(-2 * h);
        difference *= 1. / (12 * h);
        difference -= tangent;
        EXPECT_LT(difference.linfty_norm(), 1e-7 * tangent.linfty_norm());
      }
}
