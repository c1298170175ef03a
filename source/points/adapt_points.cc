#include <deal.II/base/mpi.h>

#include <impm/points/adapt_points.h>
#include <impm/points/point_fields.h>

#include <algorithm>
#include <iomanip>
#include <limits>
#include <sstream>

namespace impm
{
  using namespace dealii;

  template <int dim>
  PointChanges
  adapt_points(const Bodies<dim>         &bodies,
               const BackgroundGrid<dim> &grid,
               MaterialPoints<dim>       &points)
  {
    const auto any = [&](const PointAdaptation least) {
      return std::any_of(bodies.begin(), bodies.end(), [&](const auto &body) {
        return body.adaptation >= least;
      });
    };
    if (!any(PointAdaptation::split))
      return {};
    auto changes = split_points(bodies, grid, points);
    if (any(PointAdaptation::split_and_merge))
      changes.append(merge_points(bodies, grid, points));
    return changes;
  }

  template <int dim>
  PointsPerCell
  points_per_cell(const BackgroundGrid<dim> &grid,
                  const MaterialPoints<dim> &points)
  {
    PointsPerCell result;
    result.smallest      = std::numeric_limits<double>::max();
    double       sum     = 0;
    unsigned int n_cells = 0, n_here = 0;
    double       volume = 0; ///< of the points of a cell
    // 0 where points have none.
    const unsigned int domain =
      points.layout.find("initial_domain").value_or(0);
    Tensor<1, dim> lengths; ///< the same, along the axes
    const auto     finish = [&](const auto &cell) {
      double number = n_here;
      if (!grid.is_lagrangian)
        {
          double of_cell = 1;
          for (unsigned int d = 0; d < dim; ++d)
            of_cell *= cell_extent(cell, d);
          number *= of_cell / volume;
          result.fullest = std::max(result.fullest, volume / of_cell);
          for (unsigned int d = 0; d < dim; ++d)
            if (const double apart = lengths[d] / n_here / cell_extent(cell, d);
                apart > 1.0001)
              number = std::min(number, 1 / apart);
        }
      result.smallest = std::min(result.smallest, number);
      sum += number;
      ++n_cells;
      n_here  = 0;
      volume  = 0;
      lengths = Tensor<1, dim>();
    };
    typename Triangulation<dim>::active_cell_iterator cell;
    unsigned int                                      p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto here = particle.get_surrounding_cell();
        if (n_here > 0 && here != cell)
          finish(cell);
        cell = here;
        volume += present_measure(points, p, particle.get_location());
        if (domain > 0)
          {
            const double *fields = points.fields(p);
            const auto    F =
              points.layout.load_tensor(fields + points.offset_deformation);
            for (unsigned int d = 0; d < dim; ++d)
              {
                double longest = 0;
                for (unsigned int axis = 0; axis < dim; ++axis)
                  longest =
                    std::max(longest,
                             std::abs(F[d][axis] * fields[domain + axis]));
                lengths[d] += longest;
              }
          }
        ++n_here;
        ++p;
      }
    if (n_here > 0)
      finish(cell);
    const auto comm = grid.communicator;
    result.smallest = Utilities::MPI::min(result.smallest, comm);
    result.fullest  = Utilities::MPI::max(result.fullest, comm);
    result.mean =
      Utilities::MPI::sum(sum, comm) / Utilities::MPI::sum(n_cells, comm);
    return result;
  }

  std::string
  to_string(const PointsPerCell &number)
  {
    std::ostringstream text;
    text << std::setprecision(3) << "at least " << number.smallest << ", "
         << number.mean << " in the mean";
    return text.str();
  }

  template PointChanges
  adapt_points(const Bodies<2> &,
               const BackgroundGrid<2> &,
               MaterialPoints<2> &);
  template PointChanges
  adapt_points(const Bodies<3> &,
               const BackgroundGrid<3> &,
               MaterialPoints<3> &);
  template PointsPerCell
  points_per_cell(const BackgroundGrid<2> &, const MaterialPoints<2> &);
  template PointsPerCell
  points_per_cell(const BackgroundGrid<3> &, const MaterialPoints<3> &);
} // namespace impm
