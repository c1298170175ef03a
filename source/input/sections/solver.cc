#include <impm/input/sections/solver.h>

#include <algorithm>

namespace impm
{
  namespace
  {
    const Choice<bool> bfgs("Nonlinear solver",
                            {{"Newton", false}, {"BFGS", true}});

    const Choice<Convergence> convergences(
      "Convergence",
      {{"residual", Convergence::residual},
       {"increment and energy", Convergence::increment_and_energy}});

    const Choice<LinearSolverKind>
      linear_solvers("Linear solver",
                     {{"automatic", LinearSolverKind::automatic},
                      {"CG", LinearSolverKind::cg},
                      {"GMRES", LinearSolverKind::gmres},
                      {"direct", LinearSolverKind::direct}});

    const Choice<TangentKind>
      tangents("Operator",
               {{"matrix", TangentKind::matrix},
                {"matrix-free", TangentKind::matrix_free},
                {"difference quotient", TangentKind::difference_quotient}});

    void
    add_newton(const Section &section, SolverSpec &solver)
    {
      bool keeps_tangent;
      section.add(bfgs,
                  keeps_tangent,
                  "BFGS corrects a tangent that is kept by what later "
                  "iterations show (Matthies & Strang 1979), instead of "
                  "taking a new one in each.");
      if (section.chooses(bfgs, true))
        section.add("BFGS updates",
                    solver.bfgs_updates,
                    {"10", 1},
                    "Of a tangent before a new one is taken.");
      section.add(convergences,
                  solver.convergence,
                  "What is small when Newton's method stops: the residual, or "
                  "what an iteration changes of the increment, and with it of "
                  "the energy, in both over the most in this step (Guilkey & "
                  "Weiss 2003, eq. 13).");
      if (section.chooses(convergences, Convergence::increment_and_energy))
        {
          section.add("Displacement tolerance",
                      solver.displacement_tolerance,
                      {"1e-4", above_zero, 1},
                      "Norm of an iteration's change over the largest one in "
                      "this step.");
          section.add("Energy tolerance",
                      solver.energy_tolerance,
                      {"1e-8", above_zero, 1},
                      "Product of an iteration's change and residual over "
                      "that of the first iteration.");
        }
      if (section.chooses(convergences, Convergence::residual))
        {
          section.add("Residual scale",
                      solver.residual_scale,
                      {{"body", ResidualScale::body},
                       {"cell", ResidualScale::cell},
                       {"momentum", ResidualScale::momentum}},
                      "Unit of the norm of residuals. Body: for each body "
                      "that of its forces at a strain of one. Cell: largest "
                      "Young's modulus times dx dy (dz) of the smallest cell, "
                      "of a radian if axisymmetric (Sulsky & Kaul 2004, "
                      "section 3.2.2). Momentum: force times time step in N s "
                      "(their section 3.1).");
          section.add("Newton tolerance",
                      solver.newton_tolerance,
                      {"1e-7", above_zero, 1},
                      "Norm of the residual in units of the residual scale; "
                      "with that of the body of the order of an error in "
                      "strain.");
          section.add("Newton reduction",
                      solver.newton_reduction,
                      {"1e-3", above_zero, 1},
                      "And over that at the start of the step and, with "
                      "inertia, over the forces at work: where little happens "
                      "in a step, it must be solved, too. 1: the tolerance "
                      "alone, so that the first guess may do.");
        }
      section.add("Newton iterations",
                  solver.newton_iterations,
                  {"50", 1},
                  "Largest number before the time step is cut.");
      section.add("Line search",
                  solver.line_search,
                  true,
                  "Backtrack where a Newton step does not descend.");
    }

