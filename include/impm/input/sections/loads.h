#ifndef impm_input_sections_loads_h
#define impm_input_sections_loads_h

#include <impm/input/sections/bodies.h>

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

  template <int dim>
  void
  add_loads(const Section     &top,
            LoadsSpec<dim>    &loads,
            const Bodies<dim> &bodies,
            bool               lagrangian);
} // namespace impm

#endif
