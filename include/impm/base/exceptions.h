#ifndef impm_base_exceptions_h
#define impm_base_exceptions_h

#include <stdexcept>
#include <string>

namespace impm
{
  /**
   * The input cannot be used: the program ends with exit code 1 and has
   * written nothing. Thrown on every rank alike.
   */
  struct InputError : std::runtime_error
  {
    InputError(const std::string &entry, const std::string &message)
      : std::runtime_error(message)
      , entry(entry)
    {}

    /**
     * The full path of the entry to blame ("Materials/steel/Poisson ratio"),
     * or empty when it is no single one; ParameterFile::describe() finds file
     * and line.
     */
    const std::string entry;
  };

  /**
   * The computation cannot go on: the last good state is saved and the
   * program ends with exit code 2. Thrown on every rank alike.
   */
  struct ComputationError : std::runtime_error
  {
    explicit ComputationError(const std::string &message,
                              const std::string &entry = "")
      : std::runtime_error(message)
      , entry(entry)
    {}

    /** To blame, as in InputError, or empty. */
    const std::string entry;
  };

  /** A signal has asked to stop, and what there is is saved: exit code 128 +
   * the signal's number. Thrown on every rank alike. */
  struct Interruption : std::runtime_error
  {
    Interruption(const int          signal,
                 const std::string &message,
                 const bool         has_checkpoint = true)
      : std::runtime_error(message)
      , signal(signal)
      , has_checkpoint(has_checkpoint)
    {}

    const int  signal;
    const bool has_checkpoint; ///< else what goes on does so by itself
  };

  /** A linear solve has nothing to go on with: Newton's method gives up. */
  struct LinearizationError : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /** The system failed (disk, memory): exit code 3. */
  struct SystemError : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };
} // namespace impm

#endif
