#ifndef impm_summary_h
#define impm_summary_h

#include <deal.II/base/mpi.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace impm
{
  /** summary.json: what a run was, what it cost and what it gave. */
  struct RunSummary
  {
    std::string                                        scene, status;
    int                                                dim;
    unsigned long                                      points, bytes_per_point;
    unsigned int                                       steps;
    double                                             time;
    std::vector<std::pair<std::string, unsigned long>> counts;
    std::vector<std::pair<std::string, double>>        figures; ///< last row
    std::map<std::string, double> phases; ///< wall seconds of rank 0
    double                        wall_seconds;

    /** Collective, for the peak of memory over all ranks. */
    void
    write(const std::string &directory, MPI_Comm communicator) const;

    /** Wall time by phase, for the terminal. */
    std::string
    phase_table() const;
  };
} // namespace impm

#endif
