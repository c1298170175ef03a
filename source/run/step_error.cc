#include <impm/footprints/approach.h>
#include <impm/run/flight.h>
#include <impm/run/step_error.h>

#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Of the points' increments, where the grid carries the motion. */
    template <int dim>
    std::vector<Tensor<1, dim>>
    error_of_integrator(const StepProblem<dim> &problem,
                        const StepResult       &result)
    {
      Vector error;
      problem.discretization->initialize(error);
      problem.integrator.displacement_error(problem.dt,
                                            problem.motion.velocity,
                                            problem.start_acceleration,
                                            result.velocity,
                                            result.acceleration,
                                            error);
      // What is prescribed is exact.
      for (unsigned int i = 0; i < error.locally_owned_size(); ++i)
        if (problem.constraints.is_constrained[i])
          error.local_element(i) = 0;
      problem.discretization->interpolate_hanging(error);
      std::vector<Tensor<1, dim>> at_points;
      problem.footprints.interpolate(error, at_points);
      return at_points;
    }

    /** Backward Euler against forward Euler, the rates of the step before. */
    template <int dim>
    std::vector<Tensor<1, dim>>
    error_of_rates(const double                       dt,
                   const std::vector<Tensor<1, dim>> &increments,
                   const MaterialPoints<dim>         &points)
    {
      std::vector<Tensor<1, dim>> errors(points.size());
      for (unsigned int p = 0; p < points.size(); ++p)
        errors[p] =
          0.5 * (increments[p] - dt * points.vector(p, points.offset_rate));
      return errors;
    }
  } // namespace

  template <int dim>
  StepError
  estimate_step_error(const StepProblem<dim>            &problem,
                      const StepResult                  &result,
                      const std::vector<Tensor<1, dim>> &increments,
                      const MaterialPoints<dim>         &points)
  {
    const bool is_first = problem.time == 0;
    const auto errors   = problem.integrator.has_inertia() ?
                            error_of_integrator(problem, result) :
                            error_of_rates(problem.dt, increments, points);
    // Mass, and over it the squares of error and increment.
    std::vector<double> sums(3);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double mass = points.mass(p);
        sums[0] += mass;
        sums[1] += mass * errors[p].norm_square();
        sums[2] += mass * increments[p].norm_square();
      }
    Utilities::MPI::sum(sums, points.communicator, sums);
    StepError error;
    if (problem.integrator.has_inertia() || !is_first)
      error.displacement = std::sqrt(sums[1] / sums[0]);
    error.speed = std::sqrt(sums[2] / sums[0]) / problem.dt;
    return error;
  }

  template <int dim>
  double
  way_over_allowed(const StepProblem<dim>            &problem,
                   const std::vector<Tensor<1, dim>> &increments,
                   const MaterialPoints<dim>         &points)
  {
    const auto approach = find_approach(points,
                                        problem.footprints,
                                        *problem.discretization,
                                        problem.constraints);
    if (approach.of_bodies == Distance::none &&
        approach.to_walls == Distance::none)
      return 0;
    const Flight<dim> flight(problem, points, increments);
    // In cells. From further away, what moves by half of one does not meet.
    const auto longest = [](const Distance distance, const bool ways_cross) {
      if (distance == Distance::near)
        return 0.025;
      return distance == Distance::far && ways_cross ?
               0.5 :
               std::numeric_limits<double>::max();
    };

    std::vector<double> sums(dim + 1);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        sums[dim] += points.mass(p);
        for (unsigned int d = 0; d < dim; ++d)
          sums[d] += points.mass(p) * increments[p][d];
      }
    Utilities::MPI::sum(sums, points.communicator, sums);
    double way = 0, relative_way = 0;
    for (const auto &increment : increments)
      for (unsigned int d = 0; d < dim; ++d)
        {
          way          = std::max(way, std::abs(increment[d]));
          relative_way = std::max(relative_way,
                                  std::abs(increment[d] - sums[d] / sums[dim]));
        }
    const double over =
      std::max(way / longest(approach.to_walls, flight.walls_are_met()),
               relative_way /
                 longest(approach.of_bodies, flight.bodies_meet()));
    return Utilities::MPI::max(over, points.communicator) /
           problem.discretization->smallest_cell_extent;
  }

  template decltype(way_over_allowed<2>)    way_over_allowed<2>;
  template decltype(way_over_allowed<3>)    way_over_allowed<3>;
  template decltype(estimate_step_error<2>) estimate_step_error<2>;
  template decltype(estimate_step_error<3>) estimate_step_error<3>;
} // namespace impm
