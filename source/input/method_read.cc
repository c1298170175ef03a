#include <impm/base/exceptions.h>
#include <impm/input/scene_sections.h>

namespace impm
{
  using dealii::ParameterHandler;

  TimeSpec
  read_time(const ParameterHandler &prm, const bool lagrangian)
  {
    TimeSpec time;
    time.integrator = prm.get("Integrator");
    if (time.integrator == "theta")
      time.theta = prm.get_double("Theta");
    if (time.integrator == "explicit")
      time.theta = 0;
    if (!lagrangian && time.integrator != "quasi-static")
      time.momentum_formulation = prm.get("Formulation") == "momentum";
    if (time.integrator == "Newmark")
      {
        time.beta               = prm.get_double("Beta");
        time.gamma              = prm.get_double("Gamma");
        time.keeps_acceleration = prm.get("Acceleration from") == "points";
      }
    if (lagrangian)
      time.transfer = TransferKind::pic; // points only show the motion
    else if (time.integrator != "quasi-static")
      {
        const std::string transfer = prm.get("Transfer");
        time.transfer              = transfer == "FLIP" ? TransferKind::flip :
                                     transfer == "PIC"  ? TransferKind::pic :
                                                          TransferKind::apic;
        if (time.momentum_formulation && transfer != "FLIP")
          throw InputError("Transfer",
                           "found '" + transfer +
                             "', allowed in the momentum formulation, which "
                             "maps changes of velocity, is FLIP");
      }
    time.end = prm.get_double("End time");
    if (time.integrator != "quasi-static")
      time.cfl_number = prm.get_double("CFL number");
    const std::string step_entry =
      time.cfl_number > 0 ? "CFL number" : "Time step";
    time.step         = prm.get_double(step_entry);
    time.growth       = prm.get_double("Growth");
    time.largest_step = time.step;
    if (!prm.get("Largest time step").empty())
      time.largest_step = get_numbers(prm, "Largest time step", 1)[0];
    if (time.largest_step < time.step)
      throw InputError("Largest time step",
                       "found '" + prm.get("Largest time step") +
                         "', allowed is at least '" + step_entry +
                         "' = " + prm.get(step_entry));
    if (time.growth > 1 && time.largest_step == time.step)
      throw InputError("Growth",
                       "found '" + prm.get("Growth") +
                         "', which does nothing without a 'Largest time "
                         "step' above '" +
                         step_entry + "'");
    time.smallest_step           = prm.get_double("Smallest time step");
    time.largest_number_of_steps = prm.get_integer("Largest number of steps");
    return time;
  }

  SolverSpec
  read_solver(const ParameterHandler &prm, const TimeSpec &time)
  {
    SolverSpec solver;
    if (prm.get("Convergence") == "residual")
      {
        const std::string scale = prm.get("Residual scale");
        solver.residual_scale   = scale == "body" ? ResidualScale::body :
                                  scale == "cell" ? ResidualScale::cell :
                                                    ResidualScale::momentum;
        solver.newton_tolerance = prm.get_double("Newton tolerance");
        solver.newton_reduction = prm.get_double("Newton reduction");
      }
    else
      {
        solver.convergence = Convergence::increment_and_energy;
        solver.displacement_tolerance =
          prm.get_double("Displacement tolerance");
        solver.energy_tolerance = prm.get_double("Energy tolerance");
      }
    solver.newton_iterations = prm.get_integer("Newton iterations");
    solver.line_search       = prm.get_bool("Line search");
    solver.linear_solver     = prm.get("Linear solver");
    if (time.momentum_formulation && solver.linear_solver == "CG")
      throw InputError("Linear solver",
                       "found 'CG', which needs a symmetric matrix, but the "
                       "momentum formulation has none: allowed are GMRES, "
                       "direct");
    if (solver.linear_solver != "direct")
      {
        solver.linear_tolerance  = prm.get_double("Linear tolerance");
        solver.linear_iterations = prm.get_integer("Linear iterations");
        solver.preconditioner    = prm.get("Preconditioner");
        const std::string kind   = prm.get("Operator");
        solver.tangent           = kind == "matrix" ? TangentKind::matrix :
                                   kind == "matrix-free" ?
                                                      TangentKind::matrix_free :
                                                      TangentKind::difference_quotient;
        if (solver.tangent == TangentKind::difference_quotient)
          solver.difference_step = prm.get_double("Difference step");
        solver.accept_unfinished =
          prm.get("Unfinished solves") == "next Newton step";
      }
    if (solver.linear_solver == "GMRES")
      solver.gmres_directions = prm.get_integer("GMRES directions");
    if (prm.get("Nonlinear solver") == "BFGS")
      {
        solver.bfgs_updates = prm.get_integer("BFGS updates");
        if (time.momentum_formulation)
          throw InputError("Nonlinear solver",
                           "found 'BFGS', which keeps a symmetric matrix, "
                           "allowed with the momentum formulation, whose "
                           "tangent is unsymmetric, is 'Newton'");
        if (solver.linear_solver != "direct" &&
            solver.tangent != TangentKind::matrix)
          throw InputError("Operator",
                           "found '" + prm.get("Operator") +
                             "', allowed with 'Nonlinear solver = BFGS', "
                             "which keeps a tangent, is 'matrix'");
      }
    return solver;
  }
} // namespace impm
