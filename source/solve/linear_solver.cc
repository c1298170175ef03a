#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <impm/base/compat.h>
#include <impm/base/exceptions.h>
#include <impm/solve/linear_solver.h>
#include <impm/solve/linear_solver_choice.h>
#include <impm/solve/negative_curvature.h>

namespace impm
{
  using namespace dealii;

  LinearSolver::LinearSolver(const SolverSpec &spec,
                             NonlinearSystem  &system,
                             TimerOutput      &timer)
    : spec(spec)
    , system(system)
    , timer(timer)
    , quotient(system, spec.difference_step)
    , unknowns(system.make_unknowns())
    , kind(choose_linear_solver(spec, unknowns.n_components, unknowns.size()))
    , needs_matrix(kind == LinearSolverKind::direct ||
                   spec.tangent == TangentKind::matrix || spec.has_hierarchy())
  {
    ++(kind == LinearSolverKind::direct ? system.counts->direct_systems :
                                          system.counts->iterative_systems);
    for (Vector *vector : {&solution, &right_side, &inverse_diagonal})
      unknowns.initialize(*vector);
    if (spec.tangent != TangentKind::matrix ||
        spec.preconditioner == PreconditionerKind::jacobi)
      for (Vector *vector : {&full_src, &full_dst})
        system.initialize(*vector);
  }

  NonlinearSystem::Evaluation
  LinearSolver::evaluate(const Vector &u, const bool with_tangent)
  {
    TimerOutput::Scope scope(timer, "points");
    const auto         result =
      system.evaluate(u, with_tangent && !spec.without_tangent());
    if (spec.tangent == TangentKind::difference_quotient)
      quotient.linearize_at(u);
    return result;
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
      {
        TimerOutput::Scope scope(timer, "sparsity");
        matrix                      = system.make_matrix(unknowns);
        system.counts->matrix_bytes = matrix->memory_consumption();
      }
    TimerOutput::Scope scope(timer, "assembly");
    system.assemble(*matrix);
  }

  void
  LinearSolver::take_tangent()
  {
    system.take_tangent();
    take_sparse_tangent();
    take_correction();
  }

  void
  LinearSolver::take_sparse_tangent()
  {
    ++system.counts->tangents;
    is_factorized = false;
    if (needs_matrix)
      assemble();
    if (kind == LinearSolverKind::direct)
      return;
    if (spec.has_hierarchy())
      {
        hierarchy_is_old = preconditioner.vmult && !hierarchy_is_worn &&
                           place_of_matrix == matrix->place_of_entries();
        if (!hierarchy_is_old)
          set_up_hierarchy();
        return;
      }
    preconditioner = {};
    // Unknowns that are momenta are near enough to the right-hand side: an
    // increment of a node with little mass says little.
    if (spec.preconditioner == PreconditionerKind::jacobi)
      {
        system.diagonal(full_dst);
        unknowns.pack(full_dst, inverse_diagonal);
      }
    else if (system.weight_of_unknowns() != nullptr)
      unknowns.pack(*system.weight_of_unknowns(), inverse_diagonal);
    else
      return;
    for (unsigned int i = 0; i < inverse_diagonal.locally_owned_size(); ++i)
      inverse_diagonal.local_element(i) =
        unknowns.is_held(i) ? 1. : 1 / inverse_diagonal.local_element(i);
    preconditioner.vmult = [this](Vector &dst, const Vector &src) {
      dst = src;
      dst.scale(inverse_diagonal);
    };
  }

  void
  LinearSolver::set_up_hierarchy()
  {
    TimerOutput::Scope scope(timer, "preconditioner");
    ++system.counts->hierarchies;
    preconditioner   = {}; // two at a time were the peak of a run's memory
    preconditioner   = spec.preconditioner == PreconditionerKind::amg ?
                         make_amg(*matrix, system.near_null_space(unknowns)) :
                         make_multigrid(*matrix, system.lattice(unknowns));
    hierarchy_is_old = false;
    place_of_matrix  = matrix->place_of_entries();
  }

  unsigned int
  LinearSolver::iterate_or_renew()
  {
    if (!spec.has_hierarchy())
      return iterate();
    // One of an earlier tangent does for this one, too, until it costs about
    // as many iterations as a new one costs time, or lets them fail.
    constexpr unsigned int worth_a_new_one = 10;
    if (hierarchy_is_old)
      try
        {
          const unsigned int n = iterate();
          hierarchy_is_worn    = n > iterations_when_new + worth_a_new_one;
          return n;
        }
      catch (const ExceptionBase &)
        {
          solution = 0;
          set_up_hierarchy();
        }
    hierarchy_is_worn   = true; // if this fails
    iterations_when_new = iterate();
    hierarchy_is_worn   = false;
    return iterations_when_new;
  }

