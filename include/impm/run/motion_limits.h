#ifndef impm_run_motion_limits_h
#define impm_run_motion_limits_h

#include <impm/balance/step_problem.h>
#include <impm/grid/grid_policy.h>

#include <limits>
#include <sstream>
#include <string>

namespace impm
{
  /** Why an increment that has converged must not be used; empty if it may.
   * Collective. */
  template <int dim>
  std::string
  forbidden_motion(const StepProblem<dim>    &problem,
                   const Vector              &increment,
                   const BackgroundGrid<dim> &grid,
                   const MaterialPoints<dim> &points,
                   const GridPolicy<dim>     &policy)
  {
    const double infinite = std::numeric_limits<double>::infinity();
    // Material that has not reached a face yet does not feel it: a long step
    // could carry it through.
    const double                from = problem.time, to = from + problem.dt;
    std::array<double, 2 * dim> faces;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      faces[f] = grid.is_lagrangian ? (f % 2 == 0 ? -infinite : infinite) :
                                      policy.face_position(grid, f, from, to);
    // How far the grid moves at x.
    const auto grid_motion = [&](const dealii::Point<dim> &x) {
      dealii::Tensor<1, dim> displacement;
      for (unsigned int f = 0; f < 2 * dim; ++f)
        {
          const double here  = grid.face_position(f),
                       fixed = grid.face_position(f ^ 1u);
          displacement[f / 2] +=
            (faces[f] - here) * (x[f / 2] - fixed) / (here - fixed);
        }
      return displacement;
    };

    std::vector<dealii::Tensor<1, dim>> motion;
    problem.footprints.interpolate(increment, motion);
    std::string  outside;
    double       largest = 0; ///< relative to the grid, in extents of a cell
    unsigned int p       = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto start = particle.get_location();
        const auto end   = start + motion[p];
        const auto name  = [&](const std::string &what) {
          std::ostringstream text;
          text << "point " << particle.get_id() << " at " << start << " would "
               << what;
          return text.str();
        };
        // The next step divides by the radius.
        if (points.layout.geometry == GeometryKind::axisymmetric &&
            outside.empty() && !(end[0] > 0))
          outside = name("reach the axis");
        for (unsigned int f = 0; f < 2 * dim && outside.empty(); ++f)
          if (f % 2 == 0 ? end[f / 2] < faces[f] : end[f / 2] > faces[f])
            outside =
              name("leave the domain through its " + face_names()[f] + " face");
        if (!grid.is_lagrangian)
          {
            const auto relative = motion[p] - grid_motion(start);
            const auto cell     = particle.get_surrounding_cell();
            for (unsigned int d = 0; d < dim; ++d)
              largest =
                std::max(largest, std::abs(relative[d]) / cell_extent(cell, d));
          }
        ++p;
      }
    for (const auto &text :
         dealii::Utilities::MPI::all_gather(points.communicator, outside))
      if (!text.empty())
        return text;
    // Nor does a point feel material that it has not reached; and between ranks
    // it is found only where the neighbour can see it.
    return dealii::Utilities::MPI::max(largest, points.communicator) > 0.95 ?
             "a point moves across a whole cell" :
             "";
  }
} // namespace impm

#endif
