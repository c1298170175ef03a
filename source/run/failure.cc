#include <impm/footprints/approach.h>
#include <impm/footprints/pieces.h>
#include <impm/points/deformation_drift.h>
#include <impm/run/failed_points.h>
#include <impm/run/likely_causes.h>
#include <impm/run/simulation.h>

#include <algorithm>
#include <numeric>

// What a run says when it cannot go on.
namespace impm
{
  using namespace dealii;

  template <int dim>
  std::string
  Simulation<dim>::explain(const std::string &failure) const
  {
    FailedStep step;
    step.failure     = failure;
    step.residuals   = residuals;
    step.is_unstable = total.unstable + report.unstable > 0;
    step.are_plain   = scene.grid.method == GridMethod::mpm;
    step.is_unheld   = problem->loads_on_springs(result.increment) >= 0.01;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double J  = determinant(deformation_gradient(points, p));
        step.smallest_J = std::min(step.smallest_J, J);
        step.largest_J  = std::max(step.largest_J, J);
      }
    step.smallest_J = Utilities::MPI::min(step.smallest_J, communicator);
    step.largest_J  = Utilities::MPI::max(step.largest_J, communicator);
    for (const auto &of_body : failed_points(points))
      step.failed += of_body.n;
    if (!grid.is_lagrangian)
      {
        const auto now = count_pieces(points,
                                      problem->footprints,
                                      *problem->discretization,
                                      scene.bodies.size());
        step.pieces    = std::accumulate(now.begin(), now.end(), 0u);
        // As many as there are bodies with points.
        step.pieces_before =
          now.size() - std::count(now.begin(), now.end(), 0u);
        const auto density   = points_per_cell(grid, points);
        step.points_per_cell = density.smallest;
        step.fullest         = density.fullest;
        step.drift           = deformation_drift(scene.bodies, points);
        const auto approach  = find_approach(points,
                                            problem->footprints,
                                            *problem->discretization,
                                            problem->constraints);
        step.bodies_touch =
          approach.bodies_touch || approach.of_bodies == Distance::near;
      }
    return likely_causes(step);
  }

  template std::string
  Simulation<2>::explain(const std::string &) const;
  template std::string
  Simulation<3>::explain(const std::string &) const;
} // namespace impm
