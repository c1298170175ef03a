#ifndef impm_run_run_directory_h
#define impm_run_run_directory_h

#include <deal.II/base/mpi.h>

#include <boost/interprocess/sync/file_lock.hpp>

#include <string>

namespace impm
{
  /** A directory that one run writes into: no other can as long as this
   * lives. */
  class RunDirectory
  {
  public:
    /** Makes it, if told so. Throws InputError if another run is there, or
     * nothing, SystemError if it cannot be made. Collective. */
    RunDirectory(const std::string &name, MPI_Comm communicator, bool make);

    /** Removes what an older run has left, and nothing else. Collective. */
    void
    clear() const;

  private:
    const std::string              name;
    const MPI_Comm                 communicator;
    boost::interprocess::file_lock lock; ///< of the first rank
  };
} // namespace impm

#endif
