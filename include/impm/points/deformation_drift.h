#ifndef impm_points_deformation_drift_h
#define impm_points_deformation_drift_h

#include <impm/points/material_points.h>

namespace impm
{
  /**
   * How far the deformation that points carry has drifted from how they lie:
   * in every cell the mean of their F, and the F_x that takes their initial
   * positions to the present ones best (least squares), give two strains
   * E = (F^T F - 1) / 2; this is the mean of |E - E_x| over that of |E_x|. Zero
   * while strain is less than 0.01 in the mean. Plain points that go through
   * many cells drift, since each cell tells them its own gradient. For points
   * that know their initial position; bodies whose F is not of the whole way,
   * liquids and where points merge and their law minds no shape, are left out.
   * Collective.
   */
  template <int dim>
  double
  deformation_drift(const Bodies<dim>         &bodies,
                    const MaterialPoints<dim> &points);
} // namespace impm

#endif
