#ifndef impm_input_sections_heat_h
#define impm_input_sections_heat_h

#include <impm/input/sections/boundary_conditions.h>
#include <impm/input/sections/contact.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** What heats and cools the bodies from outside, where heat is conducted. */
  template <int dim>
  struct HeatSpec
  {
    bool is_conducted = false; ///< in any body

    /** Of each face of the domain (K), in (x, t); null: insulated. */
    std::array<std::shared_ptr<dealii::FunctionParser<dim>>, 2 * dim>
      temperatures;
    /** (W/kg) in (x, t), or null. */
    std::shared_ptr<dealii::FunctionParser<dim>> source;
  };

  /** Warns of bodies that meet and exchange no heat. */
  template <int dim>
  void
  add_heat(const Section            &top,
           HeatSpec<dim>            &heat,
           const Bodies<dim>        &bodies,
           const ContactSpec        &contact,
           std::vector<std::string> &warnings);
} // namespace impm

#endif
