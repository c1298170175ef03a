#ifndef impm_solve_sparse_matrix_h
#define impm_solve_sparse_matrix_h

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>

#include <impm/base/vector.h>

#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /**
   * The distributed matrix of a linear system, filled block by block. This and
   * what solves with it is all that the program knows of Trilinos, and
   * solve/sparse_matrix.cc is the one file that does.
   */
  class SparseMatrix
  {
  public:
    using Dofs = std::vector<dealii::types::global_dof_index>;

    /** Rows of `owned` unknowns; entries may come in all `relevant` ones. */
    SparseMatrix(const dealii::IndexSet                  &owned,
                 const dealii::IndexSet                  &relevant,
                 const dealii::AffineConstraints<double> &constraints,
                 MPI_Comm                                 communicator);
    ~SparseMatrix();

    /** Says that a block of unknowns will couple; then end_pattern(). */
    void
    add_to_pattern(const Dofs &dofs);

    /** The diagonal is there in any case. The matrix is zero. Collective. */
    void
    end_pattern();

    void
    set_zero();

    /** Adds a block, with constraints eliminated. */
    void
    add_block(const dealii::FullMatrix<double> &block, const Dofs &dofs);

    /** Adds to an entry that this rank owns. */
    void
    add(dealii::types::global_dof_index row,
        dealii::types::global_dof_index column,
        double                          value);

    /** Overwrites one. */
    void
    set(dealii::types::global_dof_index row,
        dealii::types::global_dof_index column,
        double                          value);

    /** After a series of add...() on any rank. Collective. */
    void
    end_adding();

    /** After a series of set(). Collective. */
    void
    end_setting();

    /** An entry of the diagonal that this rank owns. */
    double
    diagonal(dealii::types::global_dof_index dof) const;

    void
    vmult(Vector &dst, const Vector &src) const;

    /** Becomes A D B, with a diagonal matrix D. Collective. */
    void
    multiply(const SparseMatrix &A, const Vector &D, const SparseMatrix &B);

    struct Implementation;
    std::unique_ptr<Implementation> implementation;
  };

  /** Smoothed aggregation (ML) for elastic bodies. */
  class AmgPreconditioner
  {
  public:
    AmgPreconditioner();
    ~AmgPreconditioner();

    /**
     * For a matrix that stays as it is; `modes` are what costs hardly any
     * energy, by locally owned value. Throws LinearizationError, on every rank
     * alike, when the matrix is singular. Collective.
     */
    void
    build(const SparseMatrix                     &matrix,
          const std::vector<std::vector<double>> &modes);

    void
    vmult(Vector &dst, const Vector &src) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
  };

  /** A factorization (Amesos, KLU). */
  class DirectSolver
  {
  public:
    /** Of a matrix that stays as it is. Throws LinearizationError, on every
     * rank alike, when it is singular. Collective. */
    explicit DirectSolver(const SparseMatrix &matrix);
    ~DirectSolver();

    /** Throws LinearizationError as the constructor does. Collective. */
    void
    solve(Vector &x, const Vector &b) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace impm

#endif
