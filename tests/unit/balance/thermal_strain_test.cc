#include <impm/base/exceptions.h>
#include <impm/points/point_fields.h>

#include <gtest/gtest.h>

#include <random>

#include "law_scene.h"
#include "material_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  const double nu = 0.3, K = 1 / (3 * (1 - 2 * nu));

  const std::vector<std::string> geometries = {"plane strain",
                                               "plane stress",
                                               "axisymmetric",
                                               "3D"};

  /** A law of stiffness 1 that becomes hotter, with a strain of 0.1 t. */
  Lines
  hot(const std::string &law, const std::string &temperature = "300 + 100*t")
  {
    Lines lines = {"Law = " + law,
                   "Density = 1",
                   "Prescribed temperature = " + temperature,
                   "Thermal expansion = 1e-3",
                   "Stress-free temperature = 300"};
    if (law != "Newtonian fluid")
      lines.push_back("Young's modulus = 1");
    else
      {
        lines.push_back("Bulk modulus = 1");
        lines.push_back("Viscosity = 0.3");
      }
    if (law.find("Mises") != std::string::npos)
      {
        lines.push_back("F-bar = false");
        lines.push_back("Yield stress = 0.02");
        lines.push_back("Hardening modulus = 0.1");
      }
    return lines;
  }

  const std::vector<std::string> laws = {"log-strain elastic",
                                         "neo-Hookean",
                                         "linear elastic",
                                         "Jaumann elastic",
                                         "log-strain von Mises",
                                         "linear von Mises",
                                         "Jaumann von Mises"};

  /** Free but for planes of symmetry, with room around. */
  Overrides
  free_block(const unsigned int dim, const std::string &method)
  {
    const std::string size = method == "Lagrangian" ? "1" : "1.5";
    const std::string n    = method == "Lagrangian" ? "2" : "3";
    Overrides         all  = {"Grid/Method=" + method,
                              "Grid/Upper corner=" + size + "," + size +
                                (dim == 3 ? "," + size : ""),
                              "Grid/Cells=" + n + "," + n + (dim == 3 ? "," + n : ""),
                              "Time/Time step=0.5"};
    for (unsigned int d = 0; d < dim; ++d)
      all.push_back("Boundary conditions/" + face_names()[2 * d] +
                    "/Type=slip");
    return all;
  }

  Overrides
  held_block(const unsigned int dim)
  {
    Overrides all = {"Time/Time step=0.5"};
    for (unsigned int f = 0; f < 2 * dim; ++f)
      all.push_back("Boundary conditions/" + face_names()[f] + "/Type=fixed");
    return all;
  }

  template <int dim>
  void
  make_steps(Model<dim> &model, const unsigned int n)
  {
    for (unsigned int i = 0; i < n; ++i)
      {
        Vector     u;
        const auto result = model.solve(u);
        ASSERT_TRUE(result.converged) << result.failure;
        model.commit(u);
      }
  }

  template <int dim>
  SymmetricTensor<2, 3>
  stress(const Model<dim> &model, const unsigned int p)
  {
    const auto field = make_point_field<dim>("kirchhoff_stress", model.points);
    double     values[9];
    field->evaluate(p, {}, values);
    SymmetricTensor<2, 3> tau;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        tau[i][j] = values[3 * i + j];
    return tau;
  }

  template <int dim>
  void
  expand_freely(const std::string &geometry,
                const std::string &law,
                const std::string &method)
  {
    SCOPED_TRACE(geometry + ", " + law + ", " + method);
    Model<dim> model(law_scene(geometry, hot(law)), free_block(dim, method));
    make_steps(model, 2);
    const double theta  = 0.1;
    const bool   linear = law == "linear elastic" || law == "linear von Mises";
    // small strains of two steps, else the exponential
    const double s =
      linear ? (1 + theta / 2) * (1 + theta / 2) : std::exp(theta);
    for (unsigned int p = 0; p < model.points.size(); ++p)
      {
        const auto F = deformation_gradient(model.points, p);
        EXPECT_LT((F - diagonal(s, s, s)).norm(), 1e-12);
        EXPECT_LT(stress(model, p).norm(), 1e-12);
      }
  }

  template <int dim>
  void
  hold(const std::string &geometry, const std::string &law)
  {
    SCOPED_TRACE(geometry + ", " + law);
    Model<dim> model(law_scene(geometry, hot(law, "300 + 0.1*t")),
                     held_block(dim));
    make_steps(model, 2);
    const double theta    = 1e-4;
    auto         expected = -3 * K * theta * unit_symmetric_tensor<3>();
    if (geometry == "plane stress")
      {
        expected       = -theta / (1 - nu) * unit_symmetric_tensor<3>();
        expected[2][2] = 0;
      }
    // The rate law gives sigma by J_e and adds up midpoint strains.
    const bool   is_rate   = law.find("Jaumann") == 0;
    const double tolerance = (is_rate ? 1e-8 : 1e-11) * theta;
    if (is_rate)
      expected *= std::exp(geometry == "plane stress" ?
                             -2 * theta * (1 - 2 * nu) / (1 - nu) :
                             -3 * theta);
    for (unsigned int p = 0; p < model.points.size(); ++p)
      {
        // sigma of the linear laws counts by the volume now
        const double J = law.find("linear") == 0 ?
                           determinant(deformation_gradient(model.points, p)) :
                           1.;
        EXPECT_LT((stress(model, p) - J * expected).norm(), tolerance);
      }
  }

  /** The tangent at a second step, of a random increment. */
  template <int dim>
  void
  compare_tangent(const std::string &geometry,
                  const std::string &law,
                  const Overrides   &more = {})
  {
    SCOPED_TRACE(geometry + ", " + law + (more.empty() ? "" : ", F-bar"));
    Model<dim> model(law_scene(geometry, hot(law, "300 + 100*t*x")),
                     free_block(dim, "MPM") + more);
    make_steps(model, 1);
    model.begin_step();
    auto                                  &response = model.problem->response;
    const auto                             n        = response.gradients.size();
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> uniform(-0.05, 0.05);
    std::vector<double>                    at(n), direction(n), change(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        at[i]        = uniform(generator);
        direction[i] = 20 * uniform(generator);
      }
    const double h         = 1e-6;
    const auto   stress_at = [&](const double step, const bool tangent) {
      for (unsigned int i = 0; i < n; ++i)
        response.gradients[i] = at[i] + step * direction[i];
      EXPECT_TRUE(response.evaluate(tangent));
      return response.stresses;
    };
    const auto ahead = stress_at(h, false), behind = stress_at(-h, false);
    stress_at(0, true); // the first one is that of the temperature before
    stress_at(0, true);
    response.apply_tangent(direction, change);
    double error = 0, size = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        error =
          std::max(error,
                   std::abs((ahead[i] - behind[i]) / (2 * h) - change[i]));
        size = std::max(size, std::abs(change[i]));
      }
    EXPECT_LT(error, 1e-7 * size);
  }
} // namespace


