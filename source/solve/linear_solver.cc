#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_gmres.h>

#include <impm/base/exceptions.h>
#include <impm/solve/linear_solver.h>

#include <Teuchos_ParameterList.hpp>

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

  template <int dim>
  LinearSolver<dim>::LinearSolver(const SolverSpec     &spec,
                                  MomentumBalance<dim> &balance,
                                  TimerOutput          &timer)
    : spec(spec)
    , balance(balance)
    , quotient(balance, spec.difference_step)
    , timer(timer)
  {
    balance.grid.initialize(inverse_diagonal);
  }

  template <int dim>
  void
  LinearSolver<dim>::begin_step()
  {
    factors.reset();
    matrix_is_current = false;
    if (needs_matrix())
      {
        TimerOutput::Scope scope(timer, "sparsity");
        balance.initialize_matrix(matrix);
      }
  }

  template <int dim>
  void
  LinearSolver<dim>::linearize_at(const Vector &u)
  {
    if (spec.tangent == TangentKind::difference_quotient)
      quotient.linearize_at(u);
  }

  template <int dim>
  void
  LinearSolver<dim>::vmult_lift(Vector &dst, const Vector &src)
  {
    if (spec.tangent == TangentKind::difference_quotient)
      quotient.vmult_lift(dst, src);
    else
      balance.vmult_lift(dst, src);
  }

  template <int dim>
  void
  LinearSolver<dim>::update_preconditioner()
  {
    if (spec.preconditioner == PreconditionerKind::jacobi)
      {
        balance.diagonal(inverse_diagonal);
        for (unsigned int i = 0; i < inverse_diagonal.locally_owned_size(); ++i)
          inverse_diagonal.local_element(i) =
            1 / inverse_diagonal.local_element(i);
      }
    else if (solves_for_momentum())
      balance.inverse_mass(inverse_diagonal);
    else if (spec.preconditioner == PreconditionerKind::amg)
      {
        TimerOutput::Scope scope(timer, "preconditioner");
        // ML keeps the address of the modes. Rotations are modes of plane and
        // solid bodies; around the axis there are none.
        const auto        &positions = balance.grid.node_positions();
        const bool         rotations = balance.has_rotations();
        const unsigned int n_modes =
          dim + (rotations ? dim * (dim - 1) / 2 : 0);
        const unsigned int n = inverse_diagonal.locally_owned_size();
        rigid_body_modes.assign(std::max(1u, n * n_modes), 0.);
        for (unsigned int i = 0; i < n; ++i)
          {
            if (balance.constraints.is_constrained[i])
              continue;
            const unsigned int c        = i % dim;
            rigid_body_modes[c * n + i] = 1;
            unsigned int mode           = dim;
            if (rotations)
              for (unsigned int a = 0; a < dim; ++a)
                for (unsigned int b = a + 1; b < dim; ++b, ++mode)
                  rigid_body_modes[mode * n + i] =
                    c == a ? -positions[i / dim][b] :
                    c == b ? positions[i / dim][a] :
                             0.;
          }
        Teuchos::ParameterList                            parameters;
        TrilinosWrappers::PreconditionAMG::AdditionalData data;
        data.elliptic              = true;
        data.higher_order_elements = false;
        data.smoother_sweeps       = 2;
        data.aggregation_threshold = 0.02;
        std::unique_ptr<Epetra_MultiVector> unused;
        data.set_parameters(parameters, unused, matrix);
        parameters.set("null space: type", "pre-computed");
        parameters.set("null space: dimension", static_cast<int>(n_modes));
        parameters.set("null space: vectors", rigid_body_modes.data());
        amg.initialize(matrix, parameters);
      }
  }

  template <int dim>
  unsigned int
  LinearSolver<dim>::iterate(Vector &x, const Vector &b, const double tolerance)
  {
    const double           goal = tolerance * b.l2_norm();
    SolverControl          strict(spec.linear_iterations, goal);
    IterationNumberControl lenient(spec.linear_iterations, goal);
    SolverControl         &control = spec.accept_unfinished ? lenient : strict;
    Operator               tangent;
    tangent.apply = [&](Vector &dst, const Vector &src) {
      if (spec.tangent == TangentKind::matrix)
        balance.vmult_by_matrix(matrix, dst, src);
      else if (spec.tangent == TangentKind::matrix_free)
        balance.vmult(dst, src);
      else
        quotient.vmult(dst, src);
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
        data.max_n_tmp_vectors     = spec.gmres_directions + 2;
        data.right_preconditioning = true;
        SolverGMRES<Vector> solver(control, data);
        run(solver);
      }
    return control.last_step();
  }

  template <int dim>
  void
  LinearSolver<dim>::solve_directly(Vector &x, const Vector &b)
  {
    TimerOutput::Scope scope(timer, "direct solver");
    // What has been factorized must stay: a tangent may be solved with again.
    if (!matrix_is_current)
      {
        if (!needs_matrix())
          balance.initialize_matrix(matrix);
        balance.assemble(matrix);
        matrix_is_current = true;
      }
    try
      {
        if (!factors)
          {
            factors = std::make_unique<TrilinosWrappers::SolverDirect>(
              direct_control, TrilinosWrappers::SolverDirect::AdditionalData());
            factors->initialize(matrix);
          }
        factors->solve(x, b);
      }
    catch (const dealii::ExceptionBase &)
      {
        factors.reset();
        throw ComputationError("the linear system is singular");
      }
  }

  template <int dim>
  void
  LinearSolver<dim>::take_tangent()
  {
    ++n_tangents;
    factors.reset();
    matrix_is_current = false;
    if (needs_matrix())
      {
        TimerOutput::Scope scope(timer, "assembly");
        balance.assemble(matrix);
        matrix_is_current = true;
      }
    if (spec.linear_solver != LinearSolverKind::direct)
      update_preconditioner();
  }

  template <int dim>
  unsigned int
  LinearSolver<dim>::solve(Vector &x, const Vector &b, const double tolerance)
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
    catch (const dealii::ExceptionBase &)
      {
        if (spec.accept_unfinished)
          throw LinearizationError("the linear solver broke down");
        ++n_fallbacks;
        x = 0;
        solve_directly(x, b);
        return spec.linear_iterations;
      }
  }

  template class LinearSolver<2>;
  template class LinearSolver<3>;
} // namespace impm
