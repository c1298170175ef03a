#ifndef impm_solve_linear_solver_choice_h
#define impm_solve_linear_solver_choice_h

#include <impm/input/sections/solver.h>
#include <impm/solve/nonlinear_system.h>

#include <string>

namespace impm
{
  /**
   * What solves a linear system of so many unknowns, of all ranks: what the
   * file says or, where that is left open, a direct solver for a system that
   * multigrid would factorize anyway, as a coarsest level (inverses.h). Larger
   * ones go to CG or, where the matrix is not symmetric, to GMRES; so do all of
   * those whose operator or preconditioner only these have. Ranks do not
   * matter: a run is the same on any number of them.
   */
  LinearSolverKind
  choose_linear_solver(const SolverSpec &spec,
                       unsigned int      dim,
                       Unknowns::Number  n_unknowns);

  /** For users: what has solved the systems of a run or, before the first, what
   * will. */
  std::string
  describe_linear_solver(const SolverSpec &spec,
                         unsigned int      dim,
                         const WorkCounts &counts);
} // namespace impm

#endif
