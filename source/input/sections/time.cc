#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/sections/grid.h>
#include <impm/input/sections/time.h>

#include <limits>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    // "Greater than zero" for a pattern that knows closed ranges only.
    const double tiny = std::numeric_limits<double>::min();

    const Choice<Integrator>
      integrators("Integrator",
                  {{"quasi-static", Integrator::quasi_static},
                   {"explicit", Integrator::explicit_euler},
                   {"theta", Integrator::theta},
                   {"Newmark", Integrator::newmark}});

    const Choice<bool> keeps_acceleration("Acceleration from",
                                          {{"grid", false}, {"points", true}});

    const Choice<bool> momentum_formulation("Formulation",
                                            {{"velocity", false},
                                             {"momentum", true}});

    const Choice<TransferKind> transfers("Transfer",
                                         {{"FLIP", TransferKind::flip},
                                          {"PIC", TransferKind::pic},
                                          {"APIC", TransferKind::apic}});

    void
    declare_integrator(ParameterHandler            &prm,
                       const ParameterFile::Chosen &chosen)
    {
      integrators.declare(
        prm,
        "Quasi-static: no inertia. Explicit and theta: Sulsky "
        "& Kaul (2004), section 2.3.1 and eq. 2.4.1. Newmark: "
        "Guilkey & Weiss (2003).");
      if (integrators.may_be(chosen, "Time", Integrator::newmark))
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
          keeps_acceleration.declare(
            prm,
            "At the start of a step: from the forces on the "
            "grid as it is, or as the points carry it (Guilkey "
            "& Weiss 2003), which loses energy in long steps.");
        }
      if (integrators.may_be(chosen, "Time", Integrator::theta))
        prm.declare_entry("Theta",
                          "1",
                          Patterns::Double(0, 1),
                          "Weight of the forces at the end of the step (mu in "
                          "the paper); 1: backward Euler, 0.5: trapezoidal, 0: "
                          "explicit. Below 0.5, long steps are unstable.");
      if (is_quasi_static(chosen) || is_lagrangian(chosen))
        return;
      momentum_formulation.declare(
        prm,
        "Strain from the grid's velocity, or from one that "
        "has been mapped to the points and back (Sulsky & "
        "Kaul 2004, section 3.2.1), which spares nodes with "
        "little mass and makes the tangent unsymmetric.");
      transfers.declare(prm,
                        "Velocities of points: they take the change of the "
                        "grid's (FLIP), its value (PIC, which damps), or its "
                        "value and gradient (APIC).");
    }

    void
    read_integrator(const ParameterHandler &prm,
                    const bool              lagrangian,
                    TimeSpec               &time)
    {
      time.integrator = integrators.read(prm);
      if (time.integrator == Integrator::newmark)
        {
          time.beta               = prm.get_double("Beta");
          time.gamma              = prm.get_double("Gamma");
          time.keeps_acceleration = keeps_acceleration.read(prm);
        }
      if (time.integrator == Integrator::theta)
        time.theta = prm.get_double("Theta");
      if (time.is_explicit())
        time.theta = 0;
      if (lagrangian)
        time.transfer = TransferKind::pic; // points only show the motion
      else if (time.has_inertia())
        {
          time.momentum_formulation = momentum_formulation.read(prm);
          time.transfer             = transfers.read(prm);
          if (time.momentum_formulation && time.transfer != TransferKind::flip)
            throw InputError("Transfer",
                             "found '" + prm.get("Transfer") +
                               "', allowed in the momentum formulation, which "
                               "maps changes of velocity, is FLIP");
        }
    }

    void
    declare_steps(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.declare_entry("End time",
                        "1",
                        Patterns::Double(tiny),
                        "When the run ends (s).");
      if (!is_quasi_static(chosen))
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
      declare_text(prm,
                   "Largest time step",
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
    }

    void
    read_steps(const ParameterHandler &prm, TimeSpec &time)
    {
      time.end = prm.get_double("End time");
      if (time.has_inertia())
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
    }
  } // namespace

  bool
  is_quasi_static(const ParameterFile::Chosen &chosen)
  {
    return integrators.is(chosen, "Time", Integrator::quasi_static);
  }

  bool
  may_be_quasi_static(const ParameterFile::Chosen &chosen)
  {
    return integrators.may_be(chosen, "Time", Integrator::quasi_static);
  }

  bool
  is_explicit(const ParameterFile::Chosen &chosen)
  {
    return integrators.is(chosen, "Time", Integrator::explicit_euler);
  }

  void
  declare_time(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Time");
    declare_integrator(prm, chosen);
    declare_steps(prm, chosen);
    prm.leave_subsection();
  }

  TimeSpec
  read_time(ParameterHandler &prm, const bool lagrangian)
  {
    TimeSpec time;
    in_section(prm, "Time", [&]() {
      read_integrator(prm, lagrangian, time);
      read_steps(prm, time);
    });
    return time;
  }

  void
  check_time(const TimeSpec &time, std::vector<std::string> &warnings)
  {
    if (time.integrator == Integrator::theta && time.theta == 0)
      warnings.push_back(
        "with Theta = 0 steps are explicit, so that the sections Solver and "
        "Stabilization do nothing; 'Integrator = explicit' is cheaper");
  }
} // namespace impm
