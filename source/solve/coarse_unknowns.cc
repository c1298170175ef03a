#include <impm/solve/coarse_unknowns.h>

#include <algorithm>
#include <array>
#include <map>

namespace impm
{
  using namespace dealii;

  namespace
  {
    using Key = CoarseUnknowns::Key;

    /** Every key is kept by one rank, to which all turn who mind it. */
    unsigned int
    keeper_of(const Key key, const MPI_Comm communicator)
    {
      return (key * 0x9e3779b97f4a7c15ull >> 32) %
             Utilities::MPI::n_mpi_processes(communicator);
    }

    using Lists = std::vector<std::vector<Key>>;

    /** Appends a key, and what goes with it, to the message for its keeper. */
    void
    append(std::map<unsigned int, Lists> &messages,
           const unsigned int             rank,
           const unsigned int             list,
           const std::array<Key, 2>      &values)
    {
      auto &lists = messages[rank];
      lists.resize(3);
      lists[list].push_back(values[0]);
      lists[list].push_back(values[1]);
    }
  } // namespace

  CoarseUnknowns::CoarseUnknowns(const Wanted           &wanted,
                                 const std::vector<Key> &excluded,
                                 const MPI_Comm          communicator)
  {
    const Wanted mine = share_out(wanted, excluded, communicator);
    for (const auto &[key, extent] : mine)
      keys.push_back(key);
    std::sort(keys.begin(), keys.end());
    for (const Key key : keys)
      extents.push_back(mine.at(key));

    owned = Utilities::MPI::create_ascending_partitioning(
      communicator,
      keys.size())[Utilities::MPI::this_mpi_process(communicator)];
    numbers.reserve(wanted.size());
    for (unsigned int i = 0; i < keys.size(); ++i)
      numbers[keys[i]] = owned.nth_index_in_set(i);
    if (Utilities::MPI::n_mpi_processes(communicator) > 1)
      ask_others(wanted, communicator);
  }

  CoarseUnknowns::Wanted
  CoarseUnknowns::share_out(const Wanted           &wanted,
                            const std::vector<Key> &excluded,
                            const MPI_Comm          communicator) const
  {
    if (Utilities::MPI::n_mpi_processes(communicator) == 1)
      {
        Wanted result = wanted;
        for (const Key key : excluded)
          result.erase(key);
        return result;
      }
    std::map<unsigned int, Lists> requests;
    for (const auto &[key, extent] : wanted)
      append(requests, keeper_of(key, communicator), 0, {{key, Key(extent)}});
    for (const Key key : excluded)
      append(requests, keeper_of(key, communicator), 1, {{key, 0}});
    const auto received = Utilities::MPI::some_to_some(communicator, requests);

    // In the order of the ranks: the first one gets it.
    struct Owner
    {
      unsigned int rank;
      int          extent;
    };
    std::unordered_map<Key, Owner> owners;
    for (const auto &[rank, lists] : received)
      for (unsigned int i = 0; i < lists[0].size(); i += 2)
        {
          const int extent = lists[0][i + 1];
          auto     &owner =
            owners.insert({lists[0][i], {rank, extent}}).first->second;
          owner.extent = std::min(owner.extent, extent);
        }
    for (const auto &[rank, lists] : received)
      for (unsigned int i = 0; i < lists[1].size(); i += 2)
        owners.erase(lists[1][i]);
    std::map<unsigned int, Lists> shares;
    for (const auto &[key, owner] : owners)
      append(shares, owner.rank, 0, {{key, Key(owner.extent)}});

    Wanted result;
    for (const auto &[rank, lists] :
         Utilities::MPI::some_to_some(communicator, shares))
      for (unsigned int i = 0; i < lists[0].size(); i += 2)
        result[lists[0][i]] = lists[0][i + 1];
    return result;
  }

  void
  CoarseUnknowns::ask_others(const Wanted &wanted, const MPI_Comm communicator)
  {
    // Owners tell the keepers, who are asked for what is not owned.
    std::map<unsigned int, Lists> messages;
    for (const Key key : keys)
      append(messages,
             keeper_of(key, communicator),
             0,
             {{key, numbers.at(key)}});
    for (const auto &[key, extent] : wanted)
      if (numbers.count(key) == 0)
        append(messages, keeper_of(key, communicator), 1, {{key, 0}});
    const auto received = Utilities::MPI::some_to_some(communicator, messages);

    std::unordered_map<Key, Number> kept;
    for (const auto &[rank, lists] : received)
      for (unsigned int i = 0; i < lists[0].size(); i += 2)
        kept[lists[0][i]] = lists[0][i + 1];
    std::map<unsigned int, Lists> answers;
    for (const auto &[rank, lists] : received)
      for (unsigned int i = 0; i < lists[1].size(); i += 2)
        {
          const auto found = kept.find(lists[1][i]);
          if (found != kept.end())
            append(answers, rank, 0, {{found->first, found->second}});
        }
    for (const auto &[rank, lists] :
         Utilities::MPI::some_to_some(communicator, answers))
      for (unsigned int i = 0; i < lists[0].size(); i += 2)
        numbers[lists[0][i]] = lists[0][i + 1];
  }
} // namespace impm
