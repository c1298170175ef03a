#include <impm/balance/plane_stress.h>

#include <gtest/gtest.h>

#include <random>

#include "law_fixture.h"
#include "material_fixture.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  class Sheet : public LawPoint
  {
  public:
    using LawPoint::LawPoint;

    bool
    evaluate(const Tensor<2, 3> &increment);

    // P and dP/d(dF) of the plane.
    std::pair<std::array<double, 4>, std::array<double, 16>>
    carried_back(const Tensor<2, 3> &increment)
    {
      EXPECT_TRUE(evaluate(increment));
      EXPECT_LT(std::abs(response.kirchhoff_stress[2][2]), 1e-13);
      const auto            inverse = law.form() == Material::Form::linearized ?
                                        diagonal(1, 1, 1) :
                                        invert(increment);
      Kinematics<2>::List<> P;
      Kinematics<2>::Matrix<> A;
      const Kinematics<2>     kinematics(false);
      kinematics.carry_back(kinematics.list(response.kirchhoff_stress),
                            inverse,
                            1.,
                            P.data());
      kinematics.carry_back_tangent(spatial.data(), inverse, 1., A.data());
      std::pair<std::array<double, 4>, std::array<double, 16>> result;
      std::copy_n(P.begin(), 4, result.first.begin());
      std::copy_n(A.begin(), 16, result.second.begin());
      return result;
    }

    unsigned int            n_evaluations = 0;
    Kinematics<2>::Matrix<> spatial{}; ///< the first 16
  };

  // A sheet in each lane, all of one law.
  bool
  evaluate(const std::array<Sheet *, n_lanes>      &sheets,
           const std::array<Tensor<2, 3>, n_lanes> &increments)
  {
    Tensor<2, 3, Lanes>          start, increment;
    Places<Lanes, const double>  histories;
    Places<Lanes, double>        trial_histories;
    Material::Responses          responses;
    Kinematics<2>::Matrix<Lanes> matrix;
    Lanes                        n_evaluations = 0.;
    for (unsigned int i = 0; i < n_lanes; ++i)
      {
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = 0; b < 3; ++b)
            {
              start[a][b][i]     = sheets[i]->F[a][b];
              increment[a][b][i] = increments[i][a][b];
            }
        histories[i]       = sheets[i]->history.data();
        trial_histories[i] = sheets[i]->trial_history.data();
      }
    const bool fine = evaluate_plane_stress(sheets[0]->law,
                                            start,
                                            sheets[0]->dt,
                                            histories,
                                            trial_histories,
                                            increment,
                                            responses,
                                            matrix.data(),
                                            n_evaluations);
    for (unsigned int i = 0; i < n_lanes; ++i)
      {
        Sheet &sheet             = *sheets[i];
        auto   taken             = increments[i];
        taken[2][2]              = increment[2][2][i];
        sheet.trial_F            = taken * sheet.F;
        sheet.response.potential = responses.potential[i];
        for (unsigned int a = 0; a < 6; ++a)
          sheet.response.kirchhoff_stress.access_raw_entry(a) =
            responses.kirchhoff_stress.access_raw_entry(a)[i];
        for (unsigned int k = 0; k < 16; ++k)
          sheet.spatial[k] = matrix[k][i];
        sheet.n_evaluations = static_cast<unsigned int>(n_evaluations[i]);
      }
    return fine;
  }

  bool
  Sheet::evaluate(const Tensor<2, 3> &increment)
  {
    std::array<Sheet *, n_lanes>      sheets;
    std::array<Tensor<2, 3>, n_lanes> increments;
    sheets.fill(this);
    increments.fill(increment);
    return ::evaluate(sheets, increments);
  }

  Tensor<2, 3>
  in_the_plane(std::mt19937 &generator, const double size)
  {
    auto F  = random_gradient(generator, true, size);
    F[2][2] = 1;
    return F;
  }
} // namespace


