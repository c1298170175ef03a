#ifndef impm_materials_number_list_h
#define impm_materials_number_list_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>

#include <string>
#include <vector>

namespace impm
{
  // Entries that are numbers between commas, as many as there are terms.

  inline void
  declare_number_list(dealii::ParameterHandler            &prm,
                      const std::string                   &entry,
                      const std::string                   &fallback,
                      const dealii::Patterns::PatternBase &number,
                      const std::string                   &documentation)
  {
    prm.declare_entry(entry,
                      fallback,
                      dealii::Patterns::List(number),
                      documentation);
  }

  inline std::vector<double>
  number_list(const dealii::ParameterHandler &prm, const std::string &entry)
  {
    return dealii::Utilities::string_to_double(
      dealii::Utilities::split_string_list(prm.get(entry)));
  }

  /** Two lists that belong together: throws InputError, which blames the
   * second one, when one is longer than the other. */
  inline void
  require_same_length(const dealii::ParameterHandler &prm,
                      const std::string              &first,
                      const std::string              &second)
  {
    const auto n = number_list(prm, first).size();
    if (number_list(prm, second).size() != n)
      throw InputError(second,
                       "found '" + prm.get(second) + "', allowed are " +
                         std::to_string(n) + " numbers, as many as in '" +
                         first + "' = " + prm.get(first));
  }
} // namespace impm

#endif
