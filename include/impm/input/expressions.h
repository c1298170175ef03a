#ifndef impm_input_expressions_h
#define impm_input_expressions_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <deal.II/lac/vector.h>

#include <impm/base/exceptions.h>

#include <iostream>
#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <string>

namespace impm
{
  /**
   * Reads an entry with expressions between semicolons, in x, y, z (or in t
   * alone when n_variables = 1), in t if wanted, and in named constants. Null
   * when the entry is empty. Throws InputError with the entry's bare name for
   * a wrong number of expressions or one that cannot be evaluated. With `held`,
   * the word `free` may stand for one, which is 0 then, and not held.
   */
  template <int n_variables>
  std::shared_ptr<dealii::FunctionParser<n_variables>>
  read_expressions(const dealii::ParameterHandler      &prm,
                   const std::string                   &entry,
                   const unsigned int                   n_components,
                   const bool                           with_time,
                   const std::map<std::string, double> &constants,
                   bool                                *held = nullptr)
  {
    using Parser           = dealii::FunctionParser<n_variables>;
    const std::string text = prm.get(entry);
    if (text.empty())
      return nullptr;
    auto expressions = dealii::Utilities::split_string_list(text, ';');
    if (expressions.size() != n_components)
      throw InputError(entry,
                       "found '" + text + "', allowed " +
                         (n_components == 1 ?
                            "is one expression" :
                            "are " + std::to_string(n_components) +
                              " expressions between semicolons"));

    for (unsigned int c = 0; held != nullptr && c < n_components; ++c)
      if (expressions[c] == "free")
        {
          held[c]        = false;
          expressions[c] = "0";
        }

    const std::string variables =
      n_variables == 1 ?
        "t" :
        Parser::default_variable_names() + (with_time ? ",t" : "");
    const auto function = std::make_shared<Parser>(n_components);

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
        dealii::Vector<double> value(n_components);
        function->vector_value(dealii::Point<n_variables>(), value);
      }
    catch (const dealii::ExceptionBase &exception)
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
    const auto said =
      dealii::Utilities::split_string_list(flaw.str(), "said: ");
    if (!said.empty())
      throw InputError(entry,
                       "found '" + text + "', allowed are expressions in " +
                         variables + " and the constants: " +
                         dealii::Utilities::trim(said.back()));
    return function;
  }

  /** Whether any of the expressions of a function names one of these words: a
   * function that names no place has one value everywhere. */
  template <int n_variables>
  bool
  names_any_of(const dealii::FunctionParser<n_variables> &function,
               const std::string                         &words)
  {
    const std::regex word("\\b(" + words + ")\\b");
    for (const auto &expression : function.get_expressions())
      if (std::regex_search(expression, word))
        return true;
    return false;
  }

  /** Whether it has one value everywhere. */
  template <int n_variables>
  bool
  is_uniform(const dealii::FunctionParser<n_variables> &function)
  {
    return !names_any_of(function, "x|y|z|rand|rand_seed");
  }
} // namespace impm

#endif
