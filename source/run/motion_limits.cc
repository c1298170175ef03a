#include <impm/run/motion_limits.h>

#include <limits>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Why a point must not go from `start` to `end`; empty if it may. */
    template <int dim>
    std::string
    forbidden(const Particles::ParticleAccessor<dim> &particle,
              const Point<dim>                       &end,
              const std::array<double, 2 * dim>      &faces,
              const GeometryKind                      geometry)
    {
      std::string what;
      // The next step divides by the radius.
      if (geometry == GeometryKind::axisymmetric && !(end[0] > 0))
        what = "reach the axis";
      for (unsigned int f = 0; f < 2 * dim && what.empty(); ++f)
        if (f % 2 == 0 ? end[f / 2] < faces[f] : end[f / 2] > faces[f])
          what = "leave the domain through its " + face_names()[f] + " face";
      if (what.empty())
        return what;
      std::ostringstream text;
      text << "point " << particle.get_id() << " at " << particle.get_location()
           << " would " << what;
      return text.str();
    }

    template <int dim>
    double
    in_cells(const Tensor<1, dim>                                    &motion,
             const typename Triangulation<dim>::active_cell_iterator &cell)
    {
      double largest = 0;
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max(largest, std::abs(motion[d]) / cell_extent(cell, d));
      return largest;
    }
  } // namespace

  template <int dim>
  GridMotion
  motion_through_grid(const StepProblem<dim>    &problem,
                      const Vector              &increment,
                      const BackgroundGrid<dim> &grid,
                      const MaterialPoints<dim> &points,
                      const GridPolicy<dim>     &policy,
                      const double               largest_in_cells)
  {
    const double infinite = std::numeric_limits<double>::infinity();
    // Material that has not reached a face yet does not feel it: a long step
    // could carry it through.
    typename BackgroundGrid<dim>::FacePositions placed, end;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        placed[f] = grid.face_of_vertices(f);
        end[f]    = grid.is_lagrangian ?
                      (f % 2 == 0 ? -infinite : infinite) :
                      policy.face_position(grid,
                                        f,
                                        problem.time,
                                        problem.time + problem.dt);
      }
    // How far vertices at x move until the grid is reset.
    const auto grid_motion = [&](const Point<dim> &x) {
      Tensor<1, dim> displacement;
      for (unsigned int f = 0; f < 2 * dim; ++f)
        {
          const double here = placed[f], fixed = placed[f ^ 1u];
          displacement[f / 2] +=
            (end[f] - here) * (x[f / 2] - fixed) / (here - fixed);
        }
      return displacement;
    };

    std::vector<Tensor<1, dim>> step, before(points.size());
    problem.footprints.interpolate(increment, step);
    if (grid.is_moved() && !grid.is_lagrangian)
      problem.footprints.interpolate(grid.nodal_state().displacement, before);
    GridMotion   motion;
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto x = particle.get_location();
        if (motion.forbidden.empty())
          motion.forbidden =
            forbidden<dim>(particle, x + step[p], end, points.layout.geometry);
        if (!grid.is_lagrangian)
          {
            const auto cell  = particle.get_surrounding_cell();
            const auto since = before[p] + step[p];
            motion.in_cells =
              std::max(motion.in_cells,
                       in_cells<dim>(since - grid_motion(x - before[p]), cell));
          }
        ++p;
      }
    for (const auto &text :
         Utilities::MPI::all_gather(points.communicator, motion.forbidden))
      if (!text.empty())
        {
          motion.forbidden = text;
          return motion;
        }
    motion.in_cells = Utilities::MPI::max(motion.in_cells, points.communicator);
    // Nor does a point feel material that it has not reached; and between ranks
    // it is found only where the neighbour can see it.
    if (motion.in_cells > 0.95 * largest_in_cells)
      motion.forbidden = "a point moves across a whole cell";
    return motion;
  }

  template decltype(motion_through_grid<2>) motion_through_grid<2>;
  template decltype(motion_through_grid<3>) motion_through_grid<3>;
} // namespace impm
