#include <deal.II/base/utilities.h>

#include <deal.II/lac/vector.h>

#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>

#include <iostream>
#include <sstream>

namespace impm
{
  using namespace dealii;

  template <int n_variables>
  std::shared_ptr<FunctionParser<n_variables>>
  read_expressions(const ParameterHandler              &prm,
                   const std::string                   &entry,
                   const unsigned int                   n_components,
                   const bool                           with_time,
                   const std::map<std::string, double> &constants)
  {
    const std::string text = prm.get(entry);
    if (text.empty())
      return nullptr;
    const auto expressions = Utilities::split_string_list(text, ';');
    if (expressions.size() != n_components)
      throw InputError(entry,
                       "found '" + text + "', allowed " +
                         (n_components == 1 ?
                            "is one expression" :
                            "are " + std::to_string(n_components) +
                              " expressions between semicolons"));

    std::string variables = "t";
    if (n_variables > 1)
      variables = FunctionParser<n_variables>::default_variable_names() +
                  (with_time ? ",t" : "");
    auto function = std::make_shared<FunctionParser<n_variables>>(n_components);

    // deal.II also prints muParser's message before it throws: report it once.
    std::ostringstream printed, flaw;
    const auto         screen = std::cerr.rdbuf(printed.rdbuf());
    try
      {
        function->initialize(variables,
                             expressions,
                             constants,
                             with_time && n_variables > 1);
        // muParser compiles at the first use, which may be on another day.
        Vector<double> value(n_components);
        function->vector_value(Point<n_variables>(), value);
      }
    catch (const ExceptionBase &exception)
      {
        exception.print_info(flaw);
      }
    catch (...)
      {
        // muParser's own exceptions know no base class, and this is the one
        // place where deal.II lets them through.
        flaw << "a constant has a name that cannot stand in expressions";
      }
    std::cerr.rdbuf(screen);

    // Around muParser's message, deal.II calls the error's number a column.
    const auto said = Utilities::split_string_list(flaw.str(), "said: ");
    if (!said.empty())
      throw InputError(entry,
                       "found '" + text + "', allowed are expressions in " +
                         variables +
                         " and the constants: " + Utilities::trim(said.back()));
    return function;
  }

  template std::shared_ptr<FunctionParser<1>>
  read_expressions<1>(const ParameterHandler &,
                      const std::string &,
                      unsigned int,
                      bool,
                      const std::map<std::string, double> &);
  template std::shared_ptr<FunctionParser<2>>
  read_expressions<2>(const ParameterHandler &,
                      const std::string &,
                      unsigned int,
                      bool,
                      const std::map<std::string, double> &);
  template std::shared_ptr<FunctionParser<3>>
  read_expressions<3>(const ParameterHandler &,
                      const std::string &,
                      unsigned int,
                      bool,
                      const std::map<std::string, double> &);
} // namespace impm
