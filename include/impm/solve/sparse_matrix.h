#ifndef impm_solve_sparse_matrix_h
#define impm_solve_sparse_matrix_h

#include <deal.II/base/array_view.h>

#include <deal.II/lac/full_matrix.h>

#include <impm/solve/remote_rows.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace impm
{
  /**
   * The distributed matrix of a linear system, filled block by block. This and
   * what solves with it (inverses.h, ldl.h) is all that the program knows of
   * Trilinos.
   *
   * Blocks are of whole nodes. Where each of them goes is found once: those who
   * fill the matrix must give the blocks in the order in which they gave them
   * to the pattern.
   */
  class SparseMatrix
  {
  public:
    using Nodes = dealii::ArrayView<const unsigned int>;

    /** The unknowns must live as long. */
    explicit SparseMatrix(const Unknowns &unknowns);
    ~SparseMatrix();

    /** Says that the nodes of a block will couple; then end_pattern(). */
    void
    add_to_pattern(const Nodes &nodes);

    /** The diagonal is there in any case. The matrix is zero. Collective. */
    void
    end_pattern();

    /** Sets the matrix to zero; the block that comes next is the first. */
    void
    set_zero();

    /** Adds the next block, which has its node's values side by side, with
     * constraints eliminated: rows and columns of what is held are left out.
     * Uses the block up. */
    void
    add_block(const Nodes &nodes, dealii::FullMatrix<double> &block);

    /** After a series of blocks on any rank. Collective. */
    void
    end_blocks();

    /** Reads the diagonal, of a compact vector. */
    void
    get_diagonal(Vector &diagonal) const;

    /** Overwrites the diagonal, where it has entries. */
    void
    set_diagonal(const Vector &diagonal);

    void
    vmult(Vector &dst, const Vector &src) const;

    /** Changes when the entries get another place in memory: what knows the
     * old one must go. */
    unsigned int
    place_of_entries() const
    {
      return n_places;
    }

    /** Of this rank (bytes). */
    std::size_t
    memory_consumption() const;

    /** Becomes A D B, with a diagonal matrix D. Collective. */
    void
    multiply(const SparseMatrix &A, const Vector &D, const SparseMatrix &B);

    const Unknowns &unknowns;

    struct Trilinos;
    const std::unique_ptr<Trilinos> trilinos;

  private:
    /** Nodes that a block couples once hanging ones are eliminated. */
    struct Block
    {
      unsigned int begin, end;        ///< in block_nodes
      std::size_t  begin_places;      ///< by pairs of nodes
      bool         any_hangs = false; ///< so that nodes are not those given
      bool         any_held  = false;
    };

    /** Among the nodes that a block couples. */
    unsigned int
    place_in(const Block &block, unsigned int node) const;

    /** Replaces hanging nodes by their masters. */
    void
    eliminate_hanging(const Block                      &block,
                      const Nodes                      &nodes,
                      const dealii::FullMatrix<double> &before,
                      dealii::FullMatrix<double>       &after) const;

    template <unsigned int n_components>
    void
    add_entries(const Block &block, const dealii::FullMatrix<double> &entries);

    /** Which nodes are coupled, by number, in rows that this rank owns or
     * writes to. Collective. */
    dealii::DynamicSparsityPattern
    couple_nodes();

    /** Number of entries of an owned row; alike for all rows of a node. */
    unsigned int
    row_length(const unsigned int row) const
    {
      return row_starts[row + 1] - row_starts[row];
    }

    /** Of the first unknown of a node: what this rank owns comes first. */
    int
    local_column(Unknowns::Number number) const;

    /** Finds the places of the blocks' entries. */
    void
    find_places();

    const bool                 is_parallel;
    unsigned int               n_places = 0;
    std::vector<Block>         blocks;
    std::vector<unsigned int>  block_nodes;
    std::size_t                next_block = 0;
    dealii::FullMatrix<double> eliminated;

    /** For each pair of nodes of a block which of the nodes that the row
     * couples the column is, or no_place. There are many: for boxes as many
     * bytes as a fifth of the entries. */
    std::vector<std::uint16_t>     places;
    std::size_t                    n_places_of_blocks = 0;
    static constexpr std::uint16_t no_place           = -1;

    double    *values     = nullptr; ///< of the matrix, unless it is a product
    const int *row_starts = nullptr; ///< in `values`, by owned row
    std::vector<unsigned int> diagonal_places; ///< by owned row
    RemoteRows                remote_rows;
    /** First unknowns of nodes of other ranks in rows of this one. */
    std::vector<Unknowns::Number> remote_columns;
  };
} // namespace impm

#endif
