#ifndef impm_solve_sparse_matrix_h
#define impm_solve_sparse_matrix_h

#include <deal.II/base/partitioner.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector_operation.h>

#include <impm/base/vector.h>

#include <functional>
#include <memory>
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
    using Dof  = dealii::types::global_dof_index;
    using Dofs = std::vector<Dof>;

    /** The constraints must live as long. */
    SparseMatrix(const dealii::Utilities::MPI::Partitioner &partitioner,
                 const dealii::AffineConstraints<double>   &constraints);
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

    /** Adds to an entry of the diagonal that this rank owns. */
    void
    add_to_diagonal(Dof dof, double value);

    /** Overwrites one. */
    void
    set_diagonal(Dof dof, double value);

    double
    diagonal(Dof dof) const;

    /** After a series of add...() or set...() on any rank. Collective. */
    void
    compress(dealii::VectorOperation::values operation);

    void
    vmult(Vector &dst, const Vector &src) const;

    /** Changes when the entries get another place in memory: what knows the
     * old one must go. */
    unsigned int
    place_of_entries() const
    {
      return n_places;
    }

    /** Becomes A D B, with a diagonal matrix D. Collective. */
    void
    multiply(const SparseMatrix &A, const Vector &D, const SparseMatrix &B);

    struct Trilinos;
    const std::unique_ptr<Trilinos> trilinos;

  private:
    const dealii::AffineConstraints<double> &constraints;
    unsigned int                             n_places = 0;
  };

  /** What deal.II's solvers know of a matrix, a preconditioner, an inverse. */
  struct LinearMap
  {
    std::function<void(Vector &dst, const Vector &src)> vmult;
  };

  /**
   * Smoothed aggregation (ML) of nodes with so many values each for elastic
   * bodies; `modes` are what costs hardly any energy, by locally owned value.
   * The matrix has to stay where it is. When it gets other entries, those are
   * smoothed with, while the coarser levels stay as they were. Throws
   * LinearizationError, on every rank alike, when the matrix is singular.
   * Collective.
   */
  LinearMap
  make_amg(const SparseMatrix                     &matrix,
           const std::vector<std::vector<double>> &modes,
           unsigned int                            n_components);

  /**
   * The inverse of a matrix that stays as it is, by factorization (Amesos,
   * KLU). Throws LinearizationError as make_amg() does, when applied, too.
   * Collective.
   */
  LinearMap
  factorize(const SparseMatrix &matrix);
} // namespace impm

#endif
