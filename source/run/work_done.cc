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
    step.last_forces  = last_forces;
    step.last_moments = last_moments;
    step.last_forces.resize(n);
    step.last_moments.resize(n);

    // Of every carrier: force, sum of displacements, number of values.
    std::vector<double> sums(3 * dim * n);
    std::vector<double> moments(3 * n);
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
        if (const auto *motion = constraints.motion_of(carrier))
          {
            Tensor<1, dim> part;
            part[i % dim] = force;
            const auto moment =
              moment_of<dim>(problem.discretization->node_positions[i / dim] -
                               motion->centre,
                             part);
            for (unsigned int d = 0; d < 3; ++d)
              moments[3 * carrier + d] += moment[d];
          }
      }
    if (problem.following_loads)
      work += problem.following_loads->work(u);
    if (problem.contact)
      {
        work += problem.contact->work_of_obstacles();
        step.contact =
          Utilities::MPI::sum(problem.contact->energy_gain(), comm);
      }
    if (problem.free_bodies && Utilities::MPI::this_mpi_process(comm) == 0)
      work += problem.free_bodies->work();
    Utilities::MPI::sum(sums, comm, sums);
    Utilities::MPI::sum(moments, comm, moments);
    step.external    = Utilities::MPI::sum(work, comm);
    const auto amend = [&](const double half) {
      step.external += half;
      step.uncertain += std::abs(half);
    };
    for (unsigned int b = 0; b < n; ++b)
      {
        const auto *motion = constraints.motion_of(b);
        const bool  turns  = motion != nullptr && motion->turns();
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double *sum  = &sums[3 * (dim * b + d)];
            double       &last = step.last_forces[b][d];
            if (sum[2] > 0)
              amend(0.5 * (last - sum[0]) *
                    (turns ? motion->shift[d] : sum[1] / sum[2]));
            last = sum[0];
          }
        RotationVector moment;
        std::copy_n(&moments[3 * b], 3, moment.begin_raw());
        if (turns)
          amend(0.5 * (step.last_moments[b] - moment) *
                motion->rotation_vector());
        step.last_moments[b] = moment;
      }
    step.heat     = Utilities::MPI::sum(problem.response.work_of_heat(), comm);
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
    heat += step.heat;
    last_forces  = step.last_forces;
    last_moments = step.last_moments;
  }

  template class WorkDone<2>;
  template class WorkDone<3>;
} // namespace impm