TEST(PlaneStress, UniaxialTensionInClosedForm)
{
  const double nu = 0.3, G = unit_elasticity.shear,
               lame = unit_elasticity.lame();
  for (const auto &named : all_solids(GeometryKind::plane_stress))
    {
      double axial = 1.3, side = 0, stress = 0;
      if (named.name == "log-strain elastic")
        {
          side   = std::pow(axial, -nu);
          stress = std::log(axial);
        }
      else if (named.name == "neo-Hookean")
        {
          side   = 0.9;
          axial  = std::exp(-G * (side * side - 1) / lame) / (side * side);
          stress = G * (axial * axial - side * side);
        }
      else if (named.name == "linear elastic")
        {
          side   = 1 - nu * (axial - 1);
          stress = axial - 1;
        }
      else
        continue;
      Sheet sheet(named);
      ASSERT_TRUE(sheet.evaluate(diagonal(axial, side, 1.)));
      EXPECT_NEAR(sheet.trial_F[2][2], side, 1e-14) << named.name;
      auto expected  = SymmetricTensor<2, 3>();
      expected[0][0] = stress;
      EXPECT_LT((sheet.response.kirchhoff_stress - expected).norm(), 1e-14)
        << named.name;
      EXPECT_LT(sheet.n_evaluations, 8u) << named.name;
    }
}


TEST(PlaneStress, TangentsAreDerivatives)
{
  for (const auto &named : all_solids(GeometryKind::plane_stress))
    for (unsigned int n = 0; n < 6; ++n)
      {
        std::mt19937 generator(n); // the same deformations for all
        SCOPED_TRACE(named.name + ", " + std::to_string(n));
        Sheet sheet(named);
        for (unsigned int past = 0; past < n; ++past)
          {
            ASSERT_TRUE(sheet.evaluate(in_the_plane(generator, 0.05)));
            sheet.commit();
          }
        const auto   increment = in_the_plane(generator, 0.15);
        const auto   here      = sheet.carried_back(increment);
        const double thickness = sheet.trial_F[2][2];
        EXPECT_GT(std::abs(thickness - 1), 1e-3);
        double tangent = 0, stress = 0, asymmetry = 0;
        for (unsigned int b = 0; b < 4; ++b)
          {
            const auto at = [&](const double h) {
              auto moved = increment;
              moved[b / 2][b % 2] += h;
              return moved;
            };
            for (unsigned int a = 0; a < 4; ++a)
              {
                tangent =
                  std::max(tangent,
                           std::abs(
                             here.second[4 * a + b] -
                             derivative(
                               [&](const double h) {
                                 return sheet.carried_back(at(h)).first[a];
                               },
                               1e-4)));
                asymmetry = std::max(asymmetry,
                                     std::abs(here.second[4 * a + b] -
                                              here.second[4 * b + a]));
              }
            stress = std::max(stress,
                              std::abs(here.first[b] -
                                       derivative(
                                         [&](const double h) {
                                           sheet.evaluate(at(h));
                                           return sheet.response.potential;
                                         },
                                         1e-3)));
          }
        EXPECT_LT(tangent, 1e-9);
        if (named.law->has_potential())
          {
            EXPECT_LT(stress, 1e-10);
          }
        if (named.law->has_symmetric_tangent())
          {
            EXPECT_LT(asymmetry, 1e-14);
          }
      }
}


