#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/materials/material.h>

namespace impm
{
  void
  Material::declare_density(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Density",
                      "1000",
                      dealii::Patterns::Double(1e-300),
                      "Density before any deformation (kg/m^3), positive.");
  }
} // namespace impm
