#include <impm/footprints/approach.h>

#include <algorithm>
#include <limits>
#include <set>

namespace impm
{
  using namespace dealii;

  namespace
  {
    constexpr double none = std::numeric_limits<double>::max();

    /** Lowest and highest number of those that touch a node of any layer; in
     * the first component of that in the first. Ghosts are up to date. */
    template <int dim>
    struct Touched
    {
      explicit Touched(const Discretization<dim> &discretization)
      {
        discretization.initialize(least);
        discretization.initialize(most);
        for (unsigned int i = 0; i < discretization.node_positions.size(); ++i)
          {
            least.local_element(dim * i) = none;
            most.local_element(dim * i)  = -1;
          }
      }

      void
      add(const unsigned int node, const double lower, const double upper)
      {
        double &low  = least.local_element(dim * node);
        double &high = most.local_element(dim * node);
        low          = std::min(low, lower);
        high         = std::max(high, upper);
      }

      void
      exchange()
      {
        least.compress(VectorOperation::min);
        most.compress(VectorOperation::max);
        least.update_ghost_values();
        most.update_ghost_values();
      }

      /** First is `none` if nothing touches the node. */
      std::pair<double, double>
      operator[](const unsigned int node) const
      {
        return {least.local_element(dim * node),
                most.local_element(dim * node)};
      }

      Vector least, most;
    };

    using Pair  = std::pair<double, double>;
    using Pairs = std::set<Pair>;

    /** Lowest and highest number at each node that anything touches, on any
     * rank. */
    template <int dim>
    Pairs
    find_pairs(const Touched<dim>        &touched,
               const Discretization<dim> &discretization)
    {
      Pairs pairs;
      for (unsigned int i = 0;
           dim * i < discretization.locally_owned_dofs().n_elements();
           ++i)
        if (const Pair pair = touched[i]; pair.first != none)
          pairs.insert(pair);
      const std::vector<Pair> mine(pairs.begin(), pairs.end());
      for (const auto &of_rank :
           Utilities::MPI::all_gather(discretization.communicator, mine))
        pairs.insert(of_rank.begin(), of_rank.end());
      return pairs;
    }

    /** Those that touch a node touch all of its cells, too. */
    template <int dim>
    Touched<dim>
    spread(const Touched<dim>        &touched,
           const Discretization<dim> &discretization)
    {
      Touched<dim> wider(discretization);
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const auto nodes = discretization.nodes_of(cell, 0);
            Pair       pair(none, -1);
            for (const auto node : nodes)
              pair = {std::min(pair.first, touched[node].first),
                      std::max(pair.second, touched[node].second)};
            for (const auto node : nodes)
              wider.add(node, pair.first, pair.second);
          }
      wider.exchange();
      return wider;
    }
  } // namespace

  template <int dim>
  Approach
  find_approach(const MaterialPoints<dim>  &points,
                const Footprints<dim>      &footprints,
                const Discretization<dim>  &discretization,
                const StepConstraints<dim> &constraints)
  {
    const unsigned int n_bodies = points.n_bodies();
    // Carriers count behind the bodies.
    Touched<dim> touched(discretization);
    for (const auto &cell : footprints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          if (footprints.touches(e, n))
            {
              const double body = points.body(footprints.point[e]);
              touched.add(discretization.in_first_layer(cell.nodes[n]),
                          body,
                          body);
            }
    for (unsigned int i = 0;
         i < discretization.locally_owned_dofs().n_elements();
         ++i)
      if (const auto wall = constraints.wall[i];
          wall != StepConstraints<dim>::no_carrier)
        touched.add(discretization.in_first_layer(i / dim),
                    n_bodies + wall,
                    n_bodies + wall);
    touched.exchange();

    const Pairs meet = find_pairs(touched, discretization),
                near =
                  find_pairs(spread(touched, discretization), discretization);
    std::set<double> all;
    for (const auto &pair : meet)
      all.insert({pair.first, pair.second});
    Approach approach;
    for (const auto &pair : meet)
      approach.bodies_touch =
        approach.bodies_touch ||
        (pair.first < pair.second && pair.second < n_bodies);
    for (const double body : all)
      for (const double other : all)
        if (const Pair pair(body, other);
            body < n_bodies && body < other && meet.count(pair) == 0)
          {
            Distance &distance =
              other < n_bodies ? approach.of_bodies : approach.to_walls;
            if (near.count(pair) > 0)
              distance = Distance::near;
            else if (distance == Distance::none)
              distance = Distance::far;
          }
    return approach;
  }

  template decltype(find_approach<2>) find_approach<2>;
  template decltype(find_approach<3>) find_approach<3>;
} // namespace impm
