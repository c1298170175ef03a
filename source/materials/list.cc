#include <impm/materials/list.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_von_mises.h>

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
       &LogStrainVonMises::create}};
    return list;
  }
} // namespace impm