  unsigned int
  LinearSolver::iterate()
  {
    TimerOutput::Scope     scope(timer, "iterative solver");
    const double           goal = spec.linear_tolerance * right_side.l2_norm();
    SolverControl          strict(spec.linear_iterations, goal);
    IterationNumberControl lenient(spec.linear_iterations, goal);
    SolverControl         &control = spec.accept_unfinished ? lenient : strict;
    LinearMap              tangent;
    tangent.vmult = [&](Vector &dst, const Vector &src) {
      if (spec.tangent == TangentKind::matrix)
        {
          ++system.counts->operator_applications;
          matrix->vmult(dst, src);
          return;
        }
      unknowns.unpack(src, full_src);
      if (spec.tangent == TangentKind::difference_quotient)
        quotient.vmult(full_dst, full_src);
      else
        system.vmult(full_dst, full_src);
      unknowns.pack(full_dst, dst);
    };
    const auto run = [&](auto &&solver) {
      if (preconditioner.vmult)
        solver.solve(tangent, solution, right_side, preconditioner);
      else
        solver.solve(tangent, solution, right_side, PreconditionIdentity());
    };
    if (kind == LinearSolverKind::cg)
      run(SolverCG<Vector>(control));
    else
      {
        SolverGMRES<Vector>::AdditionalData data;
        compat::set_basis_size(data, spec.gmres_directions);
        data.right_preconditioning = true;
        run(SolverGMRES<Vector>(control, data));
      }
    return control.last_step();
  }

  void
  LinearSolver::take_correction()
  {
    // A difference quotient has all of the tangent.
    if (spec.tangent == TangentKind::difference_quotient)
      return;
    correction           = system.correction();
    const unsigned int n = correction.left.size();
    of_correction.reinit(n, n);
    for (auto &left : correction.left)
      {
        Vector answer = left;
        correction_iterations += solve_sparse(answer, left);
        system.set_zero(answer);
        left.swap(answer);
      }
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        of_correction(i, j) =
          (i == j ? 1. : 0.) + correction.right[i] * correction.left[j];
    if (n > 0)
      of_correction.gauss_jordan();
  }

  unsigned int
  LinearSolver::solve(Vector &x, const Vector &b)
  {
    unsigned int n_iterations = solve_sparse(x, b);
    n_iterations += correction_iterations;
    correction_iterations = 0;
    std::vector<double> products;
    for (const auto &right : correction.right)
      products.push_back(right * x);
    for (unsigned int i = 0; i < products.size(); ++i)
      {
        double factor = 0;
        for (unsigned int j = 0; j < products.size(); ++j)
          factor += of_correction(i, j) * products[j];
        x.add(-factor, correction.left[i]);
      }
    return n_iterations;
  }

  unsigned int
  LinearSolver::solve_sparse(Vector &x, const Vector &b)
  {
    const bool is_direct = kind == LinearSolverKind::direct;
    solution             = 0;
    unknowns.pack(b, right_side);
    const auto answer = [&](const unsigned int n_iterations) {
      unknowns.unpack(solution, x);
      return n_iterations;
    };
    if (!is_direct)
      try
        {
          return answer(iterate_or_renew());
        }
      catch (const ExceptionBase &)
        {
          if (spec.accept_unfinished)
            throw LinearizationError("the linear solver broke down");
          ++system.counts->solver_fallbacks;
          if (spec.linear_solver == LinearSolverKind::automatic && needs_matrix)
            kind = LinearSolverKind::direct;
          solution = 0;
        }
    // What has been factorized must stay: a tangent may be solved with again.
    if (!needs_matrix && !is_factorized)
      assemble();
    TimerOutput::Scope scope(timer, "direct solver");
    factorize();
    direct->solve(solution, right_side);
    return answer(is_direct ? 1 : spec.linear_iterations);
  }

  void
  LinearSolver::factorize()
  {
    if (!direct)
      direct =
        std::make_unique<DirectSolver>(*matrix, spec.has_symmetric_matrix);
    if (!is_factorized)
      direct->factorize();
    is_factorized = true;
  }

  bool
  LinearSolver::find_negative_curvature(Vector &direction)
  {
    const bool is_direct = kind == LinearSolverKind::direct;
    if (!needs_matrix || (!is_direct && !preconditioner.vmult))
      return false;
    TimerOutput::Scope scope(timer, "stability");
    LinearMap          inverse = preconditioner;
    if (is_direct)
      {
        factorize();
        if (direct->is_positive())
          return false;
        inverse.vmult = [this](Vector &dst, const Vector &src) {
          direct->solve(dst, src);
        };
      }
    Vector mode;
    if (!impm::find_negative_curvature(*matrix, inverse, is_direct, mode))
      return false;
    unknowns.unpack(mode, direction);
    return true;
  }
} // namespace impm
