#ifndef impm_base_exceptions_h
#define impm_base_exceptions_h

#include <stdexcept>
#include <string>
#include <utility>

namespace impm
{
  /**
   * The input cannot be used: the program ends with exit code 1 and has
   * written nothing. Thrown on every rank alike.
   *
   * `entry` is the full path of the offending entry ("Materials/steel/Poisson
   * ratio"), or empty when no single entry is to blame; main() turns it into
   * a file and a line.
   */
  class InputError : public std::runtime_error
  {
  public:
    InputError(std::string entry, const std::string &message)
      : std::runtime_error(message)
      , entry(std::move(entry))
    {}

    const std::string entry;
  };

  /**
   * The computation cannot go on: the last good state is saved and the
   * program ends with exit code 2. Thrown on every rank alike.
   */
  class ComputationError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /** A linear solve has nothing to go on with: Newton's method gives up. */
  class LinearizationError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /** The system failed (disk, memory): exit code 3. */
  class SystemError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };
} // namespace impm

#endif
