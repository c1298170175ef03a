#include <impm/solve/inverses.h>
#include <impm/solve/linear_solver_choice.h>

namespace impm
{
  namespace
  {
    /** That does without an inverse. */
    LinearSolverKind
    iterative_solver(const SolverSpec &spec)
    {
      return spec.has_symmetric_matrix ? LinearSolverKind::cg :
                                         LinearSolverKind::gmres;
    }

    bool
    may_be_direct(const SolverSpec &spec)
    {
      return spec.tangent == TangentKind::matrix && spec.has_hierarchy();
    }

    std::string
    name(const SolverSpec &spec, const LinearSolverKind kind)
    {
      if (kind == LinearSolverKind::direct)
        return "direct";
      const std::string method = kind == LinearSolverKind::cg ? "CG" : "GMRES";
      switch (spec.preconditioner)
        {
          case PreconditionerKind::multigrid:
            return method + " with multigrid";
          case PreconditionerKind::amg:
            return method + " with AMG";
          case PreconditionerKind::jacobi:
            return method + " with Jacobi";
          default:
            return method + " without preconditioner";
        }
    }
  } // namespace

  LinearSolverKind
  choose_linear_solver(const SolverSpec      &spec,
                       const unsigned int     dim,
                       const Unknowns::Number n_unknowns)
  {
    if (spec.linear_solver != LinearSolverKind::automatic)
      return spec.linear_solver;
    return may_be_direct(spec) && n_unknowns <= largest_coarse_system(dim) ?
             LinearSolverKind::direct :
             iterative_solver(spec);
  }

  std::string
  describe_linear_solver(const SolverSpec  &spec,
                         const unsigned int dim,
                         const WorkCounts  &counts)
  {
    if (spec.linear_solver != LinearSolverKind::automatic)
      return name(spec, spec.linear_solver);
    const std::string direct    = name(spec, LinearSolverKind::direct),
                      iterative = name(spec, iterative_solver(spec)),
                      suffix    = " (automatic)";
    if (!may_be_direct(spec))
      return iterative + suffix;
    if (counts.direct_systems == 0 && counts.iterative_systems == 0)
      return direct + " up to " + std::to_string(largest_coarse_system(dim)) +
             " unknowns, else " + iterative + suffix;
    if (counts.iterative_systems == 0)
      return direct + suffix;
    return (counts.direct_systems == 0 ? "" : direct + " and ") + iterative +
           suffix;
  }
} // namespace impm
