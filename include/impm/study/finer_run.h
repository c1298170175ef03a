#ifndef impm_study_finer_run_h
#define impm_study_finer_run_h

#include <impm/app/command_line.h>
#include <impm/base/files.h>
#include <impm/input/sections/reference.h>

#include <map>

namespace impm
{
  /** What a finer run of a scene has left. */
  struct FinerRun
  {
    CsvTable history;
    double   wall_seconds = 0;
  };

  /** By the name of the reference that asks for it. */
  using FinerRuns = std::map<std::string, FinerRun>;

  /**
   * The finer runs that the references of a scene ask for, on the first rank:
   * the same parameter file with other entries, and without references of its
   * own. Each is made unless its directory, by default in that of the scene's
   * run, holds it, or the command line says to check only. Throws InputError,
   * before any is made, when one cannot be, and ComputationError if one cannot
   * go on. Collective over all processes.
   */
  template <int dim>
  FinerRuns
  make_finer_runs(const std::vector<ReferenceSpec<dim>> &references,
                  const CommandLine                     &line,
                  const std::string                     &directory);
} // namespace impm

#endif