    void
    add_linear_solver(const Section &section, SolverSpec &solver)
    {
      section.add(
        linear_solvers,
        solver.linear_solver,
        "For the Newton steps. Automatic: direct for small systems, "
        "else CG or, where the matrix is not symmetric, GMRES; the "
        "latter two in any case where another preconditioner than "
        "multigrid or another operator than the matrix is asked for.");
      if (solver.linear_solver != LinearSolverKind::direct)
        {
          section.add("Linear tolerance",
                      solver.linear_tolerance,
                      {"1e-4", above_zero, 1},
                      "Residual of a linear solve over its right-hand side.");
          section.add("Linear iterations",
                      solver.linear_iterations,
                      {"1000", 1},
                      "Largest number in a linear solve.");
          section.add("Unfinished solves",
                      solver.accept_unfinished,
                      {{"direct solver", false}, {"next Newton step", true}},
                      "Who takes over after the largest number.");
          section.add(
            "Preconditioner",
            solver.preconditioner,
            {{"multigrid", PreconditionerKind::multigrid},
             {"AMG", PreconditionerKind::amg},
             {"Jacobi", PreconditionerKind::jacobi},
             {"none", PreconditionerKind::none}},
            "Multigrid: geometric, on the grid and coarser ones. "
            "AMG: algebraic, smoothed aggregation of Trilinos ML with "
            "the rigid-body modes.");
          section.add(
            tangents,
            solver.tangent,
            "How the tangent is applied; multigrid of either kind "
            "needs the matrix in any case. Difference quotient: of residuals (Sulsky & "
            "Kaul 2004, eq. 2.4.18), one evaluation of all laws "
            "each time.");
          if (section.chooses(tangents, TangentKind::difference_quotient))
            section.add("Difference step",
                        solver.difference_step,
                        {"1e-5", 1e-12, 0.1},
                        "h of the difference quotient, relative to the norm "
                        "of the increment; less where that turns a point "
                        "inside out.");
        }
      if (section.chooses(linear_solvers, LinearSolverKind::automatic) ||
          section.chooses(linear_solvers, LinearSolverKind::gmres))
        section.add("GMRES directions",
                    solver.gmres_directions,
                    {"50", 2},
                    "Before a restart.");
    }

    /** Where the matrix is not symmetric, not every method will do. */
    template <int dim>
    void
    check_symmetry(const Section     &section,
                   SolverSpec        &solver,
                   const TimeSpec    &time,
                   const Bodies<dim> &bodies,
                   const bool         has_following_loads)
    {
      std::string what;
      if (has_following_loads)
        what = "a pressure or torque, which follows a surface,";
      for (const auto &body : bodies)
        if (body.material && !body.material->has_symmetric_tangent())
          what = "the law of body '" + body.name + "'";
      if (time.momentum_formulation)
        what = "the momentum formulation";
      if (time.integrator == Integrator::energy_momentum)
        what = "the energy-momentum method";
      solver.has_symmetric_matrix = what.empty();
      if (what.empty())
        return;
      const std::string flaw =
        "which needs a symmetric matrix, but " + what + " has none: allowed ";
      if (solver.linear_solver == LinearSolverKind::cg)
        section.refuse("Linear solver", flaw + "are GMRES, direct");
      if (solver.bfgs_updates == 0)
        return;
      section.refuse("Nonlinear solver", flaw + "is Newton");
    }
  } // namespace

  template <int dim>
  void
  add_solver(const Section     &top,
             SolverSpec        &solver,
             const TimeSpec    &time,
             const Bodies<dim> &bodies,
             const bool         has_following_loads)
  {
    const auto section = top.subsection("Solver");
    if (time.is_explicit())
      return; // nothing is solved
    if (time.integrator == Integrator::energy_momentum &&
        std::any_of(bodies.begin(), bodies.end(), [](const auto &body) {
          return body.material &&
                 body.material->form() == Material::Form::linearized;
        }))
      top.subsection("Time").refuse("Integrator",
                                    "which needs finite strains, not a "
                                    "'linear' law: allowed are the others");
    add_newton(section, solver);
    add_linear_solver(section, solver);
    check_symmetry(section, solver, time, bodies, has_following_loads);
    if (!time.has_inertia() && solver.has_symmetric_matrix &&
        solver.linear_solver != LinearSolverKind::gmres)
      section.add(
        "Unstable equilibria",
        solver.unstable_equilibria,
        {{"leave", UnstableEquilibria::leave},
         {"warn", UnstableEquilibria::warn},
         {"ignore", UnstableEquilibria::ignore}},
        "Where the tangent at the start of a step is not positive, as "
        "past the load under which a column buckles: leave it for a "
        "stable one and warn, go on and warn, or do not look.");
    if (solver.bfgs_updates > 0 && solver.tangent != TangentKind::matrix)
      section.refuse("Operator",
                     "allowed with 'Nonlinear solver = BFGS', which keeps a "
                     "tangent, is 'matrix'");
  }

  template void
  add_solver(
    const Section &, SolverSpec &, const TimeSpec &, const Bodies<2> &, bool);
  template void
  add_solver(
    const Section &, SolverSpec &, const TimeSpec &, const Bodies<3> &, bool);
} // namespace impm
