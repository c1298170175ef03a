#ifndef impm_study_study_runner_h
#define impm_study_study_runner_h

#include <impm/app/command_line.h>
#include <impm/input/parameter_file.h>

namespace impm
{
  /**
   * Runs the section Study of a file, or lists its runs when told to check.
   * Each run is a process of its own, so that none can end the study; those
   * that the output directory holds already are not repeated. Throws
   * InputError, before anything runs, if a combination is no scene, and
   * ComputationError when no run went to its end. Only where MPI has not been
   * started.
   */
  void
  run_study(const CommandLine &line, ParameterFile &file);
} // namespace impm

#endif
