#include <impm/run/external_work.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  ExternalWork<dim>::add(const StepProblem<dim> &problem,
                         const Vector           &u,
                         const Vector           &forces)
  {
    const auto        &constraints = problem.constraints;
    const MPI_Comm     comm        = problem.discretization->communicator;
    const unsigned int n           = constraints.n_carriers();
    last_forces.resize(n);

    // Of every carrier: force, sum of displacements, number of values.
    std::vector<double> sums(3 * dim * n);
    double              work = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      {
        work -= 0.5 *
                (problem.loads.at_start.local_element(i) +
                 problem.loads.at_end.local_element(i)) *
                u.local_element(i);
        const unsigned int carrier = constraints.carrier(i);
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
    Utilities::MPI::sum(sums, comm, sums);
    done += Utilities::MPI::sum(work, comm);
    for (unsigned int b = 0; b < n; ++b)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double *sum = &sums[3 * (dim * b + d)];
          if (sum[2] > 0)
            done += 0.5 * (last_forces[b][d] - sum[0]) * sum[1] / sum[2];
          last_forces[b][d] = sum[0];
        }
    stabilization += Utilities::MPI::sum(problem.ghost_penalty.energy(u), comm);
  }

  template class ExternalWork<2>;
  template class ExternalWork<3>;
} // namespace impm
