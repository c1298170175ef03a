#ifndef impm_tests_unit_law_fixture_h
#define impm_tests_unit_law_fixture_h

#include <impm/materials/jaumann_law.h>
#include <impm/materials/linear_law.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_von_mises.h>
#include <impm/materials/neo_hookean.h>
#include <impm/materials/newtonian_fluid.h>

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

  /** Every kind of law, of stiffness 1, which yields early if it yields. */
  inline std::vector<NamedLaw>
  all_solids(const GeometryKind g = GeometryKind::three_d)
  {
    const auto              &c = unit_elasticity;
    const LinearHardening    linear{0.01, 0.1};
    const RateLaw::Hardening hardening(std::in_place, linear),
      softening(std::in_place, linear, 0.01, 0.2);
    return {make_law<LogStrainElastic>("log-strain elastic", g, c),
            make_law<LogStrainVonMises>("log-strain von Mises",
                                        g,
                                        c,
                                        SaturatingHardening{linear, 0.02, 5.}),
            make_law<NeoHookean<false>>("neo-Hookean", g, c),
            make_law<NeoHookean<true>>("decoupled neo-Hookean", g, c),
            make_law<LinearLaw>("linear elastic", g, c),
            make_law<LinearLaw>("linear von Mises", g, c, hardening),
            make_law<LinearLaw>("linear, softening", g, c, softening),
            make_law<JaumannLaw>("Jaumann elastic", g, c),
            make_law<JaumannLaw>("Jaumann von Mises", g, c, hardening),
            make_law<JaumannLaw>("Jaumann, softening", g, c, softening)};
  }

  inline NamedLaw
  fluid_law(const double K, const double mu, const double lambda)
  {
    return make_law<NewtonianFluid>("Newtonian fluid",
                                    GeometryKind::three_d,
                                    NewtonianFluid::Parameters{K, mu, lambda});
  }

  inline std::vector<NamedLaw>
  all_laws()
  {
    auto laws = all_solids();
    laws.push_back(fluid_law(1., 0.3, -0.1));
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
