#ifndef impm_run_checkpoint_h
#define impm_run_checkpoint_h

#include <impm/points/material_points.h>

#include <string>

namespace impm
{
  /** Where a run stands, apart from grid and points. */
  struct RunState
  {
    unsigned int step;
    double       time, step_size;
    std::string  reason; ///< why it was saved
  };

  /**
   * Saves points, grid and state into directory/checkpoint: into one of two
   * places in turn, and the file last_good names the new one once it is
   * complete. Collective.
   */
  template <int dim>
  void
  write_checkpoint(const std::string   &directory,
                   const RunState      &state,
                   BackgroundGrid<dim> &grid,
                   MaterialPoints<dim> &points);
} // namespace impm

#endif
