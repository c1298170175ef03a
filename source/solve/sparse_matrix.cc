#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <impm/base/exceptions.h>
#include <impm/solve/sparse_matrix.h>

#include <Teuchos_ParameterList.hpp>

#include <filesystem>
#include <iostream>
#include <sstream>

namespace impm
{
  using namespace dealii;

  struct SparseMatrix::Trilinos
  {
    TrilinosWrappers::SparsityPattern pattern;
    TrilinosWrappers::SparseMatrix    matrix;
  };

  SparseMatrix::SparseMatrix(const Utilities::MPI::Partitioner &partitioner,
                             const AffineConstraints<double>   &constraints)
    : trilinos(std::make_unique<Trilinos>())
    , constraints(constraints)
  {
    const IndexSet &owned = partitioner.locally_owned_range();
    trilinos->pattern.reinit(owned,
                             owned,
                             constraints.get_local_lines(),
                             partitioner.get_mpi_communicator());
  }

  SparseMatrix::~SparseMatrix() = default;

  void
  SparseMatrix::add_to_pattern(const Dofs &dofs)
  {
    constraints.add_entries_local_to_global(dofs, trilinos->pattern);
  }

  void
  SparseMatrix::end_pattern()
  {
    auto &pattern = trilinos->pattern;
    for (const auto dof : pattern.locally_owned_range_indices())
      pattern.add(dof, dof);
    pattern.compress();
    trilinos->matrix.reinit(pattern);
    pattern.clear();
  }

  void
  SparseMatrix::set_zero()
  {
    trilinos->matrix = 0;
  }

  void
  SparseMatrix::add_block(const FullMatrix<double> &block, const Dofs &dofs)
  {
    constraints.distribute_local_to_global(block, dofs, trilinos->matrix);
  }

  void
  SparseMatrix::add_to_diagonal(const Dof dof, const double value)
  {
    trilinos->matrix.add(dof, dof, value);
  }

  void
  SparseMatrix::set_diagonal(const Dof dof, const double value)
  {
    trilinos->matrix.set(dof, dof, value);
  }

  double
  SparseMatrix::diagonal(const Dof dof) const
  {
    return trilinos->matrix.diag_element(dof);
  }

  void
  SparseMatrix::compress(const VectorOperation::values operation)
  {
    trilinos->matrix.compress(operation);
  }

  void
  SparseMatrix::vmult(Vector &dst, const Vector &src) const
  {
    trilinos->matrix.vmult(dst, src);
  }

  void
  SparseMatrix::multiply(const SparseMatrix &A,
                         const Vector       &D,
                         const SparseMatrix &B)
  {
    TrilinosWrappers::MPI::Vector scaling(D.locally_owned_elements(),
                                          D.get_mpi_communicator());
    for (const auto dof : D.locally_owned_elements())
      scaling[dof] = D[dof];
    scaling.compress(VectorOperation::insert);
    ++n_places;
    A.trilinos->matrix.mmult(trilinos->matrix, B.trilinos->matrix, scaling);
  }

  namespace
  {
    [[noreturn]] void
    blame_matrix()
    {
      throw LinearizationError(
        "the linear system is singular (a body that nothing holds, or with too few "
        "points for its grid?)");
    }

    struct Amg
    {
      TrilinosWrappers::PreconditionAMG preconditioner;
      std::vector<double>               modes; ///< whose address ML keeps
    };

    struct Factors
    {
      SolverControl                  control;
      TrilinosWrappers::SolverDirect solver{control};
    };
  } // namespace

  LinearMap
  make_amg(const SparseMatrix                     &matrix,
           const std::vector<std::vector<double>> &modes,
           const unsigned int                      n_components)
  {
    const auto amg = std::make_shared<Amg>();
    for (const auto &mode : modes)
      amg->modes.insert(amg->modes.end(), mode.begin(), mode.end());
    amg->modes.resize(std::max<std::size_t>(1, amg->modes.size()));

    Teuchos::ParameterList                            parameters;
    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    // By nodes; a larger one costs iterations on even grids, a smaller one on
    // those that are stretched or adapted.
    data.aggregation_threshold = 0.01;
    std::unique_ptr<Epetra_MultiVector> unused;
    const auto &trilinos_matrix = matrix.trilinos->matrix;
    data.set_parameters(parameters, unused, trilinos_matrix);
    parameters.set("PDE equations", static_cast<int>(n_components));
    // To factorize more is dear in space, not in the plane.
    parameters.set("coarse: max size", n_components == 3 ? 500 : 2000);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", static_cast<int>(modes.size()));
    parameters.set("null space: vectors", amg->modes.data());
    // Where the coarsest matrix is singular, ML says so on the terminal, writes
    // it to a file and goes on without it; no parameter turns this off.
    const std::string  file      = "amesos-failure.dat";
    const bool         was_there = std::filesystem::exists(file);
    std::ostringstream said;
    const auto         screen = std::cout.rdbuf(said.rdbuf());
    bool               failed = false;
    try
      {
        amg->preconditioner.initialize(trilinos_matrix, parameters);
      }
    catch (...)
      {
        failed = true;
      }
    std::cout.rdbuf(screen);
    failed = failed || said.str().find("failed") != std::string::npos;
    if (failed && !was_there)
      {
        std::error_code none;
        std::filesystem::remove(file, none);
      }
    if (Utilities::MPI::logical_or(failed,
                                   trilinos_matrix.get_mpi_communicator()))
      blame_matrix();
    return {[amg](Vector &dst, const Vector &src) {
      amg->preconditioner.vmult(dst, src);
    }};
  }

  LinearMap
  factorize(const SparseMatrix &matrix)
  {
    const auto factors = std::make_shared<Factors>();
    try
      {
        factors->solver.initialize(matrix.trilinos->matrix);
      }
    catch (const ExceptionBase &)
      {
        blame_matrix();
      }
    return {[factors](Vector &x, const Vector &b) {
      try
        {
          factors->solver.solve(x, b);
        }
      catch (const ExceptionBase &)
        {
          blame_matrix();
        }
    }};
  }
} // namespace impm
