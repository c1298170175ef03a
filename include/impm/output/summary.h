#ifndef impm_output_summary_h
#define impm_output_summary_h

#include <deal.II/base/mpi.h>

#include <impm/base/memory.h>
#include <impm/base/units.h>
#include <impm/points/adapt_points.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  /** How wrong a run is by one of its references. */
  struct ReferenceError
  {
    std::string name, kind, norm;
    /** Norms over the points; of a probe or curve the (last) figures. */
    double                value, reference;
    double                error;
    std::string           flaw; ///< why the error is not a number
    std::optional<double> reference_wall_seconds; ///< of a finer run
  };

  /** summary.json: what a run was, what it cost and what it gave. */
  struct RunSummary
  {
    std::string scene, status, linear_solver;
    Units       units;
    /** Of the history, such as have a unit. */
    std::vector<std::pair<std::string, std::string>>   column_units;
    int                                                dim;
    unsigned long                                      points, bytes_per_point;
    PointsPerCell                                      points_per_cell;
    unsigned int                                       steps;
    double                                             time;
    std::vector<std::pair<std::string, unsigned long>> counts;
    std::vector<std::pair<std::string, double>>        figures; ///< last row
    std::map<std::string, double> phases; ///< wall seconds of rank 0
    double                        wall_seconds;
    MemoryByOwner                 memory; ///< of rank 0, in the last step
    std::vector<std::string>      warnings;
    std::vector<ReferenceError>   errors;

    /** Collective, for the peak of memory over all ranks. */
    void
    write(const std::string &directory, MPI_Comm communicator) const;

    /** Wall time by phase, for the terminal. */
    std::string
    phase_table() const;

    /** A line for each error, beside the run time. */
    std::string
    error_table() const;
  };
} // namespace impm

#endif
