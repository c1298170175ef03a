#include <impm/run/motion_limits.h>

#include <functional>
#include <limits>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Largest motion of any point relative to a grid that `grid_motion` moves,
 in extents of its cell. */
    template <int dim>
    double
    largest_motion(
      const StepProblem<dim>                                  &problem,
      const Vector                                            &increment,
      const MaterialPoints<dim>                               &points,
      const std::function<Tensor<1, dim>(const Point<dim> &)> &grid_motion)
    {
      std::vector<Tensor<1, dim>> motion;
      problem.footprints.interpolate(increment, motion);
      double       largest = 0;
      unsigned int p       = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const auto relative =
            motion[p++] - grid_motion(particle.get_location());
          const auto cell = particle.get_surrounding_cell();
          for (unsigned int d = 0; d < dim; ++d)
            largest =
              std::max(largest, std::abs(relative[d]) / cell_extent(cell, d));
        }
      return Utilities::MPI::max(largest, points.communicator);
    }

    /** Names a point that would leave a domain whose faces lie at `faces` when
 the step ends; empty if none. */
    template <int dim>
    std::string
    find_point_outside(const StepProblem<dim>            &problem,
                       const Vector                      &increment,
                       const MaterialPoints<dim>         &points,
                       const std::array<double, 2 * dim> &faces)
    {
      std::vector<Tensor<1, dim>> motion;
      problem.footprints.interpolate(increment, motion);
      std::string  outside;
      unsigned int p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const auto x    = particle.get_location() + motion[p++];
          const auto name = [&](const std::string &what) {
            std::ostringstream text;
            text << "point " << particle.get_id() << " at "
                 << particle.get_location() << " would " << what;
            return text.str();
          };
          // The next step divides by the radius.
          if (points.layout.geometry == GeometryKind::axisymmetric &&
              outside.empty() && !(x[0] > 0))
            outside = name("reach the axis");
          for (unsigned int f = 0; f < 2 * dim && outside.empty(); ++f)
            if (f % 2 == 0 ? x[f / 2] < faces[f] : x[f / 2] > faces[f])
              outside = name("leave the domain through its " + face_names()[f] +
                             " face");
        }
      for (const auto &text :
           Utilities::MPI::all_gather(points.communicator, outside))
        if (!text.empty())
          return text;
      return outside;
    }

  } // namespace

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
    const auto outside = find_point_outside(problem, increment, points, faces);
    if (!outside.empty() || grid.is_lagrangian)
      return outside;
    // Nor does it feel material that it has not reached; and between ranks a
    // point is found only where the neighbour can see it.
    const auto motion = [&](const Point<dim> &x) {
      Tensor<1, dim> displacement;
      for (unsigned int f = 0; f < 2 * dim; ++f)
        {
          const double here  = grid.face_position(f),
                       fixed = grid.face_position(f ^ 1u);
          displacement[f / 2] +=
            (faces[f] - here) * (x[f / 2] - fixed) / (here - fixed);
        }
      return displacement;
    };
    return largest_motion<dim>(problem, increment, points, motion) > 0.95 ?
             "a point moves across a whole cell" :
             "";
  }

  template std::string
  forbidden_motion(const StepProblem<2> &,
                   const Vector &,
                   const BackgroundGrid<2> &,
                   const MaterialPoints<2> &,
                   const GridPolicy<2> &);
  template std::string
  forbidden_motion(const StepProblem<3> &,
                   const Vector &,
                   const BackgroundGrid<3> &,
                   const MaterialPoints<3> &,
                   const GridPolicy<3> &);
} // namespace impm
