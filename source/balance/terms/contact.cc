#include <impm/balance/terms/contact.h>
#include <impm/contact/layer.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Bounds of friction agree when they differ by no more, in the mean. */
    constexpr double tolerance = 1e-3;
  } // namespace

  template <int dim>
  typename Contact<dim>::Friction
  Contact<dim>::friction_at(const unsigned int    l,
                            const Tensor<1, dim> &slip) const
  {
    const double bound = bounds[l];
    const double c     = friction_stiffness * all.links[l].stiffness;
    const double way   = slip.norm();
    const auto   along = unit_symmetric_tensor<dim>() -
                       symmetrize(outer_product(normals[l], normals[l]));
    if (c * way <= bound)
      return {slip, c * slip, c * along};
    const auto     direction = slip / way;
    Tensor<1, dim> known     = bound * direction;
    if (!at_tangent.empty())
      {
        const auto &last = at_tangent[l];
        known            = last.force + last.tangent * (slip - last.slip);
        known -= (known * normals[l]) * normals[l];
        known *= std::min(1., bound / known.norm());
      }
    return {slip,
            bound * direction,
            (bound * along - symmetrize(outer_product(known, direction))) /
              way};
  }

  template <int dim>
  typename Contact<dim>::State
  Contact<dim>::state_at(const unsigned int l, const Tensor<1, dim> &way) const
  {
    const auto  &link = all.links[l];
    const double k    = link.stiffness;
    State        state;
    state.slip = link.slip + way;
    if (link.is_bond)
      {
        state.energy = state.potential = 0.5 * k * state.slip.norm_square();
        state.gradient = state.end_gradient = k * state.slip;
        state.tangent                       = k * unit_symmetric_tensor<dim>();
        state.pressure                      = -state.gradient * link.normal;
        state.friction = (state.gradient + state.pressure * link.normal).norm();
        return state;
      }
    state.gap                 = link.gap + link.normal * way;
    Tensor<1, dim>          n = link.normal;
    SymmetricTensor<2, dim> curvature;
    if (link.obstacle != nullptr)
      {
        const auto proximity = link.obstacle->proximity(link.place + way);
        state.gap            = proximity.distance;
        n                    = proximity.normal;
        curvature            = proximity.curvature;
      }
    const auto at_end  = layer_at(k, state.gap);
    const auto given   = is_passing[link.pair] ?
                           layer_over(k, link.gap, state.gap, weight) :
                           at_end;
    state.pressure     = at_end.pressure;
    state.given        = given.pressure;
    state.energy       = at_end.potential;
    state.potential    = given.potential;
    state.end_gradient = -at_end.pressure * n;
    state.tangent      = given.stiffness * symmetrize(outer_product(n, n));
    state.curved       = -given.pressure * curvature;

    state.slip -= (state.slip * normals[l]) * normals[l];
    Tensor<1, dim> along_it;
    if (bounds[l] > 0)
      {
        state.shear          = friction_at(l, state.slip);
        state.friction       = state.shear.force.norm();
        const double sheared = state.friction / (friction_stiffness * k);
        const double energy =
          state.friction * (state.slip.norm() - 0.5 * sheared);
        along_it = state.shear.force;
        state.tangent += state.shear.tangent;
        state.energy += energy;
        state.potential += energy;
        state.end_gradient += along_it;
      }
    const auto &start          = starts[l];
    const auto  start_friction = start.gradient + start.pressure * link.normal;
    if (bounds[l] < 0)
      {
        along_it =
          bounds[l] / (link.friction * start.pressure) * start_friction;
        state.potential += along_it * way;
      }
    if (weight < 1)
      state.energy = at_end.potential +
                     (weight * along_it + (1 - weight) * start_friction) * way;
    state.gradient = along_it - given.pressure * n;
    return state;
  }

  template <int dim>
  typename Contact<dim>::State
  Contact<dim>::state_after(const unsigned int    l,
                            const Tensor<1, dim> &increment) const
  {
    const auto          &link   = all.links[l];
    const Point<dim>     place  = link.place + increment;
    const auto          &motion = motions[link.pair];
    const Tensor<1, dim> carried =
      link.obstacle != nullptr ? motion.increment_to(place) : Tensor<1, dim>();
    auto state    = state_at(l, increment - carried);
    state.place   = place;
    state.carried = carried;
    if (motion.turns())
      {
        const auto R    = motion.rotation();
        const auto turn = [&](const SymmetricTensor<2, dim> &tangent) {
          return symmetrize(R * Tensor<2, dim>(tangent) * transpose(R));
        };
        state.gradient     = R * state.gradient;
        state.end_gradient = R * state.end_gradient;
        state.tangent      = turn(state.tangent);
        state.curved       = turn(state.curved);
        state.slip         = R * state.slip;
      }
    return state;
  }

  template <int dim>
  Tensor<1, dim>
  Contact<dim>::increment_of(const ContactLink<dim> &link,
                             const Vector           &u) const
  {
    Tensor<1, dim> sum;
    for (unsigned int k = link.begin; k < link.end; ++k)
      for (unsigned int c = 0; c < dim; ++c)
        sum[c] += all.coefficients[k] * u.local_element(dim * all.nodes[k] + c);
    return sum;
  }

  template <int dim>
  Contact<dim>::Contact(ContactLinks<dim>      links,
                        FreeBodies<dim> *const free,
                        const double           weight,
                        const MPI_Comm         comm)
    : all(std::move(links))
    , weight(weight)
    , states(all.links.size())
    , starts(all.links.size())
    , free(free)
    , communicator(comm)
  {
    for (const auto &link : all.links)
      {
        bounds.push_back(link.friction_bound);
        normals.push_back(link.normal);
      }
    is_passing.resize(all.obstacles.size());
    for (unsigned int l = 0; l < all.links.size(); ++l)
      starts[l] = state_at(l, Tensor<1, dim>());
    is_passing = touches(starts);
    is_passing.flip();
    motions.resize(all.obstacles.size());
    if (free != nullptr)
      {
        // Nothing has moved yet.
        for (unsigned int q = 0; q < motions.size(); ++q)
          motions[q].centre = all.obstacles[q].motion.centre;
        for (unsigned int l = 0; l < states.size(); ++l)
          states[l] = state_after(l, Tensor<1, dim>());
        free->begin(loads_on_free_bodies());
      }
    for (unsigned int q = 0; q < motions.size(); ++q)
      motions[q] = all.obstacles[q].motion;
  }

  template <int dim>
  bool
  Contact<dim>::evaluate(const Vector &u, const bool /*with_tangent*/)
  {
    std::vector<Tensor<1, dim>> increments;
    for (const auto &link : all.links)
      increments.push_back(increment_of(link, u));
    if (free != nullptr)
      return settle(increments);
    for (unsigned int l = 0; l < states.size(); ++l)
      states[l] = state_after(l, increments[l]);
    return true;
  }

  template <int dim>
  void
  Contact<dim>::add(const unsigned int    l,
                    const Tensor<1, dim> &gradient,
                    Vector               &force) const
  {
    const auto &link = all.links[l];
    for (unsigned int k = link.begin; k < link.end; ++k)
      for (unsigned int c = 0; c < dim; ++c)
        force.local_element(dim * all.nodes[k] + c) +=
          link.area * all.coefficients[k] * gradient[c];
  }

  template <int dim>
  void
  Contact<dim>::add_force(const Vector & /*u*/, Vector &force) const
  {
    for (unsigned int l = 0; l < states.size(); ++l)
      add(l, states[l].gradient, force);
  }

  template <int dim>
  void
  Contact<dim>::add_end_force(const Vector & /*u*/, Vector &force) const
  {
    for (unsigned int l = 0; l < states.size(); ++l)
      add(l, states[l].end_gradient, force);
  }

  template <int dim>
  void
  Contact<dim>::add_start_force(Vector &force) const
  {
    for (unsigned int l = 0; l < states.size(); ++l)
      add(l, starts[l].gradient, force);
  }

  template <int dim>
  double
  Contact<dim>::energy(const Vector & /*u*/, const Vector & /*felt*/) const
  {
    double sum = 0;
    for (unsigned int l = 0; l < states.size(); ++l)
      sum += all.links[l].area * states[l].potential;
    if (free != nullptr && Utilities::MPI::this_mpi_process(communicator) == 0)
      sum += free->potential();
    return sum;
  }

  template <int dim>
  std::vector<double>
  Contact<dim>::squares_of_parts(const Vector       &u,
                                 const ResidualNorm &norm) const
  {
    // A gap is a difference of places.
    Vector parts;
    parts.reinit(u);
    for (unsigned int l = 0; l < states.size(); ++l)
      {
        const auto  &link = all.links[l];
        const double part =
          link.stiffness * (link.obstacle != nullptr ?
                              link.place.norm() :
                              link.gap + states[l].slip.norm());
        for (unsigned int k = link.begin; k < link.end; ++k)
          for (unsigned int c = 0; c < dim; ++c)
            parts.local_element(dim * all.nodes[k] + c) +=
              link.area * std::abs(all.coefficients[k]) * part;
      }
    parts.compress(VectorOperation::add);
    return norm.squares(parts);
  }

  template <int dim>
  void
  Contact<dim>::apply(const Vector &direction, Vector &image) const
  {
    for (unsigned int l = 0; l < states.size(); ++l)
      {
        const auto &link = all.links[l];
        add(l,
            (states[l].tangent + states[l].curved) *
              increment_of(link, direction),
            image);
      }
  }

  template <int dim>
  void
  Contact<dim>::add_matrix(const bool only_pattern, const TakeBlock &take) const
  {
    FullMatrix<double> block;
    for (unsigned int l = 0; l < states.size(); ++l)
      {
        const auto        &link = all.links[l];
        const unsigned int n    = link.end - link.begin;
        if (!only_pattern)
          {
            const auto tangent =
              link.area * (states[l].tangent + states[l].curved);
            block.reinit(dim * n, dim * n);
            for (unsigned int a = 0; a < n; ++a)
              for (unsigned int b = 0; b < n; ++b)
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int d = 0; d < dim; ++d)
                    block(dim * a + c, dim * b + d) =
                      all.coefficients[link.begin + a] *
                      all.coefficients[link.begin + b] * tangent[c][d];
          }
        take(make_array_view(all.nodes.begin() + link.begin,
                             all.nodes.begin() + link.end),
             block);
      }
  }

  template <int dim>
  void
  Contact<dim>::take_tangent()
  {
    at_tangent.resize(states.size());
    for (unsigned int l = 0; l < states.size(); ++l)
      at_tangent[l] = states[l].shear;
  }

  template <int dim>
  void
  Contact<dim>::project_tangent()
  {
    for (auto &state : states)
      state.curved = 0;
  }

  template <int dim>
  std::vector<bool>
  Contact<dim>::touches(const std::vector<State> &some) const
  {
    std::vector<unsigned int> n(all.obstacles.size());
    for (unsigned int l = 0; l < some.size(); ++l)
      n[all.links[l].pair] += some[l].pressure > 0;
    Utilities::MPI::sum(n, communicator, n);
    return {n.begin(), n.end()};
  }

  template <int dim>
  bool
  Contact<dim>::renew()
  {
    bool part = false;
    if (weight < 1)
      {
        const auto touch = touches(states);
        for (unsigned int q = 0; q < touch.size(); ++q)
          if (!is_passing[q] && !touch[q])
            is_passing[q] = part = true;
      }
    double sums[] = {0, 0}; // of changes, of all
    for (unsigned int l = 0; l < states.size(); ++l)
      {
        const auto  &link = all.links[l];
        const double bound =
          link.is_bond ? 0. : link.friction * states[l].given;
        sums[0] += link.area * std::abs(bound - bounds[l]);
        sums[1] += link.area * std::abs(bound);
        bounds[l] = bound;
        if (bound <= 0 || link.obstacle == nullptr ||
            !motions[link.pair].turns())
          continue;
        const auto &state = states[l];
        const auto  normal =
          link.obstacle->proximity(state.place - state.carried).normal;
        // Where it is another side of the body, it would go to and fro.
        if (normal * normals[l] < 0.5)
          continue;
        sums[0] += link.area * bound * (normal - normals[l]).norm();
        normals[l] = normal;
      }
    Utilities::MPI::sum(sums, communicator, sums);
    return part || sums[0] > tolerance * sums[1];
  }

  template class Contact<2>;
  template class Contact<3>;
} // namespace impm
