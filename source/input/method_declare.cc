#include <deal.II/base/patterns.h>

#include <impm/input/scene_sections.h>

#include <limits>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    // "Greater than zero" for a pattern that knows closed ranges only.
    const double tiny = std::numeric_limits<double>::min();
  } // namespace

  void
  declare_time(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Time");
    prm.declare_entry("Integrator",
                      "quasi-static",
                      Patterns::Selection(
                        "quasi-static|explicit|theta|Newmark"),
                      "Quasi-static: no inertia. Explicit and theta: Sulsky "
                      "& Kaul (2004), section 2.3.1 and eq. 2.4.1. Newmark: "
                      "Guilkey & Weiss (2003).");
    const auto integrator = chosen("Time/Integrator", "quasi-static");
    if (may_be(integrator, "Newmark"))
      {
        prm.declare_entry("Beta",
                          "0.25",
                          Patterns::Double(0.01, 0.5),
                          "Weight of the acceleration at the end in the "
                          "displacement; 0.25: trapezoidal.");
        prm.declare_entry("Gamma",
                          "0.5",
                          Patterns::Double(0.5, 1),
                          "The same in the velocity; above 0.5 it damps.");
        prm.declare_entry("Acceleration from",
                          "grid",
                          Patterns::Selection("grid|points"),
                          "At the start of a step: from the forces on the "
                          "grid as it is, or as the points carry it (Guilkey "
                          "& Weiss 2003), which loses energy in long steps.");
      }
    if (may_be(integrator, "theta"))
      prm.declare_entry("Theta",
                        "1",
                        Patterns::Double(0, 1),
                        "Weight of the forces at the end of the step (mu in "
                        "the paper); 1: backward Euler, 0.5: trapezoidal, 0: "
                        "explicit. Below 0.5, long steps are unstable.");
    if (integrator != "quasi-static" &&
        chosen("Grid/Method", "MPM") != "Lagrangian")
      prm.declare_entry("Formulation",
                        "velocity",
                        Patterns::Selection("velocity|momentum"),
                        "Strain from the grid's velocity, or from one that "
                        "has been mapped to the points and back (Sulsky & "
                        "Kaul 2004, section 3.2.1), which spares nodes with "
                        "little mass and makes the tangent unsymmetric.");
    if (integrator != "quasi-static" &&
        chosen("Grid/Method", "MPM") != "Lagrangian")
      prm.declare_entry("Transfer",
                        "FLIP",
                        Patterns::Selection("FLIP|PIC|APIC"),
                        "Velocities of points: they take the change of the "
                        "grid's (FLIP), its value (PIC, which damps), or its "
                        "value and gradient (APIC).");
    prm.declare_entry("End time",
                      "1",
                      Patterns::Double(tiny),
                      "When the run ends (s).");
    if (integrator != "quasi-static")
      prm.declare_entry("CFL number",
                        "0",
                        Patterns::Double(0),
                        "Time step in units of the smallest cell over the "
                        "largest speed of elastic waves and points; 0: given "
                        "in seconds.");
    const auto cfl_number = chosen("Time/CFL number", "0");
    if (cfl_number == "any" || Patterns::Double(0, 0).match(cfl_number))
      prm.declare_entry("Time step",
                        "0.01",
                        Patterns::Double(tiny),
                        "Of the first step (s).");
    prm.declare_entry("Growth",
                      "1",
                      Patterns::Double(1, 2),
                      "Factor from one time step to the next.");
    prm.declare_entry("Largest time step",
                      "",
                      Patterns::Anything(),
                      "Where growth ends (s, or CFL number); empty: the "
                      "first step's.");
    prm.declare_entry("Smallest time step",
                      "0.001",
                      Patterns::Double(tiny, 1),
                      "How small a step may be cut before the run gives up, "
                      "as a fraction of the first step.");
    prm.declare_entry("Largest number of steps",
                      "10000000",
                      Patterns::Integer(1),
                      "The run ends there at the latest.");
    prm.leave_subsection();
  }

  void
  declare_solver(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Solver");
    if (chosen("Time/Integrator", "quasi-static") == "explicit")
      {
        prm.leave_subsection();
        return;
      }
    prm.declare_entry("Nonlinear solver",
                      "Newton",
                      Patterns::Selection("Newton|BFGS"),
                      "BFGS corrects a tangent that is kept by what later "
                      "iterations show (Matthies & Strang 1979), instead of "
                      "taking a new one in each.");
    if (may_be(chosen("Solver/Nonlinear solver", "Newton"), "BFGS"))
      prm.declare_entry("BFGS updates",
                        "10",
                        Patterns::Integer(1),
                        "Of a tangent before a new one is taken.");
    prm.declare_entry("Convergence",
                      "residual",
                      Patterns::Selection("residual|increment and energy"),
                      "What is small when Newton's method stops: the "
                      "residual, or what an iteration changes of the "
                      "increment, and with it of the energy, in both over "
                      "the most in this step (Guilkey & Weiss 2003, eq. 13).");
    const auto convergence = chosen("Solver/Convergence", "residual");
    if (may_be(convergence, "increment and energy"))
      {
        prm.declare_entry("Displacement tolerance",
                          "1e-4",
                          Patterns::Double(tiny, 1),
                          "Norm of an iteration's change over the largest one "
                          "in this step.");
        prm.declare_entry("Energy tolerance",
                          "1e-8",
                          Patterns::Double(tiny, 1),
                          "Product of an iteration's change and residual over "
                          "that of the first iteration.");
      }
    if (may_be(convergence, "residual"))
      {
        prm.declare_entry(
          "Residual scale",
          "body",
          Patterns::Selection("body|cell|momentum"),
          "Unit of the norm of residuals. Body: that of the "
          "forces of all material at a strain of one. Cell: "
          "largest Young's modulus times dx dy (dz) of the "
          "smallest cell, of a radian if axisymmetric (Sulsky & "
          "Kaul 2004, section 3.2.2). "
          "Momentum: force times time step in N s (their section "
          "3.1).");
        prm.declare_entry(
          "Newton tolerance",
          "1e-7",
          Patterns::Double(tiny, 1),
          "Norm of the residual in units of the residual scale; "
          "with that of the body of the order of an error in "
          "strain.");
        prm.declare_entry(
          "Newton reduction",
          "1e-3",
          Patterns::Double(tiny, 1),
          "And over that at the start of the step: where little "
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
    prm.declare_entry("Linear solver",
                      "CG",
                      Patterns::Selection("CG|GMRES|direct"),
                      "For the Newton steps.");
    const auto solver = chosen("Solver/Linear solver", "CG");
    if (solver != "direct")
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
        prm.declare_entry("Unfinished solves",
                          "direct solver",
                          Patterns::Selection("direct solver|next Newton step"),
                          "Who takes over after the largest number.");
        prm.declare_entry("Preconditioner",
                          "AMG",
                          Patterns::Selection("AMG|Jacobi|none"),
                          "AMG: smoothed aggregation of Trilinos ML with "
                          "the rigid-body modes.");
        prm.declare_entry("Operator",
                          "matrix",
                          Patterns::Selection(
                            "matrix|matrix-free|difference quotient"),
                          "How the tangent is applied; AMG needs the matrix "
                          "in any case. Difference quotient: of residuals "
                          "(Sulsky & Kaul 2004, eq. 2.4.18), one evaluation "
                          "of all laws each time.");
        if (may_be(chosen("Solver/Operator", "matrix"), "difference quotient"))
          prm.declare_entry("Difference step",
                            "1e-5",
                            Patterns::Double(1e-12, 0.1),
                            "h of the difference quotient, relative to the "
                            "norm of the increment.");
      }
    if (may_be(solver, "GMRES"))
      prm.declare_entry("GMRES directions",
                        "50",
                        Patterns::Integer(2),
                        "Before a restart.");
    prm.leave_subsection();
  }

  void
  declare_stabilization(ParameterHandler            &prm,
                        const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Stabilization");
    // Cells of a Lagrangian grid are full; explicit forces need no solve.
    if (chosen("Grid/Method", "MPM") == "Lagrangian" ||
        chosen("Time/Integrator", "quasi-static") == "explicit")
      {
        prm.leave_subsection();
        return;
      }
    prm.declare_entry("Ghost penalty",
                      "0.033",
                      Patterns::Double(0, 10),
                      "On jumps of the gradient of the increment between "
                      "cells at the edge of a body, in units of Young's "
                      "modulus; 0: none.");
    if (may_be(chosen("Time/Integrator", "quasi-static"), "quasi-static"))
      prm.declare_entry("Isolated stiffness",
                        "1e-3",
                        Patterns::Double(0, 1),
                        "Stiffness that holds cells which touch no other "
                        "material when there is no inertia, in units of "
                        "Young's modulus; 0: none.");
    prm.leave_subsection();
  }
} // namespace impm
