#include <impm/balance/terms/contact.h>

#include <limits>

namespace impm
{
  using namespace dealii;

  template <int dim>
  bool
  Contact<dim>::settle(const std::vector<Tensor<1, dim>> &increments)
  {
    const unsigned int most = 100;
    free->restart();
    for (unsigned int i = 0; i < most; ++i)
      {
        for (unsigned int q = 0; q < motions.size(); ++q)
          if (const auto &body = all.obstacles[q].free_body)
            motions[q] = free->motion(*body);
        for (unsigned int l = 0; l < states.size(); ++l)
          if (i == 0 || all.obstacles[all.links[l].pair].free_body)
            states[l] = state_after(l, increments[l]);
        if (free->improve(loads_on_free_bodies()))
          return true;
      }
    return false;
  }

  template <int dim>
  Tensor<1, dim>
  Contact<dim>::change_by(const unsigned int l, const unsigned int c) const
  {
    const auto &state   = states[l];
    const auto  tangent = state.tangent + state.curved;
    if (c < dim)
      {
        Tensor<1, dim> unit;
        unit[c] = 1;
        return -(tangent * unit);
      }
    RotationVector axis;
    axis[c - dim]      = 1;
    const auto &motion = motions[all.links[l].pair];
    const auto  arm    = state.place - (motion.centre + motion.shift);
    return cross(axis, state.gradient) - tangent * cross(axis, arm);
  }

  template <int dim>
  std::vector<typename FreeBodies<dim>::Load>
  Contact<dim>::loads_on_free_bodies() const
  {
    using Bodies                     = FreeBodies<dim>;
    constexpr unsigned int n         = Bodies::n_components;
    constexpr unsigned int n_numbers = n * (n + 1) + 4;
    std::vector<double>    sums(free->size() * n_numbers);
    for (unsigned int l = 0; l < states.size(); ++l)
      {
        const auto &link  = all.links[l];
        const auto &state = states[l];
        const auto &body  = all.obstacles[link.pair].free_body;
        if (!body || state.tangent.norm() == 0)
          continue;
        const auto          &motion = motions[link.pair];
        const Tensor<1, dim> arm = state.place - (motion.centre + motion.shift);
        double              *sum = &sums[*body * n_numbers];
        const auto           add = [&](const Tensor<1, dim> &force,
                             const RotationVector &moment) {
          for (unsigned int d = 0; d < dim; ++d)
            *sum++ += link.area * force[d];
          for (unsigned int d = 0; d < 3; ++d)
            *sum++ += link.area * moment[d];
        };
        add(state.gradient, moment_of<dim>(arm, state.gradient));
        for (unsigned int c = 0; c < n; ++c)
          {
            // The centre moves under what pushes where it is.
            const auto change = change_by(l, c);
            auto       moment = moment_of<dim>(arm, change);
            if (c < dim)
              {
                Tensor<1, dim> unit;
                unit[c] = 1;
                moment -= moment_of<dim>(unit, state.gradient);
              }
            add(change, moment);
          }
        const double force = link.area * state.gradient.norm();
        const double noise = 16 * std::numeric_limits<double>::epsilon() *
                             link.area * link.stiffness * state.place.norm();
        for (const double number :
             {force, force * arm.norm(), noise, noise * arm.norm()})
          *sum++ += number;
      }
    Utilities::MPI::sum(sums, communicator, sums);
    std::vector<typename Bodies::Load> loads(free->size());
    const double                      *sum = sums.data();
    for (auto &load : loads)
      {
        for (unsigned int i = 0; i < n; ++i)
          load.value[i] = *sum++;
        for (unsigned int c = 0; c < n; ++c)
          for (unsigned int i = 0; i < n; ++i)
            load.derivative[i][c] = *sum++;
        for (double *number :
             {&load.force, &load.moment, &load.force_noise, &load.moment_noise})
          *number = *sum++;
      }
    return loads;
  }

  template <int dim>
  void
  Contact<dim>::add_correction(const Vector &like, LowRank &correction) const
  {
    if (free == nullptr)
      return;
    const auto loads = loads_on_free_bodies();
    for (unsigned int b = 0; b < loads.size(); ++b)
      {
        if (loads[b].derivative.norm() == 0)
          continue; // nothing is near
        const auto         compliance = free->compliance(b, loads[b]);
        const unsigned int first      = correction.left.size(),
                           n          = free->unknowns.size();
        for (auto *vectors : {&correction.left, &correction.right})
          for (unsigned int i = 0; i < n; ++i)
            {
              vectors->emplace_back();
              vectors->back().reinit(like);
            }
        for (unsigned int l = 0; l < states.size(); ++l)
          {
            const auto &link = all.links[l];
            if (all.obstacles[link.pair].free_body != b ||
                states[l].tangent.norm() == 0)
              continue;
            std::array<Tensor<1, dim>, FreeBodies<dim>::n_components> changes;
            for (unsigned int c = 0; c < changes.size(); ++c)
              changes[c] = change_by(l, c);
            for (unsigned int i = 0; i < n; ++i)
              {
                // What moves the body changes the load as if the point
                // went the other way.
                const auto     right = -changes[free->unknowns[i]];
                Tensor<1, dim> left;
                for (const unsigned int j : free->unknowns)
                  left += compliance[j][free->unknowns[i]] * changes[j];
                add(l, left, correction.left[first + i]);
                add(l, right, correction.right[first + i]);
              }
          }
      }
  }

  template bool
  Contact<2>::settle(const std::vector<Tensor<1, 2>> &);
  template bool
  Contact<3>::settle(const std::vector<Tensor<1, 3>> &);
  template Tensor<1, 2>
  Contact<2>::change_by(unsigned int, unsigned int) const;
  template Tensor<1, 3>
  Contact<3>::change_by(unsigned int, unsigned int) const;
  template std::vector<typename FreeBodies<2>::Load>
  Contact<2>::loads_on_free_bodies() const;
  template std::vector<typename FreeBodies<3>::Load>
  Contact<3>::loads_on_free_bodies() const;
  template void
  Contact<2>::add_correction(const Vector &, LowRank &) const;
  template void
  Contact<3>::add_correction(const Vector &, LowRank &) const;
} // namespace impm
