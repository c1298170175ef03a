#ifndef impm_run_failed_points_h
#define impm_run_failed_points_h

#include <impm/points/material_points.h>

#include <vector>

namespace impm
{
  /** What of a body has failed, see FailingLaw. */
  template <int dim>
  struct FailedPoints
  {
    unsigned long      n      = 0; ///< number of points
    double             volume = 0; ///< of theirs, initial (m^3)
    dealii::Point<dim> place;      ///< mean of their places (m)
  };

  /** By body; empty if no law has points that fail. Collective. */
  template <int dim>
  std::vector<FailedPoints<dim>>
  failed_points(const MaterialPoints<dim> &points);
} // namespace impm

#endif
