#ifndef impm_input_parameter_messages_h
#define impm_input_parameter_messages_h

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <string>
#include <vector>

namespace impm
{
  /**
   * Calls `action` with the path of every `subsection` and `set` in the text
   * of a parameter file, and with its line.
   */
  void
  for_each_entry(const std::string                             &text,
                 const std::function<void(const std::vector<std::string> &path,
                                          unsigned int                    line,
                                          bool is_subsection)> &action);

  /**
   * A pattern as a person says it: "[Double 2.22507e-308...MAX_DOUBLE
   * (inclusive)]" is a number greater than 0.
   */
  std::string
  describe_pattern(const std::string &pattern);

  /**
   * What ParameterHandler says of a file that it cannot read, in the words of
   * this program: file, line, entry, what was found, what is allowed.
   * `text` is what was read, `prm` has what is declared.
   */
  std::string
  describe_error(const dealii::ExceptionBase    &exception,
                 const std::string              &text,
                 const dealii::ParameterHandler &prm);
} // namespace impm

#endif
