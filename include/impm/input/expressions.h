#ifndef impm_input_expressions_h
#define impm_input_expressions_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <impm/base/exceptions.h>

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace impm
{
  /**
   * Reads an entry with expressions between semicolons, in x, y, z (or in t
   * alone when n_variables = 1), in t if wanted, and in named constants. Null
   * when the entry is empty. Throws InputError with the entry's bare name for
   * a wrong number of expressions, one that cannot be evaluated, or a constant
   * that is not finite. With `held`, the word `free` may stand for one, which
   * is 0 then, and not held. Values that are not finite are remembered, see
   * find_flaw().
   */
  template <int n_variables>
  std::shared_ptr<dealii::FunctionParser<n_variables>>
  read_expressions(const dealii::ParameterHandler      &prm,
                   const std::string                   &entry,
                   unsigned int                         n_components,
                   bool                                 with_time,
                   const std::map<std::string, double> &constants,
                   bool                                *held = nullptr);

  /**
   * The first value of any expression since this was asked last that is not
   * finite, on the first rank that has one: as an error that blames the entry.
   * It is not thrown where it arises, since that may be on one rank alone.
   * Collective.
   */
  std::optional<InputError>
  find_flaw(MPI_Comm communicator);

  /** What other scenes have left. */
  void
  forget_flaw();

  /** While it lives, values that are not finite do not count: a guess where a
   * function may be evaluated. */
  class ExpressionTrial
  {
  public:
    ExpressionTrial();
    ~ExpressionTrial();

    ExpressionTrial(const ExpressionTrial &) = delete;
    ExpressionTrial &
    operator=(const ExpressionTrial &) = delete;

  private:
    const bool was_on;
  };

  /** Whether any of the expressions of a function names one of these words: a
   * function that names no place has one value everywhere. */
  template <int n_variables>
  bool
  names_any_of(const dealii::FunctionParser<n_variables> &function,
               const std::string                         &words);

  /** Whether it has one value everywhere. */
  template <int n_variables>
  bool
  is_uniform(const dealii::FunctionParser<n_variables> &function)
  {
    return !names_any_of(function, "x|y|z|rand|rand_seed");
  }
} // namespace impm

#endif
