#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>

#include <impm/base/exceptions.h>
#include <impm/solve/coarse_unknowns.h>
#include <impm/solve/multigrid.h>
#include <impm/solve/trilinos_matrix.h>

#include <algorithm>
#include <memory>

namespace impm
{
  using namespace dealii;

  namespace
  {
    using Matrix = TrilinosWrappers::SparseMatrix;
    using Place  = NodeLattice::Place;
    using Key    = CoarseUnknowns::Key;

    // A key is made of three coordinates and, last, of layer and component.
    constexpr unsigned int n_bits = 18, n_last_bits = 64 - 3 * n_bits;
    constexpr Key end = Key(1) << n_bits, last_end = Key(1) << n_last_bits;

    Key
    key_of(const Place &place, const unsigned int component)
    {
      Key key = 0;
      for (const int x : {place[2], place[1], place[0]})
        key = key << n_bits | Key(x);
      return key << n_last_bits | component;
    }

    Place
    place_of(Key key)
    {
      Place place;
      key >>= n_last_bits;
      for (int &x : place)
        {
          x = key & (end - 1);
          key >>= n_bits;
        }
      return place;
    }

    /** The unknowns that this rank owns on a level. */
    struct LevelUnknowns
    {
      std::vector<Key>  keys;
      std::vector<int>  extents; ///< of the smallest cells around
      std::vector<bool> held;    ///< without neighbours; none if empty
      IndexSet          owned;
    };

    using Rows =
      std::vector<std::vector<std::pair<CoarseUnknowns::Number, double>>>;

    std::unique_ptr<Matrix>
    make_matrix(const Rows     &rows,
                const IndexSet &owned_rows,
                const IndexSet &owned_columns,
                const MPI_Comm  communicator)
    {
      DynamicSparsityPattern pattern(owned_rows.size(),
                                     owned_columns.size(),
                                     owned_rows);
      for (unsigned int i = 0; i < rows.size(); ++i)
        for (const auto &entry : rows[i])
          pattern.add(owned_rows.nth_index_in_set(i), entry.first);
      auto matrix = std::make_unique<Matrix>();
      matrix->reinit(owned_rows, owned_columns, pattern, communicator);
      for (unsigned int i = 0; i < rows.size(); ++i)
        for (const auto &[column, weight] : rows[i])
          matrix->set(owned_rows.nth_index_in_set(i), column, weight);
      matrix->compress(VectorOperation::insert);
      return matrix;
    }

    /** Where a surface leaves a single node free, several places of a coarse
     * lattice may stand for no more than this one, and the matrix have no
     * inverse. What they agree on is all that counts: a share of the diagonal
     * that changes nothing else makes the choice. */
    void
    regularize(Matrix &matrix)
    {
      for (const auto i : matrix.locally_owned_range_indices())
        matrix.set(i, i, (1 + 1e-11) * matrix.diag_element(i));
      matrix.compress(VectorOperation::insert);
    }

    struct Level
    {
      using Smoother =
        PreconditionChebyshev<Matrix, Vector, DiagonalMatrix<Vector>>;

      const Matrix           *matrix;
      std::unique_ptr<Matrix> own, from_coarse; ///< A if not the finest, P
      Smoother                smoother;
      Vector                  x, b, residual;
    };

    class Multigrid
    {
    public:
      Multigrid(const SparseMatrix &matrix, const NodeLattice &lattice);

      void
      vmult(Vector &x, const Vector &b)
      {
        cycle(0, x, b);
      }

    private:
      /** Adds a level below the last one, whose unknowns are given. Returns
       * those of the new one. */
      LevelUnknowns
      add_level(const LevelUnknowns &fine);

      /** visit(i, key, weight, extent) for the places on the coarse lattice
       * around the i-th unknown that have a share in it. */
      template <typename Visit>
      void
      for_corners(const LevelUnknowns &fine, const Visit &visit) const;

      void
      make_smoother(Level &level) const;

      void
      cycle(unsigned int l, Vector &x, const Vector &b);

      const unsigned int                  dim;
      const MPI_Comm                      communicator;
      std::vector<Key>                    prescribed;
      std::vector<std::unique_ptr<Level>> levels; ///< the finest first
      SolverControl                       control;
      TrilinosWrappers::SolverDirect      factors{control};
    };

