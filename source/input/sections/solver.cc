#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/sections/solver.h>

#include <limits>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    // "Greater than zero" for a pattern that knows closed ranges only.
    const double tiny = std::numeric_limits<double>::min();

    const Choice<bool> bfgs("Nonlinear solver",
                            {{"Newton", false}, {"BFGS", true}});

    const Choice<Convergence> convergences(
      "Convergence",
      {{"residual", Convergence::residual},
       {"increment and energy", Convergence::increment_and_energy}});

    const Choice<ResidualScale> scales("Residual scale",
                                       {{"body", ResidualScale::body},
                                        {"cell", ResidualScale::cell},
                                        {"momentum", ResidualScale::momentum}});

    const Choice<LinearSolverKind>
      linear_solvers("Linear solver",
                     {{"CG", LinearSolverKind::cg},
                      {"GMRES", LinearSolverKind::gmres},
                      {"direct", LinearSolverKind::direct}});

    const Choice<bool> accept_unfinished("Unfinished solves",
                                         {{"direct solver", false},
                                          {"next Newton step", true}});

    const Choice<PreconditionerKind>
      preconditioners("Preconditioner",
                      {{"AMG", PreconditionerKind::amg},
                       {"Jacobi", PreconditionerKind::jacobi},
                       {"none", PreconditionerKind::none}});

    const Choice<TangentKind>
      tangents("Operator",
               {{"matrix", TangentKind::matrix},
                {"matrix-free", TangentKind::matrix_free},
                {"difference quotient", TangentKind::difference_quotient}});

    void
    declare_newton(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      bfgs.declare(prm,
                   "BFGS corrects a tangent that is kept by what later "
                   "iterations show (Matthies & Strang 1979), instead of "
                   "taking a new one in each.");
      if (bfgs.may_be(chosen, "Solver", true))
        prm.declare_entry("BFGS updates",
                          "10",
                          Patterns::Integer(1),
                          "Of a tangent before a new one is taken.");
      convergences.declare(
        prm,
        "What is small when Newton's method stops: the "
        "residual, or what an iteration changes of the "
        "increment, and with it of the energy, in both over "
        "the most in this step (Guilkey & Weiss 2003, eq. 13).");
      if (convergences.may_be(chosen,
                              "Solver",
                              Convergence::increment_and_energy))
        {
          prm.declare_entry("Displacement tolerance",
                            "1e-4",
                            Patterns::Double(tiny, 1),
                            "Norm of an iteration's change over the largest "
                            "one in this step.");
          prm.declare_entry("Energy tolerance",
                            "1e-8",
                            Patterns::Double(tiny, 1),
                            "Product of an iteration's change and residual "
                            "over that of the first iteration.");
        }
      if (convergences.may_be(chosen, "Solver", Convergence::residual))
        {
          scales.declare(prm,
                         "Unit of the norm of residuals. Body: for each body "
                         "that of its forces at a strain of one. Cell: "
                         "largest Young's modulus times dx dy (dz) of the "
                         "smallest cell, of a radian if axisymmetric (Sulsky & "
                         "Kaul 2004, section 3.2.2). "
                         "Momentum: force times time step in N s (their "
                         "section 3.1).");
          prm.declare_entry("Newton tolerance",
                            "1e-7",
                            Patterns::Double(tiny, 1),
                            "Norm of the residual in units of the residual "
                            "scale; with that of the body of the order of an "
                            "error in strain.");
          prm.declare_entry("Newton reduction",
                            "1e-3",
                            Patterns::Double(tiny, 1),
                            "And over that at the start of the step and, with "
                            "inertia, over the forces at work: where little "
                            "happens in a step, it must be solved, too. 1: the "
                            "tolerance alone, so that the first guess may do.");
        }
      prm.declare_entry("Newton iterations",
                        "50",
                        Patterns::Integer(1),
                        "Largest number before the time step is cut.");
      prm.declare_entry("Line search",
                        "true",
                        Patterns::Bool(),
                        "Backtrack where a Newton step does not descend.");
    }

    void
    read_newton(const ParameterHandler &prm, SolverSpec &solver)
    {
      if (bfgs.read(prm))
        solver.bfgs_updates = prm.get_integer("BFGS updates");
      solver.convergence = convergences.read(prm);
      if (solver.convergence == Convergence::increment_and_energy)
        {
          solver.displacement_tolerance =
            prm.get_double("Displacement tolerance");
          solver.energy_tolerance = prm.get_double("Energy tolerance");
        }
      else
        {
          solver.residual_scale   = scales.read(prm);
          solver.newton_tolerance = prm.get_double("Newton tolerance");
          solver.newton_reduction = prm.get_double("Newton reduction");
        }
      solver.newton_iterations = prm.get_integer("Newton iterations");
      solver.line_search       = prm.get_bool("Line search");
    }

    void
    declare_linear_solver(ParameterHandler            &prm,
                          const ParameterFile::Chosen &chosen)
    {
      linear_solvers.declare(prm, "For the Newton steps.");
      if (!linear_solvers.is(chosen, "Solver", LinearSolverKind::direct))
        {
          prm.declare_entry("Linear tolerance",
                            "1e-4",
                            Patterns::Double(tiny, 1),
                            "Residual of a linear solve over its right-hand "
                            "side.");
          prm.declare_entry("Linear iterations",
                            "1000",
                            Patterns::Integer(1),
                            "Largest number in a linear solve.");
          accept_unfinished.declare(prm,
                                    "Who takes over after the largest number.");
          preconditioners.declare(
            prm,
            "AMG: smoothed aggregation of Trilinos ML with "
            "the rigid-body modes.");
          tangents.declare(prm,
                           "How the tangent is applied; AMG needs the matrix "
                           "in any case. Difference quotient: of residuals "
                           "(Sulsky & Kaul 2004, eq. 2.4.18), one evaluation "
                           "of all laws each time.");
          if (tangents.may_be(chosen,
                              "Solver",
                              TangentKind::difference_quotient))
            prm.declare_entry("Difference step",
                              "1e-5",
                              Patterns::Double(1e-12, 0.1),
                              "h of the difference quotient, relative to the "
                              "norm of the increment.");
        }
      if (linear_solvers.may_be(chosen, "Solver", LinearSolverKind::gmres))
        prm.declare_entry("GMRES directions",
                          "50",
                          Patterns::Integer(2),
                          "Before a restart.");
    }

    void
    read_linear_solver(const ParameterHandler &prm, SolverSpec &solver)
    {
      solver.linear_solver = linear_solvers.read(prm);
      if (solver.linear_solver != LinearSolverKind::direct)
        {
          solver.linear_tolerance  = prm.get_double("Linear tolerance");
          solver.linear_iterations = prm.get_integer("Linear iterations");
          solver.accept_unfinished = accept_unfinished.read(prm);
          solver.preconditioner    = preconditioners.read(prm);
          solver.tangent           = tangents.read(prm);
          if (solver.tangent == TangentKind::difference_quotient)
            solver.difference_step = prm.get_double("Difference step");
        }
      if (solver.linear_solver == LinearSolverKind::gmres)
        solver.gmres_directions = prm.get_integer("GMRES directions");
    }

    void
    check_symmetry(const ParameterHandler &prm,
                   const SolverSpec       &solver,
                   const TimeSpec         &time)
    {
      if (time.momentum_formulation &&
          solver.linear_solver == LinearSolverKind::cg)
        throw InputError("Linear solver",
                         "found 'CG', which needs a symmetric matrix, but the "
                         "momentum formulation has none: allowed are GMRES, "
                         "direct");
      if (solver.bfgs_updates == 0)
        return;
      if (time.momentum_formulation)
        throw InputError("Nonlinear solver",
                         "found 'BFGS', which keeps a symmetric matrix, "
                         "allowed with the momentum formulation, whose "
                         "tangent is unsymmetric, is 'Newton'");
      if (solver.tangent != TangentKind::matrix)
        throw InputError("Operator",
                         "found '" + prm.get("Operator") +
                           "', allowed with 'Nonlinear solver = BFGS', "
                           "which keeps a tangent, is 'matrix'");
    }
  } // namespace

  void
  declare_solver(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Solver");
    if (!is_explicit(chosen))
      {
        declare_newton(prm, chosen);
        declare_linear_solver(prm, chosen);
      }
    prm.leave_subsection();
  }

  SolverSpec
  read_solver(ParameterHandler &prm, const TimeSpec &time)
  {
    SolverSpec solver;
    if (!time.is_explicit())
      in_section(prm, "Solver", [&]() {
        read_newton(prm, solver);
        read_linear_solver(prm, solver);
        check_symmetry(prm, solver, time);
      });
    return solver;
  }

  template <int dim>
  void
  check_solver(const SolverSpec  &solver,
               const TimeSpec    &time,
               const Bodies<dim> &bodies)
  {
    if (time.is_explicit())
      return; // nothing is solved
    for (const auto &body : bodies)
      if (!body.rigid && !body.material->has_symmetric_tangent())
        {
          const std::string law =
            ", which needs a symmetric matrix, but the law of body '" +
            body.name + "' has none: allowed ";
          if (solver.linear_solver == LinearSolverKind::cg)
            throw InputError("Solver/Linear solver",
                             "found 'CG'" + law + "are GMRES, direct");
          if (solver.bfgs_updates > 0)
            throw InputError("Solver/Nonlinear solver",
                             "found 'BFGS'" + law + "is Newton");
        }
  }

  template void
  check_solver(const SolverSpec &, const TimeSpec &, const Bodies<2> &);
  template void
  check_solver(const SolverSpec &, const TimeSpec &, const Bodies<3> &);
} // namespace impm
