#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <impm/base/compat.h>
#include <impm/base/exceptions.h>
#include <impm/solve/linear_solver.h>

#include <functional>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** A diagonal matrix, by its inverse. */
    struct JacobiPreconditioner
    {
      const Vector &inverse_diagonal;

      void
      vmult(Vector &dst, const Vector &src) const
      {
        dst = src;
        dst.scale(inverse_diagonal);
      }
    };

    /** Either form of the tangent, for deal.II's solvers. */
    struct Operator
    {
      std::function<void(Vector &, const Vector &)> apply;

      void
      vmult(Vector &dst, const Vector &src) const
      {
        apply(dst, src);
      }
    };
  } // namespace

  LinearSolver::LinearSolver(const SolverSpec &spec,
                             NonlinearSystem  &system,
                             TimerOutput      &timer)
    : spec(spec)
    , system(system)
    , quotient(system, spec.difference_step)
    , timer(timer)
  {
    system.initialize(inverse_diagonal);
    if (needs_matrix())
      {
        TimerOutput::Scope scope(timer, "sparsity");
        matrix = system.make_matrix();
      }
  }

  void
  LinearSolver::linearize_at(const Vector &u)
  {
    if (spec.tangent == TangentKind::difference_quotient)
      quotient.linearize_at(u);
  }

  void
  LinearSolver::vmult_lift(Vector &dst, const Vector &src)
  {
    if (spec.tangent == TangentKind::difference_quotient)
      quotient.vmult_lift(dst, src);
    else
      system.vmult_lift(dst, src);
  }

  void
  LinearSolver::assemble()
  {
    if (!matrix)
      matrix = system.make_matrix();
    system.assemble(*matrix);
    matrix_is_current = true;
  }

  void
  LinearSolver::take_tangent()
  {
    ++system.counts->tangents;
    factors.reset();
    matrix_is_current = false;
    if (needs_matrix())
      {
        TimerOutput::Scope scope(timer, "assembly");
        assemble();
      }
    if (spec.linear_solver != LinearSolverKind::direct)
      update_preconditioner();
  }

  void
  LinearSolver::update_preconditioner()
  {
    if (spec.preconditioner == PreconditionerKind::amg)
      {
        TimerOutput::Scope scope(timer, "preconditioner");
        amg.build(*matrix, system.near_null_space());
        return;
      }
    if (spec.preconditioner == PreconditionerKind::jacobi)
      system.diagonal(inverse_diagonal);
    else if (solves_for_momentum())
      inverse_diagonal = *system.weight_of_unknowns();
    else
      return;
    for (unsigned int i = 0; i < inverse_diagonal.locally_owned_size(); ++i)
      inverse_diagonal.local_element(i) =
        system.is_constrained(i) ? 1. : 1 / inverse_diagonal.local_element(i);
  }

  unsigned int
  LinearSolver::iterate(Vector &x, const Vector &b, const double tolerance)
  {
    const double           goal = tolerance * b.l2_norm();
    SolverControl          strict(spec.linear_iterations, goal);
    IterationNumberControl lenient(spec.linear_iterations, goal);
    SolverControl         &control = spec.accept_unfinished ? lenient : strict;
    Operator               tangent;
    tangent.apply = [&](Vector &dst, const Vector &src) {
      if (spec.tangent == TangentKind::difference_quotient)
        quotient.vmult(dst, src);
      else if (spec.tangent == TangentKind::matrix_free)
        system.vmult(dst, src);
      else
        {
          ++system.counts->operator_applications;
          matrix->vmult(dst, src);
        }
    };
    const auto run = [&](auto &solver) {
      if (spec.preconditioner == PreconditionerKind::amg)
        solver.solve(tangent, x, b, amg);
      else if (spec.preconditioner == PreconditionerKind::jacobi ||
               solves_for_momentum())
        solver.solve(tangent, x, b, JacobiPreconditioner{inverse_diagonal});
      else
        solver.solve(tangent, x, b, PreconditionIdentity());
    };
    if (spec.linear_solver == LinearSolverKind::cg)
      {
        SolverCG<Vector> solver(control);
        run(solver);
      }
    else
      {
        SolverGMRES<Vector>::AdditionalData data;
        compat::set_basis_size(data, spec.gmres_directions);
        data.right_preconditioning = true;
        SolverGMRES<Vector> solver(control, data);
        run(solver);
      }
    return control.last_step();
  }

  void
  LinearSolver::solve_directly(Vector &x, const Vector &b)
  {
    TimerOutput::Scope scope(timer, "direct solver");
    // What has been factorized must stay: a tangent may be solved with again.
    if (!matrix_is_current)
      assemble();
    if (!factors)
      factors = std::make_unique<DirectSolver>(*matrix);
    factors->solve(x, b);
  }

  unsigned int
  LinearSolver::solve(Vector &x, const Vector &b, const double tolerance)
  {
    x = 0;
    if (spec.linear_solver == LinearSolverKind::direct)
      {
        solve_directly(x, b);
        return 1;
      }
    try
      {
        TimerOutput::Scope scope(timer, "iterative solver");
        return iterate(x, b, tolerance);
      }
    catch (const ExceptionBase &)
      {
        if (spec.accept_unfinished)
          throw LinearizationError("the linear solver broke down");
        ++system.counts->solver_fallbacks;
        x = 0;
        solve_directly(x, b);
        return spec.linear_iterations;
      }
  }
} // namespace impm
