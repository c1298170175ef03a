#include <impm/grid/touching.h>
#include <impm/points/point_domains.h>
#include <impm/run/flight.h>
#include <impm/run/motion_limits.h>

#include <limits>
#include <sstream>

namespace impm
{
  using namespace dealii;

  template <int dim>
  bool
  put_back(const std::array<double, 2 * dim> &faces,
           const Tensor<1, dim>              &extents,
           const GeometryKind                 geometry,
           Point<dim>                        &place)
  {
    bool is_put_back = false;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int f = 2 * d; f < 2 * d + 2; ++f)
        {
          const double inwards = f % 2 == 0 ? 1 : -1;
          const double inside  = inwards * (place[d] - faces[f]);
          const double slack = 1e-12 * std::max(extents[d], std::abs(faces[f]));
          const bool   is_axis =
            geometry == GeometryKind::axisymmetric && f == 0 && faces[f] == 0;
          if (inside >= -slack && (inside < 0 || (is_axis && inside == 0)))
            {
              place[d]    = faces[f] + inwards * slack;
              is_put_back = true;
            }
        }
    return is_put_back;
  }

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
      // The next step divides by the radius.
      const bool at_axis =
        geometry == GeometryKind::axisymmetric && !(end[0] > 0);
      bool outside = false;
      for (unsigned int d = 0; d < dim; ++d)
        outside = outside || end[d] < faces[2 * d] || end[d] > faces[2 * d + 1];
      if (!at_axis && !outside)
        return "";
      std::string what = "reach the axis";
      for (unsigned int f = 2 * dim; f-- > 0 && !at_axis;)
        if (f % 2 == 0 ? end[f / 2] < faces[f] : end[f / 2] > faces[f])
          what = "leave the domain through its " + face_names()[f] + " face";
      std::ostringstream text;
      text << "point " << particle.get_id() << " at " << particle.get_location()
           << " would " << what;
      return text.str();
    }

    /** Largest component of the ways of points, in extents of their cells, on
     * any rank. `way` makes it of the number and place of a point. */
    template <int dim, typename Way>
    double
    largest_in_cells(const MaterialPoints<dim> &points, const Way &way)
    {
      double                                            largest = 0;
      typename Triangulation<dim>::active_cell_iterator cell;
      std::array<double, dim>                           extents{};
      unsigned int                                      p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          // Points come in the order of cells.
          const auto here = particle.get_surrounding_cell();
          if (p == 0 || here != cell)
            {
              cell = here;
              for (unsigned int d = 0; d < dim; ++d)
                extents[d] = cell_extent(cell, d);
            }
          const Tensor<1, dim> of_point = way(p++, particle.get_location());
          for (unsigned int d = 0; d < dim; ++d)
            largest = std::max(largest, std::abs(of_point[d]) / extents[d]);
        }
      return Utilities::MPI::max(largest, points.communicator);
    }
  } // namespace

  template <int dim>
  GridMotion
  motion_through_grid(const StepProblem<dim>      &problem,
                      std::vector<Tensor<1, dim>> &increments,
                      const BackgroundGrid<dim>   &grid,
                      MaterialPoints<dim>         &points,
                      const GridPolicy<dim>       &policy,
                      const double                 longest_in_cells)
  {
    const double infinite = std::numeric_limits<double>::infinity();
    // Material that has not reached a face yet does not feel it: a long step
    // could carry it through. Vertices at x move by stretch times their
    // distance from the opposite face until the grid is reset.
    typename BackgroundGrid<dim>::FacePositions end, fixed, stretch;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        const double placed = grid.face_of_vertices(f);
        end[f]              = grid.is_lagrangian ?
                                (f % 2 == 0 ? -infinite : infinite) :
                                policy.face_position(grid,
                                        f,
                                        problem.time,
                                        problem.time + problem.dt);
        fixed[f]            = grid.face_of_vertices(f ^ 1u);
        stretch[f]          = (end[f] - placed) / (placed - fixed[f]);
      }

    GridMotion motion;
    motion.lands = !grid.is_lagrangian &&
                   land(problem.constraints.faces, end, increments, points);
    if (motion.lands)
      return motion;
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto &x    = particle.get_location();
        auto       &step = increments[p++];
        if (!grid.is_lagrangian)
          {
            auto place = x + step;
            if (put_back<dim>(end,
                              extents_of<dim>(particle.get_surrounding_cell()),
                              points.layout.geometry,
                              place))
              step = place - x;
          }
        if (motion.forbidden.empty())
          motion.forbidden =
            forbidden<dim>(particle, x + step, end, points.layout.geometry);
      }
    for (const auto &text :
         Utilities::MPI::all_gather(points.communicator, motion.forbidden))
      if (!text.empty())
        {
          motion.forbidden = text;
          return motion;
        }
    if (grid.is_lagrangian)
      return motion;

    std::vector<Tensor<1, dim>> before;
    if (grid.is_moved())
      problem.footprints.interpolate(grid.nodal_state().displacement, before);
    motion.in_cells = largest_in_cells(
      points, [&](const unsigned int point, const Point<dim> &place) {
        const auto ago = before.empty() ? Tensor<1, dim>() : before[point];
        auto       way = ago + increments[point];
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double start = place[d] - ago[d];
            way[d] -= stretch[2 * d] * (start - fixed[2 * d]) +
                      stretch[2 * d + 1] * (start - fixed[2 * d + 1]);
          }
        return way;
      });
    const double longest = 0.95 * longest_in_cells;
    if (motion.in_cells > longest && !grid.keeps_motion)
      {
        const Flight<dim> flight(problem, points, increments);
        motion.in_cells = largest_in_cells(
          points, [&](const unsigned int point, const Point<dim> &place) {
            return increments[point] -
                   flight.rigid_increment(points.body(point), place);
          });
      }
    // A point does not feel material that it has not reached.
    if (motion.in_cells > longest)
      motion.forbidden = "a point moves across a whole cell";
    return motion;
  }

  template decltype(put_back<2>)            put_back<2>;
  template decltype(put_back<3>)            put_back<3>;
  template decltype(motion_through_grid<2>) motion_through_grid<2>;
  template decltype(motion_through_grid<3>) motion_through_grid<3>;
} // namespace impm
