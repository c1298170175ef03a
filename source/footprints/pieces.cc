#include <impm/footprints/pieces.h>

#include <boost/pending/disjoint_sets.hpp>

#include <limits>
#include <numeric>

namespace impm
{
  using namespace dealii;

  template <int dim>
  std::vector<unsigned int>
  count_pieces(const MaterialPoints<dim> &points,
               const Footprints<dim>     &footprints,
               const Discretization<dim> &discretization,
               const unsigned int         n_bodies)
  {
    const auto        &numbering = *discretization.numbering;
    const unsigned int n_nodes   = discretization.node_positions.size();
    const double       none      = std::numeric_limits<double>::max();
    Vector             label; // of a node, in its first component
    discretization.initialize(label);
    const auto &partitioner = *numbering.partitioner;

    std::vector<unsigned int> ranks(n_nodes), parents(n_nodes), result;
    for (unsigned int body = 0; body < n_bodies; ++body)
      {
        std::fill(ranks.begin(), ranks.end(), 0);
        std::iota(parents.begin(), parents.end(), 0);
        boost::disjoint_sets<unsigned int *, unsigned int *> sets(
          ranks.data(), parents.data());
        std::vector<char> is_used(n_nodes);
        for (const auto &cell : footprints.cells)
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            {
              if (points.body(footprints.point[e]) != body)
                continue;
              unsigned int first = numbers::invalid_unsigned_int;
              const auto   join  = [&](const unsigned int node) {
                is_used[node] = true;
                if (first != numbers::invalid_unsigned_int)
                  sets.union_set(first, node);
                first = node;
              };
              for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
                if (footprints.touches(e, n))
                  {
                    join(cell.nodes[n]);
                    if (!numbering.masters.empty())
                      for (const auto &master :
                           numbering.masters[cell.nodes[n]])
                        join(master.first);
                  }
            }

        // Sets that ranks share take the smallest label of theirs until none
        // changes.
        std::vector<double> label_of_set(n_nodes, none);
        const auto          number = [&](const unsigned int node) -> double {
          return partitioner.local_to_global(dim * node);
        };
        for (unsigned int node = 0; node < n_nodes; ++node)
          if (is_used[node])
            {
              double &of_set = label_of_set[sets.find_set(node)];
              of_set         = std::min(of_set, number(node));
            }
        for (bool changes = true; changes;)
          {
            label.zero_out_ghost_values();
            for (unsigned int node = 0; node < n_nodes; ++node)
              label.local_element(dim * node) =
                is_used[node] ? label_of_set[sets.find_set(node)] : none;
            label.compress(VectorOperation::min);
            label.update_ghost_values();
            changes = false;
            for (unsigned int node = 0; node < n_nodes; ++node)
              if (is_used[node])
                {
                  double &of_set = label_of_set[sets.find_set(node)];
                  if (label.local_element(dim * node) < of_set)
                    {
                      of_set  = label.local_element(dim * node);
                      changes = true;
                    }
                }
            changes =
              Utilities::MPI::max(changes ? 1 : 0, points.communicator) == 1;
          }
        // Each set has one node with its own number, on the rank that owns it.
        unsigned int n = 0;
        for (unsigned int node = 0;
             dim * node < discretization.locally_owned_dofs().n_elements();
             ++node)
          n += label.local_element(dim * node) == number(node);
        result.push_back(Utilities::MPI::sum(n, points.communicator));
      }
    return result;
  }

  template decltype(count_pieces<2>) count_pieces<2>;
  template decltype(count_pieces<3>) count_pieces<3>;
} // namespace impm
