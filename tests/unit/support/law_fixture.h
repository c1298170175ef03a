#ifndef impm_tests_unit_law_fixture_h
#define impm_tests_unit_law_fixture_h

#include <impm/materials/jaumann_law.h>
#include <impm/materials/linear_law.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_von_mises.h>
#include <impm/materials/neo_hookean.h>
#include <impm/materials/newtonian_fluid.h>

#include <memory>
#include <string>
#include <vector>

namespace impm
{
  inline const ElasticConstants unit_elasticity(1., 0.3);

  /** Every kind of law, of stiffness 1, which yields early if it yields. */
  struct NamedLaw
  {
    std::string               name;
    std::shared_ptr<Material> law;
  };

  inline std::vector<NamedLaw>
  all_solids()
  {
    const BilinearHardening hardening(0.01, 0.1),
      softening(0.01, 0.1, 0.01, 0.2);
    return {
      {"log-strain elastic",
       std::make_shared<LogStrainElastic>(HenckyElasticity(1., 0.3), 1.)},
      {"log-strain von Mises",
       std::make_shared<LogStrainVonMises>(
         HenckyElasticity(1., 0.3), 1., 0.01, 0.1)},
      {"neo-Hookean", std::make_shared<CoupledNeoHookean>(unit_elasticity, 1.)},
      {"decoupled neo-Hookean",
       std::make_shared<DecoupledNeoHookean>(unit_elasticity, 1.)},
      {"linear elastic", std::make_shared<LinearLaw>(unit_elasticity, 1.)},
      {"linear von Mises",
       std::make_shared<LinearLaw>(unit_elasticity, 1., hardening)},
      {"linear, softening",
       std::make_shared<LinearLaw>(unit_elasticity, 1., softening)},
      {"Jaumann elastic", std::make_shared<JaumannLaw>(unit_elasticity, 1.)},
      {"Jaumann von Mises",
       std::make_shared<JaumannLaw>(unit_elasticity, 1., hardening)},
      {"Jaumann, softening",
       std::make_shared<JaumannLaw>(unit_elasticity, 1., softening)}};
  }

  inline std::vector<NamedLaw>
  all_laws()
  {
    auto laws = all_solids();
    laws.push_back(
      {"Newtonian fluid", std::make_shared<NewtonianFluid>(1., 0.3, -0.1, 1.)});
    return laws;
  }

  /** A point of a law: its F, its history, and a trial step. */
  class LawPoint
  {
  public:
    explicit LawPoint(Material          &law,
                      const GeometryKind geometry = GeometryKind::three_d,
                      const double       dt       = 0.5)
      : law(law)
      , layout(geometry)
      , dt(dt)
    {
      law.declare_history(layout);
      history.resize(layout.size());
      trial_history.resize(layout.size());
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
      return law.evaluate({increment, trial_F, dt},
                          history.data(),
                          trial_history.data(),
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
      return layout.has("equivalent_plastic_strain") ?
               history[layout.offset("equivalent_plastic_strain")] :
               0.;
    }

    Material            &law;
    PointLayout          layout;
    double               dt;
    double               volume = 1; ///< that the stress is over
    std::vector<double>  history, trial_history;
    dealii::Tensor<2, 3> F, trial_F;
    Material::Response   response;
  };
} // namespace impm

#endif
