#include <impm/base/memory.h>
#include <impm/solve/trilinos_matrix.h>

#include <Epetra_CrsGraph.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** What Trilinos returns. */
    void
    check(const int error)
    {
      AssertThrow(error == 0, ExcInternalError());
    }
  } // namespace

  SparseMatrix::SparseMatrix(const Unknowns &unknowns)
    : unknowns(unknowns)
    , trilinos(std::make_unique<Trilinos>())
    , is_parallel(Utilities::MPI::n_mpi_processes(
                    unknowns.partitioner->get_mpi_communicator()) > 1)
  {}

  SparseMatrix::~SparseMatrix() = default;

  unsigned int
  SparseMatrix::place_in(const Block &block, const unsigned int node) const
  {
    const auto begin = block_nodes.begin() + block.begin;
    return std::find(begin, block_nodes.begin() + block.end, node) - begin;
  }

  void
  SparseMatrix::add_to_pattern(const Nodes &nodes)
  {
    const auto &masters = unknowns.masters;
    const auto &held    = unknowns.held;
    Block       block;
    block.begin        = block_nodes.size();
    block.begin_places = n_places_of_blocks;
    block.end          = block.begin;
    for (const unsigned int node : nodes)
      block.any_hangs =
        block.any_hangs || (!masters.empty() && !masters[node].empty());
    const auto append = [&](const unsigned int node) {
      block_nodes.push_back(node);
      ++block.end;
      const unsigned int n = unknowns.n_components;
      block.any_held =
        block.any_held || std::any_of(held.begin() + n * node,
                                      held.begin() + n * (node + 1),
                                      [](const char is) { return is != 0; });
    };
    const auto append_once = [&](const unsigned int node) {
      if (place_in(block, node) == block.end - block.begin)
        append(node);
    };
    for (const unsigned int node : nodes)
      if (!block.any_hangs)
        append(node);
      else if (masters[node].empty())
        append_once(node);
      else
        for (const auto &[master, weight] : masters[node])
          append_once(master);
    const std::size_t n = block.end - block.begin;
    n_places_of_blocks += n * n;
    blocks.push_back(block);
  }

  DynamicSparsityPattern
  SparseMatrix::couple_nodes()
  {
    const unsigned int n_components = unknowns.n_components;
    const auto        &first        = unknowns.first;

    // Rows that this rank owns, or writes to.
    const auto n_nodes = unknowns.size() / n_components;
    IndexSet   known(n_nodes);
    for (const auto number : first)
      if (number != Unknowns::none)
        known.add_index(number / n_components);
    known.compress();
    DynamicSparsityPattern        pairs(n_nodes, n_nodes, known);
    std::vector<Unknowns::Number> columns;
    for (const auto &block : blocks)
      {
        columns.clear();
        for (unsigned int i = block.begin; i < block.end; ++i)
          if (first[block_nodes[i]] != Unknowns::none)
            columns.push_back(first[block_nodes[i]] / n_components);
        std::sort(columns.begin(), columns.end());
        for (const auto row : columns)
          pairs.add_entries(row, columns.begin(), columns.end(), true);
      }
    for (const unsigned int node : unknowns.nodes)
      pairs.add(first[node] / n_components, first[node] / n_components);
    if (is_parallel)
      remote_rows.exchange_pattern(unknowns, known, pairs);
    return pairs;
  }

  void
  SparseMatrix::end_pattern()
  {
    using Index                     = TrilinosWrappers::types::int_type;
    const unsigned int n_components = unknowns.n_components;
    const auto        &first        = unknowns.first;
    const unsigned int n_rows       = unknowns.n_owned();
    blocks.shrink_to_fit();
    block_nodes.shrink_to_fit();
    const auto pairs       = couple_nodes();
    const auto add_columns = [&](const unsigned int node, auto add) {
      const auto row = first[node] / n_components;
      for (unsigned int k = 0; k < pairs.row_length(row); ++k)
        add(n_components * pairs.column_number(row, k));
    };

    // Left to Trilinos, the columns of a node on another rank would not be
    // neighbours.
    for (const unsigned int node : unknowns.nodes)
      add_columns(node, [&](const auto column) {
        if (!unknowns.partitioner->in_local_range(column))
          remote_columns.push_back(column);
      });
    std::sort(remote_columns.begin(), remote_columns.end());
    remote_columns.erase(std::unique(remote_columns.begin(),
                                     remote_columns.end()),
                         remote_columns.end());
    std::vector<Index> column_numbers;
    const auto         append = [&](const auto number) {
      for (unsigned int c = 0; c < n_components; ++c)
        column_numbers.push_back(number + c);
    };
    for (const unsigned int node : unknowns.nodes)
      append(first[node]);
    for (const auto number : remote_columns)
      append(number);

    std::vector<int> lengths;
    for (const unsigned int node : unknowns.nodes)
      lengths.insert(lengths.end(),
                     n_components,
                     n_components *
                       pairs.row_length(first[node] / n_components));
    const Epetra_MpiComm communicator(
      unknowns.partitioner->get_mpi_communicator());
    const Epetra_Map rows(static_cast<Index>(unknowns.size()),
                          static_cast<int>(n_rows),
                          0,
                          communicator);
    const Epetra_Map columns(static_cast<Index>(-1),
                             static_cast<int>(column_numbers.size()),
                             column_numbers.data(),
                             0,
                             communicator);
    Epetra_CrsGraph  graph(Copy, rows, columns, lengths.data(), true);
    std::vector<int> in_row;
    int              row = 0;
    for (const unsigned int node : unknowns.nodes)
      {
        in_row.clear();
        add_columns(node, [&](const auto column) {
          for (unsigned int c = 0; c < n_components; ++c)
            in_row.push_back(local_column(column) + c);
        });
        std::sort(in_row.begin(), in_row.end());
        for (unsigned int c = 0; c < n_components; ++c, ++row)
          check(graph.InsertMyIndices(row, lengths[row], in_row.data()));
      }
    check(graph.FillComplete(rows, rows));
    check(graph.OptimizeStorage());
    // A view has no values of its own: the ones that count come with reinit().
    trilinos->matrix.reinit(Epetra_CrsMatrix(View, graph), false);
    find_places();
  }

  int
  SparseMatrix::local_column(const Unknowns::Number number) const
  {
    const auto &partitioner = *unknowns.partitioner;
    if (partitioner.in_local_range(number))
      return partitioner.global_to_local(number);
    const auto found =
      std::lower_bound(remote_columns.begin(), remote_columns.end(), number);
    return unknowns.n_owned() +
           unknowns.n_components * (found - remote_columns.begin());
  }

  void
  SparseMatrix::find_places()
  {
    const unsigned int n_components = unknowns.n_components;
    const auto        &partitioner  = *unknowns.partitioner;
    const auto        &matrix       = trilinos->matrix.trilinos_matrix();
    int               *starts, *columns;
    check(matrix.ExtractCrsDataPointers(starts, columns, values));
    row_starts = starts;

    const auto place_in_row = [&](const unsigned int row, const int column) {
      const int *begin = columns + row_starts[row];
      const int *end   = columns + row_starts[row + 1];
      const int *found = std::lower_bound(begin, end, column);
      AssertThrow(found != end && *found == column, ExcInternalError());
      return found - begin;
    };
    const auto append = [&](const unsigned int place) {
      AssertThrow(place < no_place, ExcInternalError());
      places.push_back(place);
    };
    for (unsigned int i = 0; i < unknowns.n_owned(); ++i)
      diagonal_places.push_back(row_starts[i] + place_in_row(i, i));
    places.reserve(n_places_of_blocks);
    for (const auto &block : blocks)
      for (unsigned int i = block.begin; i < block.end; ++i)
        {
          const auto row = unknowns.first[block_nodes[i]];
          const bool is_here =
            row != Unknowns::none && partitioner.in_local_range(row);
          for (unsigned int j = block.begin; j < block.end; ++j)
            if (const auto column = unknowns.first[block_nodes[j]];
                row == Unknowns::none || column == Unknowns::none)
              places.push_back(no_place);
            else if (is_here)
              append(place_in_row(partitioner.global_to_local(row),
                                  local_column(column)) /
                     n_components);
            else
              append(
                remote_rows.place(row / n_components, column / n_components));
        }
    remote_rows.find_places(
      [&](const auto row, const auto column) {
        const auto first = partitioner.global_to_local(n_components * row);
        return row_starts[first] +
               place_in_row(first, local_column(n_components * column));
      },
      [&](const auto row) {
        return row_length(partitioner.global_to_local(n_components * row));
      });
  }

  void
  SparseMatrix::set_zero()
  {
    trilinos->matrix = 0;
    next_block       = 0;
  }

  void
  SparseMatrix::add_block(const Nodes &nodes, FullMatrix<double> &block)
  {
    AssertIndexRange(next_block, blocks.size());
    const Block &where = blocks[next_block++];
    Assert(where.any_hangs || std::equal(nodes.begin(),
                                         nodes.end(),
                                         block_nodes.begin() + where.begin,
                                         block_nodes.begin() + where.end),
           ExcMessage("blocks come in another order than in the pattern"));
    auto *entries = &block;
    if (where.any_hangs)
      {
        eliminate_hanging(where, nodes, block, eliminated);
        entries = &eliminated;
      }
    const unsigned int n_components = unknowns.n_components;
    if (where.any_held)
      for (unsigned int i = 0; i < entries->m(); ++i)
        if (unknowns
              .held[n_components * block_nodes[where.begin + i / n_components] +
                    i % n_components])
          for (unsigned int j = 0; j < entries->n(); ++j)
            (*entries)(i, j) = (*entries)(j, i) = 0;
    if (n_components == 2)
      add_entries<2>(where, *entries);
    else
      add_entries<3>(where, *entries);
  }

  void
  SparseMatrix::eliminate_hanging(const Block              &block,
                                  const Nodes              &nodes,
                                  const FullMatrix<double> &before,
                                  FullMatrix<double>       &after) const
  {
    const unsigned int             n_components = unknowns.n_components;
    std::vector<Unknowns::Masters> parts(nodes.size());
    for (unsigned int a = 0; a < nodes.size(); ++a)
      if (const auto &masters = unknowns.masters[nodes[a]]; masters.empty())
        parts[a] = {{place_in(block, nodes[a]), 1.}};
      else
        for (const auto &[master, weight] : masters)
          parts[a].emplace_back(place_in(block, master), weight);
    const unsigned int n = n_components * (block.end - block.begin);
    after.reinit(n, n);
    for (unsigned int a = 0; a < nodes.size(); ++a)
      for (unsigned int b = 0; b < nodes.size(); ++b)
        for (const auto &[i, row_weight] : parts[a])
          for (const auto &[j, column_weight] : parts[b])
            for (unsigned int c = 0; c < n_components; ++c)
              for (unsigned int d = 0; d < n_components; ++d)
                after(n_components * i + c, n_components * j + d) +=
                  row_weight * column_weight *
                  before(n_components * a + c, n_components * b + d);
  }

  template <unsigned int n_components>
  void
  SparseMatrix::add_entries(const Block              &block,
                            const FullMatrix<double> &entries)
  {
    const unsigned int n     = block.end - block.begin;
    const auto        *place = &places[block.begin_places];
    for (unsigned int i = 0; i < n; ++i)
      {
        const auto row = unknowns.first[block_nodes[block.begin + i]];
        if (row == Unknowns::none)
          {
            place += n;
            continue;
          }
        double      *target; // the first of the rows
        unsigned int length;
        if (unknowns.partitioner->in_local_range(row))
          {
            const auto r = unknowns.partitioner->global_to_local(row);
            target       = values + row_starts[r];
            length       = row_length(r);
          }
        else
          {
            const auto &remote = remote_rows.find(row / n_components);
            target             = remote_rows.values.data() + remote.begin;
            length             = n_components * remote.columns.size();
          }
        for (unsigned int j = 0; j < n; ++j, ++place)
          if (*place != no_place)
            for (unsigned int c = 0; c < n_components; ++c)
              for (unsigned int d = 0; d < n_components; ++d)
                target[n_components * *place + c * length + d] +=
                  entries(n_components * i + c, n_components * j + d);
      }
  }

  void
  SparseMatrix::end_blocks()
  {
    AssertThrow(next_block == blocks.size(), ExcInternalError());
    if (is_parallel)
      remote_rows.exchange_values(values);
  }

  void
  SparseMatrix::get_diagonal(Vector &diagonal) const
  {
    if (values != nullptr)
      for (unsigned int i = 0; i < diagonal_places.size(); ++i)
        diagonal.local_element(i) = values[diagonal_places[i]];
    else
      {
        const auto   &matrix = trilinos->matrix.trilinos_matrix();
        Epetra_Vector view(View, matrix.RowMap(), diagonal.begin());
        matrix.ExtractDiagonalCopy(view);
      }
  }

  void
  SparseMatrix::set_diagonal(const Vector &diagonal)
  {
    if (values != nullptr)
      for (unsigned int i = 0; i < diagonal_places.size(); ++i)
        values[diagonal_places[i]] = diagonal.local_element(i);
    else
      {
        // deal.II sets entries one by one.
        auto &matrix =
          const_cast<Epetra_CrsMatrix &>(trilinos->matrix.trilinos_matrix());
        matrix.ReplaceDiagonalValues(Epetra_Vector(
          Copy, matrix.RowMap(), const_cast<double *>(diagonal.begin())));
      }
  }

  void
  SparseMatrix::vmult(Vector &dst, const Vector &src) const
  {
    trilinos->matrix.vmult(dst, src);
  }

  std::size_t
  SparseMatrix::memory_consumption() const
  {
    return trilinos->matrix.memory_consumption() +
           bytes_of(blocks, block_nodes, places, diagonal_places) +
           bytes_of(remote_rows.values, remote_columns);
  }

  void
  SparseMatrix::multiply(const SparseMatrix &A,
                         const Vector       &D,
                         const SparseMatrix &B)
  {
    TrilinosWrappers::MPI::Vector scaling(D.locally_owned_elements(),
                                          D.get_mpi_communicator());
    std::copy(D.begin(), D.end(), scaling.begin());
    ++n_places;
    values = nullptr;
    A.trilinos->matrix.mmult(trilinos->matrix, B.trilinos->matrix, scaling);
  }
} // namespace impm