TEST(ThermalStrain, FreeExpansionIsWithoutStress)
{
  for (const auto &law : laws)
    for (const std::string method : {"MPM", "GIMP", "Lagrangian"})
      for (const std::string geometry : {"plane stress", "axisymmetric"})
        expand_freely<2>(geometry, law, method);
  for (const auto &law : laws)
    expand_freely<3>("3D", law, "MPM");
}


// Held across the plane, it goes farther in it: by (1 + nu) of the strain.
TEST(ThermalStrain, PlaneStrainInClosedForm)
{
  Model<2> model(law_scene("plane strain", hot("log-strain elastic")),
                 free_block(2, "MPM"));
  make_steps(model, 2);
  const double theta = 0.1, s = std::exp((1 + nu) * theta);
  for (unsigned int p = 0; p < model.points.size(); ++p)
    {
      EXPECT_LT(
        (deformation_gradient(model.points, p) - diagonal(s, s, 1.)).norm(),
        1e-12);
      auto expected  = SymmetricTensor<2, 3>();
      expected[2][2] = -theta;
      EXPECT_LT((stress(model, p) - expected).norm(), 1e-12);
    }
}


TEST(ThermalStrain, StressWhereNothingMoves)
{
  for (const auto &law : laws)
    if (law != "neo-Hookean") // which is another law of finite strains
      {
        for (const std::string geometry :
             {"plane strain", "plane stress", "axisymmetric"})
          hold<2>(geometry, law);
        hold<3>("3D", law);
      }
}


