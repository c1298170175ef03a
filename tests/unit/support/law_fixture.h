#ifndef impm_tests_unit_law_fixture_h
#define impm_tests_unit_law_fixture_h

#include <deal.II/base/parameter_handler.h>

#include <impm/materials/failure.h>
#include <impm/materials/list.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_viscoelastic.h>
#include <impm/materials/neo_hookean.h>
#include <impm/materials/newtonian_fluid.h>
#include <impm/materials/ogden.h>
#include <impm/materials/orthotropic_elastic.h>
#include <impm/materials/soil/cam_clay.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  inline const auto unit_elasticity = ElasticConstants::from_young(1., 0.3);

  /** A law of density 1 and what it keeps at a point. */
  struct NamedLaw
  {
    std::string                     name;
    std::shared_ptr<const Material> law;
    PointLayout                     history;
  };

  template <typename Law, typename... Parameters>
  NamedLaw
  make_law(const std::string &name,
           const GeometryKind geometry,
           const Parameters &...parameters)
  {
    PointLayout history(geometry);
    const auto  law =
      std::make_shared<Law>(MaterialSpec{1.}, history, parameters...);
    return {name, law, history};
  }

  using Entries = std::map<std::string, std::string>;

  /** A law of the program, from its entries, which adds to a history;
   * elasticity is the unit one. */
  inline std::unique_ptr<const Material>
  make_listed(const std::string  &name,
              const Entries      &entries,
              const MaterialSpec &spec,
              PointLayout        &history)
  {
    const auto &list = material_list();
    const auto law = std::find_if(list.begin(), list.end(), [&](const auto &l) {
      return l.name == name;
    });
    dealii::ParameterHandler prm;
    law->declare(prm,
                 [&](const std::string &entry, const std::string &fallback) {
                   const auto found = entries.find(entry);
                   return found == entries.end() ? fallback : found->second;
                 });
    prm.declare_entry("Specific heat", "");
    prm.declare_entry("Prescribed temperature", "");
    prm.set("Young's modulus", "1");
    for (const auto &[entry, value] : entries)
      prm.set(entry, value);
    return law->create(prm, spec, history);
  }

  inline NamedLaw
  listed_law(const std::string  &name,
             const Entries      &entries,
             const GeometryKind  geometry = GeometryKind::three_d,
             const MaterialSpec &spec     = {1.})
  {
    PointLayout                           history(geometry);
    const std::shared_ptr<const Material> material =
      make_listed(name, entries, spec, history);
    const auto hardening = entries.find("Hardening");
    return {hardening == entries.end() ? name : name + ", " + hardening->second,
            material,
            history};
  }

  /** Logarithmic strains and von Mises, of points that fail. */
  inline NamedLaw
  failing_law(const Entries       &entries,
              const FailureStrain &failure_strain,
              const double         remaining_share,
              const GeometryKind   geometry = GeometryKind::three_d,
              const std::string   &law      = "log-strain von Mises")
  {
    PointLayout history(geometry);
    auto        whole    = make_listed(law, entries, {1.}, history);
    const auto  material = std::make_shared<FailingLaw>(std::move(whole),
                                                       history,
                                                       failure_strain,
                                                       remaining_share);
    return {law + " that fails", material, history};
  }

  /** Hardenings that yield early, in units of Young's modulus. */
  inline std::vector<Entries>
  all_hardenings()
  {
    std::vector<Entries> list = {{{"Hardening", "linear"},
                                  {"Hardening modulus", "0.1"}},
                                 {{"Hardening", "bilinear"},
                                  {"Hardening modulus", "0.1"},
                                  {"Limit strain", "0.01"},
                                  {"Softening modulus", "0.2"}},
                                 {{"Hardening", "Voce"},
                                  {"Hardening modulus", "0.1"},
                                  {"Saturation stress", "0.03"},
                                  {"Saturation rate", "5"}},
                                 {{"Hardening", "Swift"},
                                  {"Reference strain", "0.05"},
                                  {"Hardening exponent", "0.3"}},
                                 {{"Hardening", "Ludwik"},
                                  {"Strength coefficient", "0.03"},
                                  {"Hardening exponent", "0.4"}},
                                 {{"Hardening", "Johnson-Cook"},
                                  {"Strength coefficient", "0.03"},
                                  {"Hardening exponent", "0.4"},
                                  {"Rate coefficient", "0.1"},
                                  {"Reference rate", "0.001"},
                                  {"Specific heat", "1"},
                                  {"Reference temperature", "0.9"},
                                  {"Melting temperature", "1.5"},
                                  {"Thermal exponent", "0.8"}}};
    for (auto &hardening : list)
      hardening["Yield stress"] = "0.01";
    list.push_back(
      {{"Hardening", "table"},
       {"Yield stresses", "0 0.01; 0.004 0.015; 0.3 0.02; 0.5 0.01"}});
    return list;
  }

  /** With a specific heat and a temperature that softens at once. */
  inline const MaterialSpec warm = [] {
    MaterialSpec spec{1.};
    spec.specific_heat       = 1;
    spec.initial_temperature = 1;
    spec.heating_share       = 0.9;
    return spec;
  }();

  /** Rubber of the unit elasticity, with terms of both signs. */
  inline const Ogden::Parameters unit_rubber = {
    {{unit_elasticity.shear * 1.6 / 1.3, 1.3},
     {unit_elasticity.shear * 0.1 / 4., 4.},
     {unit_elasticity.shear * 0.3 / -2., -2.}},
    unit_elasticity.bulk};

  /** Two branches, one faster and one slower than a step of 0.5 s. */
  inline const LogStrainViscoelastic::Parameters unit_viscoelasticity = {
    ElasticConstants::from_young(0.5, 0.3), {{0.2, 0.1}, {0.1, 2.}}, 0.};

  inline const LogStrainViscoelastic::Parameters unit_dashpots = {
    unit_viscoelasticity.elasticity, unit_viscoelasticity.branches, 0.05};

  inline OrthotropicConstants
  orthotropic_constants(const Entries &entries)
  {
    dealii::ParameterHandler prm;
    OrthotropicConstants::declare_parameters(prm, {});
    for (const auto &[entry, value] : entries)
      prm.set(entry, value);
    return OrthotropicConstants::from_parameters(prm);
  }

  /** Stiff along axis 1, which is askew in the plane. */
  inline const Entries lamina = {{"Young's moduli", "1, 0.3, 0.4"},
                                 {"Poisson's ratios", "0.3, 0.4, 0.25"},
                                 {"Shear moduli", "0.2, 0.15, 0.25"},
                                 {"First axis", "0.8, 0.6, 0"}};

  inline const std::vector<std::string> laws_that_yield = {
    "log-strain von Mises", "linear von Mises", "Jaumann von Mises"};

  /** Every kind of law, of stiffness 1, which yields early if it yields. */
  inline std::vector<NamedLaw>
  all_solids(const GeometryKind g = GeometryKind::three_d)
  {
    const auto           &c    = unit_elasticity;
    std::vector<NamedLaw> laws = {
      make_law<LogStrainElastic>("log-strain elastic", g, c),
      make_law<NeoHookean<false>>("neo-Hookean", g, c),
      make_law<NeoHookean<true>>("decoupled neo-Hookean", g, c),
      listed_law("linear elastic", {}, g),
      listed_law("Jaumann elastic", {}, g)};
    for (const auto &law : laws_that_yield)
      for (const auto &hardening : all_hardenings())
        laws.push_back(listed_law(law, hardening, g, warm));
    for (const auto &law : laws_that_yield)
      laws.push_back(failing_law({{"Yield stress", "0.01"}},
                                 FailureStrain{0.03, 0.2, -1., 0.1},
                                 0.1,
                                 g,
                                 law));
    laws.push_back(make_law<Ogden>("Ogden", g, unit_rubber));
    laws.push_back(make_law<OrthotropicElastic>("orthotropic elastic",
                                                g,
                                                orthotropic_constants(lamina)));
    for (const auto &parameters : {unit_viscoelasticity, unit_dashpots})
      laws.push_back(make_law<LogStrainViscoelastic>(
        parameters.viscosity > 0 ? "dashpots" : "branches", g, parameters));
    return laws;
  }

  inline NamedLaw
  fluid_law(const double K, const double mu, const double lambda)
  {
    return make_law<NewtonianFluid>("Newtonian fluid",
                                    GeometryKind::three_d,
                                    NewtonianFluid::Parameters{K, mu, lambda});
  }

  /** Soils of the unit elasticity, whose flow is associated or not. */
  inline std::vector<NamedLaw>
  all_soils(const GeometryKind g = GeometryKind::three_d)
  {
    std::vector<NamedLaw> laws;
    for (const std::string name :
         {"log-strain Drucker-Prager", "log-strain Mohr-Coulomb"})
      for (const bool associated : {true, false})
        {
          Entries entries = {{"Cohesion", "0.01"},
                             {"Dilation angle", associated ? "30" : "10"}};
          if (!associated)
            entries["Tension cut-off"] = "0.005";
          laws.push_back(listed_law(name, entries, g));
          laws.back().name += associated ? ", associated" : ", cut off";
        }
    laws.push_back(
      make_law<CamClay>("modified Cam-clay",
                        g,
                        CamClay::Parameters{0.3, 0.35, 0.3, 0.6, 0.4, 1.}));
    return laws;
  }

  inline std::vector<NamedLaw>
  all_laws()
  {
    auto laws = all_solids();
    laws.push_back(fluid_law(1., 0.3, -0.1));
    for (const auto &law : all_soils())
      laws.push_back(law);
    return laws;
  }

  /** A point of a law: its F, its history, and a trial step. */
  class LawPoint
  {
  public:
    explicit LawPoint(const NamedLaw &named, const double dt = 0.5)
      : law(*named.law)
      , layout(named.history)
      , dt(dt)
      , history(layout.size())
      , trial_history(layout.size())
    {
      law.initialize_history(history.data());
      for (unsigned int d = 0; d < 3; ++d)
        F[d][d] = 1;
    }

    bool
    evaluate(const dealii::Tensor<2, 3> &increment)
    {
      trial_F = increment * F;
      volume  = dealii::determinant(
        law.form() == Material::Form::linearized ? F : trial_F);
      return law.evaluate_one(
        {increment, trial_F, dt, history.data(), trial_history.data()},
        true,
        response);
    }

    void
    commit()
    {
      F       = trial_F;
      history = trial_history;
    }

    dealii::SymmetricTensor<2, 3>
    cauchy_stress() const
    {
      return response.kirchhoff_stress / volume;
    }

    double
    plastic_strain() const
    {
      return layout.find("equivalent_plastic_strain") ?
               history[layout.offset("equivalent_plastic_strain")] :
               0.;
    }

    const Material      &law;
    const PointLayout    layout;
    double               dt;
    double               volume = 1; ///< that the stress is over
    std::vector<double>  history, trial_history;
    dealii::Tensor<2, 3> F, trial_F;
    Material::Response   response;
  };
} // namespace impm

#endif
