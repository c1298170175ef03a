#ifndef impm_run_restart_check_h
#define impm_run_restart_check_h

#include <string>

namespace impm
{
  /**
   * Compares the resolved parameters of a checkpoint with those that are to go
   * on from it. How long a run goes on, how steps are solved, what is shown and
   * compared may be another; throws InputError for the first entry that may
   * not, with the value that it had.
   */
  void
  check_restart(const std::string &before, const std::string &now);
} // namespace impm

#endif
