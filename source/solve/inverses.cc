#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>

#include <impm/base/exceptions.h>
#include <impm/solve/inverses.h>
#include <impm/solve/trilinos_matrix.h>

#include <Teuchos_ParameterList.hpp>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    struct Amg
    {
      /** Of a matrix whose address ML keeps, as that of the modes. */
      explicit Amg(const TrilinosWrappers::SparseMatrix &matrix)
      {
        // ML takes for zero what is small in no unit: 7 % more iterations where
        // entries are 1e-9, ten times as many at 1e-13.
        const double size = matrix.linfty_norm();
        if (size > 0 && size < 1)
          {
            scale = std::exp2(-std::floor(std::log2(size)));
            scaled.copy_from(matrix);
            scaled *= scale;
          }
      }

      double                            scale = 1;
      TrilinosWrappers::SparseMatrix    scaled; ///< unless that is one
      TrilinosWrappers::PreconditionAMG preconditioner;
      std::vector<double>               modes;
    };

    struct Factors
    {
      SolverControl                  control;
      TrilinosWrappers::SolverDirect solver{control};
    };
  } // namespace

  void
  blame_matrix()
  {
    throw LinearizationError(
      "the linear system is singular (a body that nothing holds, or with too few "
      "points for its grid?)");
  }

  LinearMap
  make_amg(const SparseMatrix                     &matrix,
           const std::vector<std::vector<double>> &modes)
  {
    const auto  amg = std::make_shared<Amg>(matrix.trilinos->matrix);
    const auto &trilinos_matrix =
      amg->scale == 1 ? matrix.trilinos->matrix : amg->scaled;
    for (const auto &mode : modes)
      amg->modes.insert(amg->modes.end(), mode.begin(), mode.end());
    amg->modes.resize(std::max<std::size_t>(1, amg->modes.size()));

    Teuchos::ParameterList                            parameters;
    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    // By nodes; a larger one costs iterations on even grids, a smaller one on
    // those that are stretched or adapted.
    data.aggregation_threshold = 0.01;
    std::unique_ptr<Epetra_MultiVector> unused;
    data.set_parameters(parameters, unused, trilinos_matrix);
    const unsigned int n_components = matrix.unknowns.n_components;
    parameters.set("PDE equations", static_cast<int>(n_components));
    parameters.set("coarse: max size",
                   static_cast<int>(largest_coarse_system(n_components)));
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
      dst *= amg->scale;
    }};
  }

  LinearMap
  make_lu(const SparseMatrix &matrix)
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
