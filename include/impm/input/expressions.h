#ifndef impm_input_expressions_h
#define impm_input_expressions_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>

#include <map>
#include <memory>
#include <string>

namespace impm
{
  /**
   * Reads an entry with expressions between semicolons, in x, y, z (or in t
   * alone when n_variables = 1), in t if wanted, and in named constants. Null
   * when the entry is empty. Throws InputError with the entry's bare name for
   * a wrong number of expressions or one that cannot be evaluated.
   */
  template <int n_variables>
  std::shared_ptr<dealii::FunctionParser<n_variables>>
  read_expressions(const dealii::ParameterHandler      &prm,
                   const std::string                   &entry,
                   unsigned int                         n_components,
                   bool                                 with_time,
                   const std::map<std::string, double> &constants);
} // namespace impm

#endif
