#ifndef impm_input_sections_loads_h
#define impm_input_sections_loads_h

#include <deal.II/base/function_parser.h>

#include <impm/input/parameter_file.h>
#include <impm/input/sections/bodies.h>
#include <impm/input/sections/general.h>

#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** A force on the points of one layer at the surface of a body. */
  template <int dim>
  struct TractionSpec
  {
    std::string  name;
    std::string  body;
    unsigned int normal; ///< direction across the layer
    /** Positive at the initial places of the points that carry it. */
    std::shared_ptr<dealii::FunctionParser<dim>> where;
    /** Force per initial area (Pa) in (x, t). */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    bool is_initial = false; ///< `value` is a function of initial places
  };

  template <int dim>
  using Tractions = std::vector<TractionSpec<dim>>;

  template <int dim>
  struct LoadsSpec
  {
    std::shared_ptr<dealii::FunctionParser<dim>> body_force; ///< N/kg, or null
    bool body_force_is_initial = false; ///< a function of initial places
    Tractions<dim> tractions;           ///< on points
  };

  void
  declare_loads(dealii::ParameterHandler    &prm,
                const ParameterFile::Chosen &chosen);

  template <int dim>
  LoadsSpec<dim>
  read_loads(dealii::ParameterHandler &prm,
             bool                      lagrangian,
             const Constants          &constants);

  /** Whether tractions name deformable bodies. */
  template <int dim>
  void
  check_loads(const LoadsSpec<dim> &loads, const Bodies<dim> &bodies);
} // namespace impm

#endif
