#ifndef impm_solve_coarse_unknowns_h
#define impm_solve_coarse_unknowns_h

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace impm
{
  /**
   * Numbers unknowns that every rank knows by key, their place on a lattice,
   * where several ranks want the same ones. Each belongs to the first rank that
   * wants it; the numbers of a rank follow each other in the order of the keys.
   */
  class CoarseUnknowns
  {
  public:
    using Key    = std::uint64_t;
    using Number = dealii::types::global_dof_index;

    /** Keys with what is wanted there: an extent, of which the smallest counts.
     */
    using Wanted = std::unordered_map<Key, int>;

    /** Of what is wanted, but for keys that some rank excludes. Collective. */
    CoarseUnknowns(const Wanted           &wanted,
                   const std::vector<Key> &excluded,
                   MPI_Comm                communicator);

    /** Of one that this rank wants; none if it is excluded. */
    Number
    number(const Key key) const
    {
      const auto found = numbers.find(key);
      return found == numbers.end() ? none : found->second;
    }

    static constexpr Number none = -1;

    // What this rank owns, in the order of the numbers.
    std::vector<Key> keys;
    std::vector<int> extents;
    dealii::IndexSet owned;

  private:
    /** What this rank owns of it. Collective. */
    Wanted
    share_out(const Wanted           &wanted,
              const std::vector<Key> &excluded,
              MPI_Comm                communicator) const;

    /** Finds the numbers of what others own. Collective. */
    void
    ask_others(const Wanted &wanted, MPI_Comm communicator);

    std::unordered_map<Key, Number> numbers;
  };
} // namespace impm

#endif
