#include <impm/solve/unknowns.h>

namespace impm
{
  using namespace dealii;

  Unknowns::Unknowns(
    const std::shared_ptr<const Utilities::MPI::Partitioner> &all,
    const std::vector<char>                                  &is_held,
    const std::vector<Masters>                               &masters,
    const unsigned int                                        n_components)
    : n_components(n_components)
    , held(is_held)
    , masters(masters)
    , first((all->locally_owned_size() + all->n_ghost_indices()) / n_components,
            none)
  {
    for (unsigned int n = 0; n < all->locally_owned_size() / n_components; ++n)
      for (unsigned int c = 0; c < n_components; ++c)
        if (!held[n_components * n + c])
          {
            nodes.push_back(n);
            break;
          }
    const MPI_Comm communicator = all->get_mpi_communicator();
    const auto     owned        = Utilities::MPI::create_ascending_partitioning(
      communicator, n_owned())[Utilities::MPI::this_mpi_process(communicator)];
    partitioner =
      std::make_shared<Utilities::MPI::Partitioner>(owned, communicator);

    // Ghosts learn theirs through a vector, where zero is none.
    Vector numbers(all);
    for (unsigned int i = 0; i < nodes.size(); ++i)
      numbers.local_element(n_components * nodes[i]) =
        owned.nth_index_in_set(n_components * i) + 1.;
    numbers.update_ghost_values();
    for (unsigned int n = 0; n < first.size(); ++n)
      if (const double number = numbers.local_element(n_components * n);
          number > 0)
        first[n] = static_cast<Number>(number) - 1;
  }

  void
  Unknowns::pack(const Vector &full, Vector &compact) const
  {
    unsigned int i = 0;
    for (const unsigned int node : nodes)
      for (unsigned int c = 0; c < n_components; ++c)
        compact.local_element(i++) =
          full.local_element(n_components * node + c);
  }

  void
  Unknowns::unpack(const Vector &compact, Vector &full) const
  {
    full           = 0;
    unsigned int i = 0;
    for (const unsigned int node : nodes)
      for (unsigned int c = 0; c < n_components; ++c)
        full.local_element(n_components * node + c) =
          compact.local_element(i++);
  }
} // namespace impm
