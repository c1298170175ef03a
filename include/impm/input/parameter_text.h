#ifndef impm_input_parameter_text_h
#define impm_input_parameter_text_h

#include <string>
#include <vector>

namespace impm
{
  /** A `subsection` or `set` of a parameter file, or an override. */
  struct ParameterLine
  {
    std::vector<std::string> path;
    bool                     is_subsection;
    std::string              value;  ///< that is set
    std::string              file;   ///< or "--set ..."
    unsigned int             number; ///< of the line; 0: of an override

    /** "file name, line 3", or the override. */
    std::string
    place() const;
  };

  using ParameterLines = std::vector<ParameterLine>;

  /**
   * What a parameter file says, with the files that it includes in their
   * places and lines that end in '\' as one with those after them. Paths, of
   * `include` and of entries called 'File', are relative to the file that has
   * them; those of entries become absolute. Throws InputError, whose message
   * has file and line, for what is no such text.
   */
  ParameterLines
  read_parameter_text(const std::string &file_name);

  /** The same of a text that includes nothing; `name` is for messages. */
  ParameterLines
  parameter_lines(const std::string &text, const std::string &name = "");

  /** Of "Section/Name=value". A path that it gives is relative to the parameter
   * file or, if nothing is there, to the working directory. */
  ParameterLine
  parameter_override(const std::string &override, const std::string &file_name);

  /** Whether a number has fewer digits than others since it is so small, which
   * deal.II does not convert. */
  bool
  is_too_small(const std::string &number);

  /** Without its middle if it is so long that nobody would read it. */
  std::string
  abridged(std::string message);
} // namespace impm

#endif
