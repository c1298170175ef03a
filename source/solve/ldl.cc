#include <deal.II/base/mpi.h>

#include <impm/solve/ldl.h>
#include <impm/solve/trilinos_matrix.h>

#include <Epetra_CrsMatrix.h>
#include <cholmod.h>

#include <algorithm>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** How many values each rank has, and where they begin on the first. */
    struct Shares
    {
      Shares(const int n, const MPI_Comm communicator)
        : sizes(Utilities::MPI::gather(communicator, n))
        , begins(sizes.size(), 0)
      {
        if (!sizes.empty())
          std::partial_sum(sizes.begin(), sizes.end() - 1, begins.begin() + 1);
      }

      std::vector<int> sizes, begins; ///< empty on all ranks but the first
    };

    /** Puts the values of all ranks one after the other on the first. */
    template <typename Number>
    void
    gather(const Number        *values,
           const int            n,
           const Shares        &shares,
           const MPI_Datatype   type,
           const MPI_Comm       communicator,
           std::vector<Number> &all)
    {
      all.resize(std::accumulate(shares.sizes.begin(), shares.sizes.end(), 0));
      const int error = MPI_Gatherv(values,
                                    n,
                                    type,
                                    all.data(),
                                    shares.sizes.data(),
                                    shares.begins.data(),
                                    type,
                                    0,
                                    communicator);
      AssertThrowMPI(error);
    }
  } // namespace

  /** On ranks but the first, without a factor. */
  struct Ldl::Cholmod
  {
    explicit Cholmod(const MPI_Comm communicator)
      : communicator(communicator)
      , is_first(Utilities::MPI::this_mpi_process(communicator) == 0)
    {
      cholmod_start(&common);
      common.print              = 0;
      common.supernodal         = CHOLMOD_SIMPLICIAL;
      common.nmethods           = 1;
      common.method[0].ordering = CHOLMOD_AMD;
    }

    ~Cholmod()
    {
      cholmod_free_factor(&factor, &common);
      cholmod_finish(&common);
    }

    Cholmod(const Cholmod &) = delete;

    /** Gathers the places of the entries and finds an order of elimination. */
    void
    analyse(const Epetra_CrsMatrix &matrix);

    /** The matrix, which lives elsewhere, with columns for rows: it is
     * symmetric. */
    cholmod_sparse
    view();

    const MPI_Comm  communicator;
    const bool      is_first;
    cholmod_common  common;
    cholmod_factor *factor = nullptr;

    // Of all ranks, on the first.
    Shares              rows{0, communicator}, entries{0, communicator};
    std::vector<int>    starts, columns;
    std::vector<double> values, vector;
    bool                is_analysed  = false;
    unsigned int        place_before = 0;
  };

  void
  Ldl::Cholmod::analyse(const Epetra_CrsMatrix &matrix)
  {
    int    *row_starts, *local_columns;
    double *unused;
    matrix.ExtractCrsDataPointers(row_starts, local_columns, unused);
    const int        n_rows    = matrix.NumMyRows();
    const int        n_entries = matrix.NumMyNonzeros();
    std::vector<int> lengths(n_rows), numbers(n_entries);
    for (int r = 0; r < n_rows; ++r)
      lengths[r] = row_starts[r + 1] - row_starts[r];
    std::transform(local_columns,
                   local_columns + n_entries,
                   numbers.begin(),
                   [&](const int column) { return matrix.GCID(column); });
    rows    = Shares(n_rows, communicator);
    entries = Shares(n_entries, communicator);
    gather(lengths.data(), n_rows, rows, MPI_INT, communicator, starts);
    gather(numbers.data(), n_entries, entries, MPI_INT, communicator, columns);
    if (!is_first)
      return;
    starts.insert(starts.begin(), 0);
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    values.resize(columns.size());
    cholmod_free_factor(&factor, &common);
    auto all = view();
    factor   = cholmod_analyze(&all, &common);
  }

  cholmod_sparse
  Ldl::Cholmod::view()
  {
    cholmod_sparse all{};
    all.nrow = all.ncol = starts.size() - 1;
    all.nzmax           = columns.size();
    all.p               = starts.data();
    all.i               = columns.data();
    all.x               = values.data();
    all.stype           = 1; // of columns the upper half: of rows the lower
    all.itype           = CHOLMOD_INT;
    all.xtype           = CHOLMOD_REAL;
    all.dtype           = CHOLMOD_DOUBLE;
    all.packed          = 1;
    return all;
  }

  Ldl::Ldl(const SparseMatrix &matrix)
    : matrix(matrix)
    , cholmod(std::make_unique<Cholmod>(
        matrix.unknowns.partitioner->get_mpi_communicator()))
  {}

  Ldl::~Ldl() = default;

  bool
  Ldl::factorize()
  {
    const auto &local = matrix.trilinos->matrix.trilinos_matrix();
    if (!cholmod->is_analysed ||
        cholmod->place_before != matrix.place_of_entries())
      {
        cholmod->analyse(local);
        cholmod->is_analysed  = true;
        cholmod->place_before = matrix.place_of_entries();
      }
    int    *row_starts, *columns;
    double *values;
    local.ExtractCrsDataPointers(row_starts, columns, values);
    gather(values,
           local.NumMyNonzeros(),
           cholmod->entries,
           MPI_DOUBLE,
           cholmod->communicator,
           cholmod->values);
    bool is_done = true;
    if (cholmod->is_first)
      {
        auto all = cholmod->view();
        is_done  = cholmod->factor != nullptr &&
                  cholmod_factorize(&all, cholmod->factor, &cholmod->common) &&
                  cholmod->factor->minor == cholmod->factor->n;
      }
    return Utilities::MPI::broadcast(cholmod->communicator, is_done);
  }

  void
  Ldl::solve(Vector &x, const Vector &b)
  {
    auto &vector = cholmod->vector;
    gather(b.begin(),
           b.locally_owned_size(),
           cholmod->rows,
           MPI_DOUBLE,
           cholmod->communicator,
           vector);
    if (cholmod->is_first)
      {
        cholmod_dense right{};
        right.nrow = right.nzmax = right.d = vector.size();
        right.ncol                         = 1;
        right.x                            = vector.data();
        right.xtype                        = CHOLMOD_REAL;
        right.dtype                        = CHOLMOD_DOUBLE;
        auto solution =
          cholmod_solve(CHOLMOD_A, cholmod->factor, &right, &cholmod->common);
        // Out of memory: zero is seen to solve nothing.
        if (solution != nullptr)
          std::copy_n(static_cast<const double *>(solution->x),
                      vector.size(),
                      vector.begin());
        else
          std::fill(vector.begin(), vector.end(), 0.);
        cholmod_free_dense(&solution, &cholmod->common);
      }
    const int error = MPI_Scatterv(vector.data(),
                                   cholmod->rows.sizes.data(),
                                   cholmod->rows.begins.data(),
                                   MPI_DOUBLE,
                                   x.begin(),
                                   x.locally_owned_size(),
                                   MPI_DOUBLE,
                                   0,
                                   cholmod->communicator);
    AssertThrowMPI(error);
  }

  unsigned int
  Ldl::n_negative() const
  {
    unsigned int n = 0;
    // Of a column that is not supernodal, its pivot comes first.
    if (const auto *factor = cholmod->factor; cholmod->is_first)
      {
        const auto *starts = static_cast<const int *>(factor->p);
        const auto *values = static_cast<const double *>(factor->x);
        for (std::size_t column = 0; column < factor->n; ++column)
          n += values[starts[column]] < 0;
      }
    return Utilities::MPI::broadcast(cholmod->communicator, n);
  }
} // namespace impm
