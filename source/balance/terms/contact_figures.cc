#include <impm/balance/terms/contact.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  template <int dim>
  double
  Contact<dim>::total_force() const
  {
    double sum = 0;
    for (unsigned int l = 0; l < states.size(); ++l)
      sum += all.links[l].area * states[l].end_gradient.norm();
    return Utilities::MPI::sum(sum, communicator);
  }

  template <int dim>
  double
  Contact<dim>::energy_gain() const
  {
    double sum = 0;
    for (unsigned int l = 0; l < states.size(); ++l)
      sum += all.links[l].area *
             (states[l].energy - state_at(l, Tensor<1, dim>()).energy);
    return sum;
  }

  template <int dim>
  Tensor<1, dim>
  Contact<dim>::force_on_partner(const unsigned int pair) const
  {
    Tensor<1, dim> force;
    for (unsigned int l = 0; l < states.size(); ++l)
      if (all.links[l].pair == pair)
        force += all.links[l].area * states[l].end_gradient;
    return force;
  }

  template <int dim>
  RotationVector
  Contact<dim>::moment_on_partner(const unsigned int pair,
                                  const Point<dim>  &about) const
  {
    RotationVector moment;
    for (unsigned int l = 0; l < states.size(); ++l)
      if (all.links[l].pair == pair)
        moment += all.links[l].area * moment_of<dim>(states[l].place - about,
                                                     states[l].end_gradient);
    return moment;
  }

  template <int dim>
  ContactFigures
  Contact<dim>::figures(const unsigned int pair,
                        const MPI_Comm     communicator) const
  {
    double sums[3] = {}; // force, friction, area
    double largest = 0;
    for (unsigned int l = 0; l < states.size(); ++l)
      if (const auto &link = all.links[l]; link.pair == pair)
        {
          const double p = states[l].pressure;
          if (!link.is_bond && p == 0)
            continue;
          // In a long step the layer of what has met is pressed further at its
          // end than by the force that stopped it.
          sums[0] += link.area * (link.is_bond ? p : states[l].given);
          sums[1] += link.area * states[l].friction;
          sums[2] += link.area;
          largest = std::max(largest, p);
        }
    Utilities::MPI::sum(sums, communicator, sums);
    return {sums[0],
            sums[1],
            sums[2],
            Utilities::MPI::max(largest, communicator)};
  }

  template <int dim>
  double
  Contact<dim>::work_of_obstacles() const
  {
    double work = 0;
    for (unsigned int l = 0; l < states.size(); ++l)
      if (const auto &link = all.links[l];
          link.obstacle != nullptr && !link.obstacle->free_body)
        work -= 0.5 * link.area *
                (states[l].gradient * states[l].carried +
                 starts[l].gradient * motions[link.pair].increment(link.place));
    return work;
  }

  template <int dim>
  double
  Contact<dim>::smallest_gap() const
  {
    double smallest = std::numeric_limits<double>::max();
    for (unsigned int l = 0; l < states.size(); ++l)
      if (const auto &link = all.links[l]; !link.is_bond)
        smallest = std::min(smallest, states[l].gap / link.thickness);
    return smallest;
  }

  template <int dim>
  void
  Contact<dim>::remember_meetings(SurfacePoints<dim> &points) const
  {
    // A point that meets several goes on with the one that presses most.
    std::vector<typename SurfacePoints<dim>::Meeting> meetings(points.size());
    for (unsigned int l = 0; l < states.size(); ++l)
      {
        const auto &link    = all.links[l];
        const auto &state   = states[l];
        auto       &meeting = meetings[link.point];
        if (!link.is_bond &&
            (state.pressure == 0 || state.pressure < meeting.pressure))
          continue;
        meeting.pair     = link.pair;
        meeting.pressure = state.pressure;
        meeting.slip     = state.slip;
        meeting.gap      = state.gap;
        if (link.is_bond)
          continue;
        const double most = link.friction * state.pressure /
                            (friction_stiffness * link.stiffness);
        if (const double slip = state.slip.norm(); slip > most)
          meeting.slip *= most / slip;
      }
    for (unsigned int s = 0; s < points.size(); ++s)
      points.set_meeting(s, meetings[s]);
  }

  template double
  Contact<2>::total_force() const;
  template double
  Contact<3>::total_force() const;
  template double
  Contact<2>::energy_gain() const;
  template double
  Contact<3>::energy_gain() const;
  template Tensor<1, 2>
  Contact<2>::force_on_partner(unsigned int) const;
  template Tensor<1, 3>
  Contact<3>::force_on_partner(unsigned int) const;
  template RotationVector
  Contact<2>::moment_on_partner(unsigned int, const Point<2> &) const;
  template RotationVector
  Contact<3>::moment_on_partner(unsigned int, const Point<3> &) const;
  template ContactFigures
  Contact<2>::figures(unsigned int, MPI_Comm) const;
  template ContactFigures
  Contact<3>::figures(unsigned int, MPI_Comm) const;
  template double
  Contact<2>::work_of_obstacles() const;
  template double
  Contact<3>::work_of_obstacles() const;
  template double
  Contact<2>::smallest_gap() const;
  template double
  Contact<3>::smallest_gap() const;
  template void
  Contact<2>::remember_meetings(SurfacePoints<2> &) const;
  template void
  Contact<3>::remember_meetings(SurfacePoints<3> &) const;
} // namespace impm
