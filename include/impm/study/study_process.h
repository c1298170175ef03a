#ifndef impm_study_study_process_h
#define impm_study_study_process_h

#include <impm/app/command_line.h>
#include <impm/study/study_report.h>

#include <optional>
#include <string>

namespace impm
{
  /**
   * Runs the program as a process of its own, or under mpirun, into a
   * directory, where log.txt has its command and what it said. Whatever
   * becomes of it is a result. MPI must not have been started here: what this
   * process starts could not start it.
   */
  StudyResult
  run_process(const std::string &directory,
              const CommandLine &line,
              const StudyRun    &run);

  /**
   * What an earlier run left in a directory, if it went to its end with these
   * resolved parameters on as many ranks.
   */
  std::optional<StudyResult>
  kept_result(const std::string &directory,
              const std::string &parameters,
              unsigned int       ranks);

  /** Whether mpirun or its like has started this process. */
  bool
  is_started_by_mpi();
} // namespace impm

#endif
