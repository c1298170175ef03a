#ifndef impm_app_command_line_h
#define impm_app_command_line_h

#include <string>
#include <vector>

namespace impm
{
  /** What the user asked for on the command line. */
  struct CommandLine
  {
    enum class Verbosity
    {
      quiet,
      normal,
      verbose
    };

    std::string              answer; ///< to --help and the like; nothing is run
    bool                     check   = false; ///< but do not run
    bool                     study   = false; ///< of the Study section
    bool                     restart = false; ///< from the last checkpoint
    bool                     goes_on = false; ///< likewise, if there is one
    std::string              listing; ///< of parameters: its form, or empty
    Verbosity                verbosity = Verbosity::normal;
    std::string              parameter_file;
    std::string              output_directory; ///< empty: the file's own
    std::vector<std::string> overrides;
  };

  /** Throws InputError when the words are not of the form that --help shows. */
  CommandLine
  parse_command_line(int argc, const char *const *argv);
} // namespace impm

#endif
