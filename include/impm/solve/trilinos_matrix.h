#ifndef impm_solve_trilinos_matrix_h
#define impm_solve_trilinos_matrix_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <impm/solve/sparse_matrix.h>

namespace impm
{
  /** For those alone who know Trilinos. */
  struct SparseMatrix::Trilinos
  {
    dealii::TrilinosWrappers::SparseMatrix matrix;
  };
} // namespace impm

#endif
