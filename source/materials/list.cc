#include <deal.II/base/patterns.h>

#include <impm/base/names.h>
#include <impm/materials/hardening/list.h>
#include <impm/materials/jaumann_law.h>
#include <impm/materials/linear_law.h>
#include <impm/materials/list.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_viscoelastic.h>
#include <impm/materials/log_strain_von_mises.h>
#include <impm/materials/neo_hookean.h>
#include <impm/materials/newtonian_fluid.h>
#include <impm/materials/ogden.h>
#include <impm/materials/orthotropic_elastic.h>
#include <impm/materials/soil/cam_clay.h>
#include <impm/materials/soil/frictional_law.h>

namespace impm
{
  namespace
  {
    void
    declare_density(dealii::ParameterHandler &prm)
    {
      prm.declare_entry("Density",
                        "1000",
                        dealii::Patterns::Double(1e-300),
                        "Density before any deformation (kg/m^3), positive; "
                        "to be given.");
    }

    /**
     * A law and the parameters that its constructor takes, which declare their
     * entries and read them back.
     */
    template <typename Law, typename Parameters>
    MaterialEntry
    law(const std::string &name, const bool locks = false)
    {
      return {name,
              [](dealii::ParameterHandler &prm, const Chosen &chosen) {
                Parameters::declare_parameters(prm, chosen);
                declare_density(prm);
              },
              [](dealii::ParameterHandler &prm,
                 const MaterialSpec       &spec,
                 PointLayout              &history) {
                return std::make_unique<Law>(spec,
                                             history,
                                             Parameters::from_parameters(prm));
              },
              locks};
    }

    /** A law of soil, which tears rather than be a sheet. */
    template <typename Law>
    MaterialEntry
    soil(const std::string &name)
    {
      auto entry         = law<Law, typename Law::Parameters>(name);
      entry.makes_sheets = false;
      return entry;
    }

    /** The name of the hardening and the entries of that one alone. */
    void
    declare_hardening(dealii::ParameterHandler &prm, const Chosen &chosen)
    {
      std::vector<std::string> names;
      Hardenings::for_each(
        [&](const auto type) { names.push_back(decltype(type)::type::name); });
      prm.declare_entry("Hardening",
                        names.front(),
                        dealii::Patterns::Selection(join(names, "|")),
                        "How the yield stress changes.");
      const std::string name = chosen("Hardening", names.front());
      Hardenings::for_each([&](const auto type) {
        using Hardening = typename decltype(type)::type;
        if (name == Hardening::name)
          Hardening::Parameters::declare_parameters(prm, chosen);
      });
    }

    /** A law with a yield stress, one for each hardening. */
    template <template <typename> class Law>
    MaterialEntry
    law_that_yields(const std::string &name, const bool locks = false)
    {
      return {name,
              [](dealii::ParameterHandler &prm, const Chosen &chosen) {
                ElasticConstants::declare_parameters(prm, chosen);
                declare_density(prm);
                declare_hardening(prm, chosen);
              },
              [](dealii::ParameterHandler &prm,
                 const MaterialSpec       &spec,
                 PointLayout              &history) {
                std::unique_ptr<const Material> material;
                Hardenings::for_each([&](const auto type) {
                  using Hardening = typename decltype(type)::type;
                  if (prm.get("Hardening") == Hardening::name)
                    material = std::make_unique<Law<Hardening>>(
                      spec,
                      history,
                      ElasticConstants::from_parameters(prm),
                      Hardening::Parameters::from_parameters(prm));
                });
                return material;
              },
              locks};
    }
  } // namespace

  const std::vector<MaterialEntry> &
  material_list()
  {
    static const std::vector<MaterialEntry> list = {
      law<LogStrainElastic, ElasticConstants>("log-strain elastic"),
      law_that_yields<LogStrainVonMises>("log-strain von Mises", true),
      law<NeoHookean<false>, ElasticConstants>("neo-Hookean"),
      law<NeoHookean<true>, ElasticPair>("decoupled neo-Hookean"),
      law<Ogden, Ogden::Parameters>("Ogden"),
      law<Ogden, MooneyRivlin>("Mooney-Rivlin"),
      law<LogStrainViscoelastic, LogStrainViscoelastic::Parameters>(
        "log-strain viscoelastic"),
      law<OrthotropicElastic, OrthotropicConstants>("orthotropic elastic"),
      law<LinearLaw<NoYield>, ElasticConstants>("linear elastic"),
      law_that_yields<LinearLaw>("linear von Mises"),
      law<JaumannLaw<NoYield>, ElasticConstants>("Jaumann elastic"),
      law_that_yields<JaumannLaw>("Jaumann von Mises"),
      soil<FrictionalLaw<DruckerPrager>>("log-strain Drucker-Prager"),
      soil<FrictionalLaw<MohrCoulomb>>("log-strain Mohr-Coulomb"),
      soil<CamClay>("modified Cam-clay"),
      law<NewtonianFluid, NewtonianFluid::Parameters>("Newtonian fluid", true)};
    return list;
  }
} // namespace impm