    Multigrid::Multigrid(const SparseMatrix &matrix, const NodeLattice &lattice)
      : dim(matrix.unknowns.n_components)
      , communicator(matrix.unknowns.partitioner->get_mpi_communicator())
    {
      int largest = 0;
      for (const auto &place : lattice.places)
        largest =
          std::max(largest, *std::max_element(place.begin(), place.end()));
      // coarser lattices may go beyond the grid
      if (Key(Utilities::MPI::max(largest, communicator)) >= end / 2)
        throw ComputationError("the grid has too many cells along an axis for "
                               "'Preconditioner = multigrid'; take AMG");
      unsigned int n_layers = 1;
      for (const unsigned int layer : lattice.layers)
        n_layers = std::max(n_layers, layer + 1);
      if (dim * Utilities::MPI::max(n_layers, communicator) > last_end)
        throw ComputationError("too many bodies move nodes of their own for "
                               "'Preconditioner = multigrid'; take AMG");
      for (const auto &value : lattice.prescribed)
        prescribed.push_back(
          key_of(value.place, dim * value.layer + value.component));

      LevelUnknowns unknowns;
      unknowns.owned = matrix.unknowns.partitioner->locally_owned_range();
      for (unsigned int i = 0; i < matrix.unknowns.n_owned(); ++i)
        {
          unknowns.keys.push_back(
            key_of(lattice.places[i / dim],
                   dim * lattice.layers[i / dim] + i % dim));
          unknowns.extents.push_back(lattice.extents[i / dim]);
          unknowns.held.push_back(matrix.unknowns.is_held(i));
        }
      levels.push_back(std::make_unique<Level>());
      levels[0]->matrix = &matrix.trilinos->matrix;
      while (unknowns.owned.size() > largest_coarse_system(dim))
        {
          const auto before = unknowns.owned.size();
          unknowns          = add_level(unknowns);
          if (unknowns.owned.size() > 0.7 * before)
            break; // nodes far apart, with nothing between them
        }
      for (auto &level : levels)
        {
          const IndexSet owned = level->matrix->locally_owned_range_indices();
          for (Vector *v : {&level->x, &level->b, &level->residual})
            v->reinit(owned, communicator);
          if (level != levels.back())
            make_smoother(*level);
        }
      if (levels.size() > 1)
        regularize(*levels.back()->own);
      factors.initialize(*levels.back()->matrix);
    }

    template <typename Visit>
    void
    Multigrid::for_corners(const LevelUnknowns &fine, const Visit &visit) const
    {
      for (unsigned int i = 0; i < fine.keys.size(); ++i)
        if (fine.held.empty() || !fine.held[i])
          for (unsigned int corner = 0; corner < (1u << dim); ++corner)
            {
              const int extent = 2 * fine.extents[i];
              Place     place  = place_of(fine.keys[i]);
              double    weight = 1;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  const int    rest  = place[d] & (extent - 1);
                  const double share = double(rest) / extent;
                  const bool   upper = corner >> d & 1u;
                  weight *= upper ? share : 1 - share;
                  place[d] += upper ? extent - rest : -rest;
                }
              if (weight > 0)
                visit(i,
                      key_of(place, fine.keys[i] & (last_end - 1)),
                      weight,
                      extent);
            }
    }

    LevelUnknowns
    Multigrid::add_level(const LevelUnknowns &fine)
    {
      CoarseUnknowns::Wanted wanted;
      wanted.reserve(fine.keys.size());
      for_corners(fine,
                  [&](unsigned int, const Key key, double, const int extent) {
                    int &smallest = wanted.insert({key, extent}).first->second;
                    smallest      = std::min(smallest, extent);
                  });
      const CoarseUnknowns coarse(wanted, prescribed, communicator);

      Rows rows(fine.keys.size());
      for_corners(
        fine,
        [&](const unsigned int i, const Key key, const double weight, int) {
          const auto column = coarse.number(key);
          if (column != CoarseUnknowns::none)
            rows[i].emplace_back(column, weight);
        });
      Level &level = *levels.back();
      level.from_coarse =
        make_matrix(rows, fine.owned, coarse.owned, communicator);
      levels.push_back(std::make_unique<Level>());
      Level &next = *levels.back();
      next.own    = std::make_unique<Matrix>();
      Matrix product;
      level.matrix->mmult(product, *level.from_coarse);
      level.from_coarse->Tmmult(*next.own, product);
      next.matrix = next.own.get();
      return {coarse.keys, coarse.extents, {}, coarse.owned};
    }

    void
    Multigrid::make_smoother(Level &level) const
    {
      Level::Smoother::AdditionalData data;
      data.degree              = 2;
      data.smoothing_range     = 20;
      data.eig_cg_n_iterations = 10;
      Vector diagonal          = level.x;
      for (const auto i : diagonal.locally_owned_elements())
        diagonal(i) = 1 / level.matrix->diag_element(i);
      data.preconditioner = std::make_shared<DiagonalMatrix<Vector>>(diagonal);
      level.smoother.initialize(*level.matrix, data);
      level.smoother.estimate_eigenvalues(level.x);
    }

    void
    Multigrid::cycle(const unsigned int l, Vector &x, const Vector &b)
    {
      Level &level = *levels[l];
      if (l + 1 == levels.size())
        {
          factors.solve(x, b);
          return;
        }
      Level &next = *levels[l + 1];
      level.smoother.vmult(x, b);
      level.matrix->vmult(level.residual, x);
      level.residual.sadd(-1, 1, b);
      level.from_coarse->Tvmult(next.b, level.residual);
      cycle(l + 1, next.x, next.b);
      level.from_coarse->vmult(level.residual, next.x);
      x += level.residual;
      level.smoother.step(x, b);
    }
  } // namespace

  LinearMap
  make_multigrid(const SparseMatrix &matrix, const NodeLattice &lattice)
  {
    // deal.II and Trilinos throw where a matrix has no inverse
    std::shared_ptr<Multigrid> multigrid;
    try
      {
        multigrid = std::make_shared<Multigrid>(matrix, lattice);
      }
    catch (const ExceptionBase &)
      {
        blame_matrix();
      }
    return {[multigrid](Vector &dst, const Vector &src) {
      multigrid->vmult(dst, src);
    }};
  }
} // namespace impm
