#ifndef impm_input_sections_general_h
#define impm_input_sections_general_h

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>

// As in every section: `declare_...` and `read_...` go into the section and
// come back; what they throw is an InputError with the path of an entry.

namespace impm
{
  /** Numbers that have names in the expressions of a file. */
  using Constants = std::map<std::string, double>;

  struct GeneralSpec
  {
    std::string title;
    Constants   constants;
  };

  void
  declare_general(dealii::ParameterHandler &prm);

  GeneralSpec
  read_general(dealii::ParameterHandler &prm);
} // namespace impm

#endif
