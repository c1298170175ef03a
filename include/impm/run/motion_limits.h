#ifndef impm_run_motion_limits_h
#define impm_run_motion_limits_h

#include <impm/balance/step_problem.h>
#include <impm/grid/grid_policy.h>

#include <string>
#include <vector>

namespace impm
{
  /** How points would move through the grid. */
  struct GridMotion
  {
    /** Why the increment must not be used; empty if it may. */
    std::string forbidden;
    /** Whether points come to touch a face: the step is to be solved anew. */
    bool lands = false;
    /** Largest since points were sorted into cells, in extents of a cell; of
     * bodies that fly freely and far, with respect to their rigid motion. */
    double in_cells = 0;
  };

  /**
   * Takes a place that round-off, 1e-12 of a cell or of where the face is, has
   * taken through a face of the domain or onto the axis as far inside; returns
   * whether it did.
   */
  template <int dim>
  bool
  put_back(const std::array<double, 2 * dim> &faces,
           const dealii::Tensor<1, dim>      &extents,
           GeometryKind                       geometry,
           dealii::Point<dim>                &place);

  /** Of the points' increments in a step that has converged; none but those
   * that meet nothing may go as far as `longest_in_cells`. Those that round-off
   * takes out of the domain are put_back(). Collective. */
  template <int dim>
  GridMotion
  motion_through_grid(const StepProblem<dim>              &problem,
                      std::vector<dealii::Tensor<1, dim>> &increments,
                      const BackgroundGrid<dim>           &grid,
                      MaterialPoints<dim>                 &points,
                      const GridPolicy<dim>               &policy,
                      double                               longest_in_cells);
} // namespace impm

#endif
