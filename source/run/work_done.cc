#include <impm/balance/terms/contact.h>
#include <impm/balance/terms/following_loads.h>
#include <impm/run/work_done.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  typename WorkDone<dim>::Step
  WorkDone<dim>::of_step(const StepProblem<dim> &problem,
                         const Vector           &u,
                         const Vector           &forces) const
  {
    const auto        &constraints = problem.constraints;
    const MPI_Comm     comm        = problem.discretization->communicator;
    const unsigned int n           = constraints.n_carriers();
    Step               step;
    step.last_forces = last_forces;
    step.last_forces.resize(n);

    // Of every carrier: force, sum of displacements, number of values.
    std::vector<double> sums(3 * dim * n);
    double              work = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      {
        if (problem.loads)
          work -= 0.5 *
                  (problem.loads->at_start.local_element(i) +
                   problem.loads->at_end.local_element(i)) *
                  u.local_element(i);
        const unsigned int carrier = constraints.carrier[i];
        if (carrier == StepConstraints<dim>::no_carrier)
          continue;
        const double inertia = problem.held_inertia(u, i);
        const double force   = forces.local_element(i) - inertia;
        work += forces.local_element(i) * u.local_element(i);
        double *sum = &sums[3 * (dim * carrier + i % dim)];
        sum[0] += force;
        sum[1] += u.local_element(i);
        sum[2] += 1;
      }
    if (problem.following_loads)
      work += problem.following_loads->work(u);
    if (problem.contact)
      {
        work += problem.contact->work_of_obstacles();
        step.contact =
          Utilities::MPI::sum(problem.contact->energy_gain(), comm);
      }
    Utilities::MPI::sum(sums, comm, sums);
    step.external = Utilities::MPI::sum(work, comm);
    for (unsigned int b = 0; b < n; ++b)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double *sum  = &sums[3 * (dim * b + d)];
          double       &last = step.last_forces[b][d];
          if (sum[2] > 0)
            {
              const double half = 0.5 * (last - sum[0]) * sum[1] / sum[2];
              step.external += half;
              step.uncertain += std::abs(half);
            }
          last = sum[0];
        }
    step.internal = Utilities::MPI::sum(problem.response.work(), comm);
    for (const Term *term : problem.stabilization())
      step.stabilization += Utilities::MPI::sum(term->energy(u, u), comm);
    return step;
  }

  template <int dim>
  void
  WorkDone<dim>::add(const Step &step)
  {
    external += step.external;
    internal += step.internal;
    stabilization += step.stabilization;
    uncertain += step.uncertain;
    contact += step.contact;
    last_forces = step.last_forces;
  }

  template class WorkDone<2>;
  template class WorkDone<3>;
} // namespace impm
