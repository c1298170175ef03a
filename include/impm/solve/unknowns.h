#ifndef impm_solve_unknowns_h
#define impm_solve_unknowns_h

#include <deal.II/base/partitioner.h>

#include <impm/base/vector.h>

#include <memory>
#include <utility>
#include <vector>

namespace impm
{
  /**
   * What a linear system is solved for: the values of those nodes of which any
   * is free, numbered anew without a gap. Nodes that no material touches, that
   * hang or are held altogether have no row; a value that is held beside a free
   * one has a row of its own, decoupled from all others. Vectors of all nodes
   * are called full here, those of the unknowns compact.
   */
  class Unknowns
  {
  public:
    using Number = dealii::types::global_dof_index;

    /** Nodes that a hanging one follows, with their weights. */
    using Masters = std::vector<std::pair<unsigned int, double>>;

    /**
     * Of full vectors with so many values a node, of which some are held, by
     * local index. `masters` are those of each local node, none where it does
     * not hang, or an empty list if none does. All that is referred to must
     * live as long. Collective.
     */
    Unknowns(
      const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &all,
      const std::vector<char>                                          &is_held,
      const std::vector<Masters>                                       &masters,
      unsigned int n_components);

    /** A compact vector, zero. */
    void
    initialize(Vector &compact) const
    {
      compact.reinit(partitioner);
    }

    void
    pack(const Vector &full, Vector &compact) const;

    /** Zero where there is no unknown. */
    void
    unpack(const Vector &compact, Vector &full) const;

    /** Whether a value is held, by owned compact index. */
    bool
    is_held(const unsigned int index) const
    {
      return held[n_components * nodes[index / n_components] +
                  index % n_components];
    }

    /** On this rank. */
    unsigned int
    n_owned() const
    {
      return n_components * nodes.size();
    }

    /** Of all ranks. */
    Number
    size() const
    {
      return partitioner->size();
    }

    static constexpr Number none = -1;

    const unsigned int                                         n_components;
    const std::vector<char>                                   &held;
    const std::vector<Masters>                                &masters;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;

    std::vector<unsigned int> nodes; ///< owned ones that have unknowns
    /** The first unknown of every local node, or none. */
    std::vector<Number> first;
  };
} // namespace impm

#endif