TEST(ThermalStrain, TangentsAreDerivatives)
{
  for (auto law : laws)
    {
      for (const std::string geometry :
           {"plane strain", "plane stress", "axisymmetric"})
        compare_tangent<2>(geometry, law);
      compare_tangent<3>("3D", law);
    }
  compare_tangent<2>("plane strain", "Newtonian fluid");
  for (const std::string geometry : {"plane strain", "axisymmetric"})
    compare_tangent<2>(geometry,
                       "log-strain von Mises",
                       {"Materials/rubber/F-bar=true"});
}


// A step begins with the stress that the one before has left, in whatever
// thickness plane stress has found; but for the linear laws, whose stress
// counts by the volume at the start.
TEST(ThermalStrain, StepsBeginWhereTheOneBeforeHasEnded)
{
  for (const auto &law : laws)
    for (const std::string geometry : {"plane strain", "plane stress"})
      {
        if (geometry == "plane stress" && law.find("linear") == 0)
          continue;
        SCOPED_TRACE(geometry + ", " + law);
        Model<2>     model(law_scene(geometry, hot(law)), held_block(2));
        impm::Vector u;
        ASSERT_TRUE(model.solve(u).converged);
        const auto before = model.problem->response.stresses;
        EXPECT_GT(model.problem->response.work_of_heat(), 1e-4);
        model.commit(u);
        model.begin_step();
        const auto &after = model.problem->response.start_stresses;
        for (unsigned int i = 0; i < before.size(); ++i)
          EXPECT_NEAR(before[i], after[i], 1e-13);
      }
}


TEST(ThermalStrain, WhatContradictsIsRefused)
{
  const auto refusal = [](const Lines &lines) -> std::string {
    try
      {
        scene_from<2>(law_scene("plane strain", lines));
      }
    catch (const InputError &error)
      {
        return error.entry + ": " + error.what();
      }
    return "";
  };
  const auto contains = [](const std::string &text, const std::string &part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const auto base = hot("log-strain elastic");
  EXPECT_EQ(refusal(base), "");
  contains(refusal([&] {
             auto lines = base;
             lines.push_back("Specific heat = 1");
             return lines;
           }()),
           "allowed with a 'Prescribed temperature' is none");
  contains(refusal(hot("log-strain elastic", "300 + z")), "without z");
  contains(refusal([] {
             auto lines = hot("log-strain elastic", "300 + x");
             for (auto &line : lines)
               if (line.find("Stress-free") == 0)
                 line = "Poisson's ratio = 0.3";
             return lines;
           }()),
           "not the same everywhere");
  contains(refusal({"Law = log-strain elastic",
                    "Specific heat = 1",
                    "Initial temperature = 300 + x"}),
           "without a 'Conductivity' is one number");
  // Without a temperature they do nothing, and warn.
  EXPECT_EQ(refusal({"Law = log-strain elastic", "Thermal expansion = 1e-5"}),
            "");
  EXPECT_EQ(refusal({"Law = log-strain elastic", "Conductivity = 12"}), "");
  contains(refusal({"Law = log-strain elastic",
                    "Specific heat = 1",
                    "Thermal expansion = 12"}),
           "between -0.1 and 0.1");
  contains(refusal({"Law = log-strain elastic",
                    "Specific heat = 1",
                    "Conductivity = -1"}),
           "Conductivity");
}


TEST(ThermalStrain, NoTemperatureIsBelowZero)
{
  for (const std::string temperature : {"300 - 400*t", "300/(t - 1)"})
    {
      auto     lines = hot("log-strain elastic", temperature);
      Model<2> model(law_scene("plane strain", lines), {"Time/Time step=1"});
      EXPECT_THROW(model.begin_step(), ComputationError) << temperature;
    }
}
