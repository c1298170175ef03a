#include <impm/materials/jaumann_law.h>
#include <impm/materials/linear_law.h>
#include <impm/materials/list.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/log_strain_von_mises.h>
#include <impm/materials/neo_hookean.h>
#include <impm/materials/newtonian_fluid.h>

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
       &ElasticConstants::declare_chosen},
      {"linear elastic",
       "Stress rate C : d, linearized about the start of each step (Sulsky & "
       "Kaul 2004, eq. 2.1.8): an elastic step is a linear problem. Not "
       "objective: steps must turn the material little.",
       &RateLaw::declare_elastic,
       &RateLaw::create_elastic<LinearLaw>},
      {"linear von Mises",
       "The same below a yield limit (eq. 2.1.13 to 2.1.19), with linear "
       "hardening and, if asked for, softening.",
       &RateLaw::declare_von_mises,
       &RateLaw::create_von_mises<LinearLaw>,
       &BilinearHardening::declare_chosen},
      {"Jaumann elastic",
       "Jaumann's rate of the Cauchy stress is C : d. Objective; not "
       "symmetric: GMRES or direct.",
       &RateLaw::declare_elastic,
       &RateLaw::create_elastic<JaumannLaw>},
      {"Jaumann von Mises",
       "The same below a yield limit, with linear hardening and, if asked for, "
       "softening.",
       &RateLaw::declare_von_mises,
       &RateLaw::create_von_mises<JaumannLaw>,
       &BilinearHardening::declare_chosen},
      {"Newtonian fluid",
       "Pressure from the density, viscous stress from its rate of strain "
       "(Sulsky & Kaul 2004, eq. 2.1.7). Not symmetric: GMRES or direct.",
       &NewtonianFluid::declare_parameters,
       &NewtonianFluid::create}};
    return list;
  }
} // namespace impm
