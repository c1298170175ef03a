#include <deal.II/base/mpi.h>

#include <impm/solve/remote_rows.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  void
  RemoteRows::exchange_pattern(const Unknowns         &unknowns,
                               const IndexSet         &known,
                               DynamicSparsityPattern &pairs)
  {
    n_components            = unknowns.n_components;
    communicator            = unknowns.partitioner->get_mpi_communicator();
    const IndexSet &is_here = unknowns.partitioner->locally_owned_range();
    // Those of nodes, by their first unknowns.
    IndexSet elsewhere(unknowns.size());
    for (const auto row : known)
      if (!is_here.is_element(n_components * row) && pairs.row_length(row) > 0)
        elsewhere.add_index(n_components * row);
    elsewhere.compress();
    const auto owners =
      Utilities::MPI::compute_index_owner(is_here, elsewhere, communicator);

    std::map<unsigned int, std::vector<Number>> outgoing;
    unsigned int                                n_values = 0, i = 0;
    for (const auto index : elsewhere)
      {
        Row row{index / n_components, n_values, {}};
        for (unsigned int k = 0; k < pairs.row_length(row.number); ++k)
          row.columns.push_back(pairs.column_number(row.number, k));
        const unsigned int owner = owners[i++];
        parts.try_emplace(owner, n_values, n_values);
        n_values += n_components * n_components * row.columns.size();
        parts[owner].second = n_values;
        auto &message       = outgoing[owner];
        message.push_back(row.number);
        message.push_back(row.columns.size());
        message.insert(message.end(), row.columns.begin(), row.columns.end());
        rows.push_back(std::move(row));
      }
    values.resize(n_values);
    incoming = Utilities::MPI::some_to_some(communicator, outgoing);
    for (const auto &[rank, message] : incoming)
      for (auto entry = message.begin(); entry != message.end();)
        {
          const auto row   = entry[0];
          const auto begin = entry + 2;
          entry            = begin + entry[1];
          pairs.add_entries(row, begin, entry, true);
        }
  }

  void
  RemoteRows::find_places(
    const std::function<unsigned int(Number row, Number column)> &place,
    const std::function<unsigned int(Number row)>                &row_length)
  {
    for (const auto &[rank, message] : incoming)
      for (auto entry = message.begin(); entry != message.end();)
        {
          const auto row   = entry[0];
          const auto begin = entry + 2;
          entry            = begin + entry[1];
          for (unsigned int c = 0; c < n_components; ++c)
            for (auto column = begin; column != entry; ++column)
              incoming_places[rank].push_back(place(row, *column) +
                                              c * row_length(row));
        }
  }

  const RemoteRows::Row &
  RemoteRows::find(const Number row) const
  {
    return *std::lower_bound(rows.begin(),
                             rows.end(),
                             row,
                             [](const Row &other, const Number number) {
                               return other.number < number;
                             });
  }

  unsigned int
  RemoteRows::place(const Number row, const Number column) const
  {
    const Columns &columns = find(row).columns;
    return std::lower_bound(columns.begin(), columns.end(), column) -
           columns.begin();
  }

  void
  RemoteRows::exchange_values(double *entries)
  {
    std::map<unsigned int, std::vector<double>> outgoing;
    for (const auto &[rank, part] : parts)
      outgoing[rank].assign(values.begin() + part.first,
                            values.begin() + part.second);
    for (const auto &[rank, message] :
         Utilities::MPI::some_to_some(communicator, outgoing))
      {
        auto value = message.begin();
        for (const unsigned int place : incoming_places.at(rank))
          for (unsigned int d = 0; d < n_components; ++d)
            entries[place + d] += *value++;
      }
    std::fill(values.begin(), values.end(), 0.);
  }
} // namespace impm
