#include <deal.II/base/patterns.h>

#include <impm/materials/jaumann_law.h>
#include <impm/materials/linear_law.h>
#include <impm/materials/list.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_von_mises.h>
#include <impm/materials/neo_hookean.h>
#include <impm/materials/newtonian_fluid.h>

namespace impm
{
  namespace
  {
    /**
     * A law and the groups of parameters that its constructor takes: each
     * declares its entries and reads them back.
     */
    template <typename Law, typename Elasticity, typename... Others>
    MaterialEntry
    law(const std::string &name, const bool locks = false)
    {
      return {name,
              [](dealii::ParameterHandler    &prm,
                 const ParameterFile::Chosen &chosen) {
                Elasticity::declare_parameters(prm, chosen);
                prm.declare_entry("Density",
                                  "1000",
                                  dealii::Patterns::Double(1e-300),
                                  "Density before any deformation (kg/m^3), "
                                  "positive.");
                (Others::declare_parameters(prm, chosen), ...);
              },
              [](dealii::ParameterHandler &prm,
                 const MaterialSpec       &spec,
                 PointLayout              &history) {
                return std::make_unique<Law>(spec,
                                             history,
                                             Elasticity::from_parameters(prm),
                                             Others::from_parameters(prm)...);
              },
              locks};
    }
  } // namespace

  const std::vector<MaterialEntry> &
  material_list()
  {
    static const std::vector<MaterialEntry> list = {
      law<LogStrainElastic, ElasticConstants>("log-strain elastic"),
      law<LogStrainVonMises, ElasticConstants, SaturatingHardening>(
        "log-strain von Mises", true),
      law<NeoHookean<false>, ElasticConstants>("neo-Hookean"),
      law<NeoHookean<true>, ElasticPair>("decoupled neo-Hookean"),
      law<LinearLaw, ElasticConstants>("linear elastic"),
      law<LinearLaw, ElasticConstants, BilinearHardening>("linear von Mises"),
      law<JaumannLaw, ElasticConstants>("Jaumann elastic"),
      law<JaumannLaw, ElasticConstants, BilinearHardening>("Jaumann von Mises"),
      law<NewtonianFluid, NewtonianFluid::Parameters>("Newtonian fluid")};
    return list;
  }
} // namespace impm
