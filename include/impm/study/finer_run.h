#ifndef impm_study_finer_run_h
#define impm_study_finer_run_h

#include <impm/app/command_line.h>
#include <impm/study/reference.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * The finer runs that a scene's references ask for: the same parameter file
   * with other entries, and without references of its own.
   */
  template <int dim>
  class FinerRunner
  {
  public:
    /**
     * Reads them and builds those that have to be made, for a run into
     * `directory`. Throws InputError when one cannot be; writes nothing.
     * Collective.
     */
    FinerRunner(const std::vector<ReferenceSpec<dim>> &references,
                const CommandLine                     &line,
                const std::string                     &directory,
                MPI_Comm                               communicator);

    /**
     * Makes each, unless its directory holds it. Throws ComputationError if
     * one cannot go on. Collective.
     */
    FinerRuns
    run() const;

  private:
    struct Task
    {
      std::string name, directory, parameters;
      Scene<dim>  scene;
      bool        is_there; ///< complete, and of the same parameters
    };

    std::vector<Task>            tasks;
    const CommandLine::Verbosity verbosity;
    const MPI_Comm               communicator;
  };
} // namespace impm

#endif
