#include <impm/materials/list.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_von_mises.h>
#include <impm/materials/neo_hookean.h>

namespace impm
{
  const std::vector<MaterialEntry> &
  material_list()
  {
    static const std::vector<MaterialEntry> list = {
      {"log-strain elastic",
       "Isotropic elasticity, quadratic in the logarithmic strains (Hencky).",
       &LogStrainElastic::declare_parameters,
       &LogStrainElastic::create},
      {"log-strain von Mises",
       "The same below a yield limit on the von Mises stress, with isochoric "
       "plastic flow and linear isotropic hardening.",
       &LogStrainVonMises::declare_parameters,
       &LogStrainVonMises::create},
      {"neo-Hookean",
       "Isotropic elasticity, tau = G (b - 1) + lambda ln J 1.",
       &CoupledNeoHookean::declare_parameters,
       &CoupledNeoHookean::create},
      {"decoupled neo-Hookean",
       "Isotropic elasticity, tau = G J^(-2/3) dev b + K ln J 1 (Guilkey & "
       "Weiss 2003, eq. 20).",
       &DecoupledNeoHookean::declare_parameters,
       &DecoupledNeoHookean::create,
       &ElasticConstants::declare_chosen}};
    return list;
  }
} // namespace impm
