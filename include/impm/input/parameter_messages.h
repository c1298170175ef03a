#ifndef impm_input_parameter_messages_h
#define impm_input_parameter_messages_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace impm
{
  /** A `subsection` or `set` in the text of a parameter file. */
  struct ParameterLine
  {
    std::vector<std::string> path;
    unsigned int             number;
    bool                     is_subsection;
  };

  std::vector<ParameterLine>
  lines_of(const std::string &text);

  /** All that is declared, as the text of a parameter file. */
  std::string
  text_of(const dealii::ParameterHandler &prm);

  /** Whether a number has fewer digits than others since it is so small, which
   * deal.II does not convert. */
  bool
  is_too_small(const std::string &number);

  /** Whether a section cannot have this name, since '/' stands between names.
   */
  bool
  is_path(const std::string &name);

  /** A line of a file, or an override ("--set ..."), which has but one. */
  std::string
  place_of(const std::string &file, unsigned int line);

  /** Without its middle if it is so long that nobody would read it, and that
   * std::regex, which calls itself for every letter, would run out of stack. */
  std::string
  abridged(std::string message);

  /**
   * What ParameterHandler says of a text that it cannot read, in the words of
   * this program: file, line, entry, what was found, what is allowed.
   */
  std::string
  describe_error(const dealii::ExceptionBase    &exception,
                 const std::string              &text,
                 const dealii::ParameterHandler &prm);

  /**
   * Every entry that some scene can have, with default, range, unit and
   * meaning. Lists of names show one item of each kind.
   */
  std::string
  parameter_listing();
} // namespace impm

#endif
