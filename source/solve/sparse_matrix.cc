#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <impm/base/exceptions.h>
#include <impm/solve/sparse_matrix.h>

#include <Teuchos_ParameterList.hpp>

#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    const char *const singular =
      "the linear system is singular (a body that nothing holds, or with too few "
      "points for its grid?)";
  } // namespace

  struct SparseMatrix::Implementation
  {
    Implementation(const IndexSet                  &owned,
                   const IndexSet                  &relevant,
                   const AffineConstraints<double> &constraints,
                   const MPI_Comm                   communicator)
      : owned(owned)
      , communicator(communicator)
      , constraints(constraints)
      , pattern(owned, owned, relevant, communicator)
    {}

    const IndexSet                    owned;
    const MPI_Comm                    communicator;
    const AffineConstraints<double>  &constraints;
    TrilinosWrappers::SparsityPattern pattern;
    TrilinosWrappers::SparseMatrix    matrix;
  };

  SparseMatrix::SparseMatrix(const IndexSet                  &owned,
                             const IndexSet                  &relevant,
                             const AffineConstraints<double> &constraints,
                             const MPI_Comm                   communicator)
    : implementation(std::make_unique<Implementation>(
        owned, relevant, constraints, communicator))
  {}

  SparseMatrix::~SparseMatrix() = default;

  void
  SparseMatrix::add_to_pattern(const Dofs &dofs)
  {
    implementation->constraints.add_entries_local_to_global(
      dofs, implementation->pattern);
  }

  void
  SparseMatrix::end_pattern()
  {
    for (const auto dof : implementation->owned)
      implementation->pattern.add(dof, dof);
    implementation->pattern.compress();
    implementation->matrix.reinit(implementation->pattern);
    implementation->pattern.clear();
  }

  void
  SparseMatrix::set_zero()
  {
    implementation->matrix = 0;
  }

  void
  SparseMatrix::add_block(const FullMatrix<double> &block, const Dofs &dofs)
  {
    implementation->constraints.distribute_local_to_global(
      block, dofs, implementation->matrix);
  }

  void
  SparseMatrix::add(const types::global_dof_index row,
                    const types::global_dof_index column,
                    const double                  value)
  {
    implementation->matrix.add(row, column, value);
  }

  void
  SparseMatrix::set(const types::global_dof_index row,
                    const types::global_dof_index column,
                    const double                  value)
  {
    implementation->matrix.set(row, column, value);
  }

  void
  SparseMatrix::end_adding()
  {
    implementation->matrix.compress(VectorOperation::add);
  }

  void
  SparseMatrix::end_setting()
  {
    implementation->matrix.compress(VectorOperation::insert);
  }

  double
  SparseMatrix::diagonal(const types::global_dof_index dof) const
  {
    return implementation->matrix.diag_element(dof);
  }

  void
  SparseMatrix::vmult(Vector &dst, const Vector &src) const
  {
    implementation->matrix.vmult(dst, src);
  }

  void
  SparseMatrix::multiply(const SparseMatrix &A,
                         const Vector       &D,
                         const SparseMatrix &B)
  {
    TrilinosWrappers::MPI::Vector scaling(A.implementation->owned,
                                          A.implementation->communicator);
    for (const auto dof : A.implementation->owned)
      scaling[dof] = D[dof];
    scaling.compress(VectorOperation::insert);
    A.implementation->matrix.mmult(implementation->matrix,
                                   B.implementation->matrix,
                                   scaling);
  }


  struct AmgPreconditioner::Implementation
  {
    TrilinosWrappers::PreconditionAMG preconditioner;
    std::vector<double>               modes; ///< whose address ML keeps
  };

  AmgPreconditioner::AmgPreconditioner()
    : implementation(std::make_unique<Implementation>())
  {}

  AmgPreconditioner::~AmgPreconditioner() = default;

  void
  AmgPreconditioner::build(const SparseMatrix                     &matrix,
                           const std::vector<std::vector<double>> &modes)
  {
    auto &all = implementation->modes;
    all.clear();
    for (const auto &mode : modes)
      all.insert(all.end(), mode.begin(), mode.end());
    all.resize(std::max<std::size_t>(1, all.size()));

    Teuchos::ParameterList                            parameters;
    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic              = true;
    data.higher_order_elements = false;
    data.smoother_sweeps       = 2;
    data.aggregation_threshold = 0.02;
    std::unique_ptr<Epetra_MultiVector> unused;
    const auto &trilinos_matrix = matrix.implementation->matrix;
    data.set_parameters(parameters, unused, trilinos_matrix);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", static_cast<int>(modes.size()));
    parameters.set("null space: vectors", all.data());
    // Where the coarsest matrix is singular, ML says so on the terminal, writes
    // it to a file and goes on without it; no parameter turns this off.
    const std::string  file      = "amesos-failure.dat";
    const bool         was_there = std::filesystem::exists(file);
    std::ostringstream said;
    const auto         screen = std::cout.rdbuf(said.rdbuf());
    std::exception_ptr error;
    try
      {
        implementation->preconditioner.initialize(trilinos_matrix, parameters);
      }
    catch (...)
      {
        error = std::current_exception();
      }
    std::cout.rdbuf(screen);
    const bool failed = error || said.str().find("failed") != std::string::npos;
    if (failed && !was_there)
      {
        std::error_code none;
        std::filesystem::remove(file, none);
      }
    if (Utilities::MPI::max(failed ? 1 : 0,
                            trilinos_matrix.get_mpi_communicator()) > 0)
      throw LinearizationError(singular);
  }

  void
  AmgPreconditioner::vmult(Vector &dst, const Vector &src) const
  {
    implementation->preconditioner.vmult(dst, src);
  }


  struct DirectSolver::Implementation
  {
    SolverControl                  control;
    TrilinosWrappers::SolverDirect solver{control};
  };

  DirectSolver::DirectSolver(const SparseMatrix &matrix)
    : implementation(std::make_unique<Implementation>())
  {
    try
      {
        implementation->solver.initialize(matrix.implementation->matrix);
      }
    catch (const ExceptionBase &)
      {
        throw LinearizationError(singular);
      }
  }

  DirectSolver::~DirectSolver() = default;

  void
  DirectSolver::solve(Vector &x, const Vector &b) const
  {
    try
      {
        implementation->solver.solve(x, b);
      }
    catch (const ExceptionBase &)
      {
        throw LinearizationError(singular);
      }
  }
} // namespace impm