// One at rest, one hardly strained, and two that iterate: none knows of the
// others, to the last bit.
TEST(PlaneStress, LanesEndEachForItself)
{
  std::mt19937 generator(3);
  for (const auto &named : all_solids(GeometryKind::plane_stress))
    {
      SCOPED_TRACE(named.name);
      std::vector<Sheet>                alone(n_lanes, Sheet(named));
      std::array<Tensor<2, 3>, n_lanes> increments;
      for (unsigned int i = 0; i < n_lanes; ++i)
        {
          const double sizes[] = {0., 1e-7, 0.1, 0.2};
          increments[i]        = in_the_plane(generator, sizes[i % 4]);
          ASSERT_TRUE(alone[i].evaluate(increments[i]));
        }
      auto                         together = alone;
      std::array<Sheet *, n_lanes> sheets;
      for (unsigned int i = 0; i < n_lanes; ++i)
        sheets[i] = &together[i];
      ASSERT_TRUE(evaluate(sheets, increments));
      EXPECT_LT(together[0].n_evaluations, together[n_lanes - 1].n_evaluations);
      for (unsigned int i = 0; i < n_lanes; ++i)
        {
          EXPECT_EQ(together[i].n_evaluations, alone[i].n_evaluations);
          EXPECT_EQ(together[i].trial_F, alone[i].trial_F);
          EXPECT_EQ(together[i].trial_history, alone[i].trial_history);
          EXPECT_EQ(together[i].spatial, alone[i].spatial);
          EXPECT_EQ(together[i].response.kirchhoff_stress,
                    alone[i].response.kirchhoff_stress);
        }
      // where one has no stress, none has
      increments[1] = diagonal(-1., 1., 1.);
      EXPECT_FALSE(evaluate(sheets, increments));
    }
}


TEST(PlaneStress, LargeSteps)
{
  for (const auto &named : all_solids(GeometryKind::plane_stress))
    for (const auto &F : {diagonal(3., 1., 1.),
                          diagonal(0.3, 1., 1.),
                          diagonal(2., 2., 1.),
                          diagonal(0.5, 0.5, 1.)})
      {
        Sheet sheet(named);
        // with small strains a sheet can vanish
        if (!sheet.evaluate(F))
          {
            EXPECT_EQ(named.law->form(), Material::Form::linearized)
              << named.name << F;
            continue;
          }
        EXPECT_GT(determinant(sheet.trial_F), 0.);
        EXPECT_LT(std::abs(sheet.response.kirchhoff_stress[2][2]), 1e-13)
          << named.name << F;
        EXPECT_LT(sheet.n_evaluations, 15u) << named.name << F;
      }
}


TEST(PlaneStress, RefusesWhatHasNoStress)
{
  for (const auto &named : all_solids(GeometryKind::plane_stress))
    {
      Sheet sheet(named);
      EXPECT_FALSE(sheet.evaluate(diagonal(-1., 1., 1.))) << named.name;
      EXPECT_FALSE(sheet.evaluate(diagonal(0., 1., 1.))) << named.name;
    }
}


// A strip is drawn out in five steps: what the points keep of its thickness.
TEST(PlaneStressMpi, PointsKeepTheirThickness)
{
  const Overrides tension = {"Boundary conditions/left/Type=slip",
                             "Boundary conditions/bottom/Type=slip",
                             "Boundary conditions/top/Type=normal displacement",
                             "Boundary conditions/top/Value=0.2*t",
                             "Time/Time step=0.2",
                             "Grid/Upper corner=1.25, 1",
                             "Grid/Cells=5, 4"};
  const Overrides moving  = {"Boundary conditions/top/Moves the grid=true"};
  for (const auto &method :
       {moving,
        moving + Overrides{"Grid/Method=GIMP"},
        Overrides{"Grid/Method=Lagrangian", "Grid/Upper corner=1, 1"}})
    {
      Model<2> model(block_scene("plane stress"), tension + method);
      for (unsigned int n = 0; n < 5; ++n)
        {
          impm::Vector u;
          ASSERT_TRUE(model.solve(u).converged);
          model.commit(u);
          if (!model.grid.is_lagrangian)
            {
              model.grid.move_face(3, 1 + 0.2 * model.time);
              model.points.sort();
            }
        }
      const double side = std::pow(1.2, -0.3);
      for (unsigned int p = 0; p < model.points.size(); ++p)
        {
          const auto F = model.points.layout.load_tensor(
            model.points.fields(p) + model.points.offset_deformation);
          EXPECT_LT((F - diagonal(side, 1.2, side)).norm(), 1e-9);
        }
    }
}
