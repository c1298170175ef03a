#include <impm/input/sections/time.h>

namespace impm
{
  namespace
  {
    const Choice<Integrator>
      integrators("Integrator",
                  {{"quasi-static", Integrator::quasi_static},
                   {"theta", Integrator::theta},
                   {"Newmark", Integrator::newmark},
                   {"generalised alpha", Integrator::generalised_alpha},
                   {"energy-momentum", Integrator::energy_momentum},
                   {"explicit", Integrator::explicit_euler}});

    void
    add_integrator(const Section &section,
                   TimeSpec      &time,
                   const bool     lagrangian)
    {
      section.add(integrators,
                  time.integrator,
                  "Quasi-static: no inertia. Theta and explicit: Sulsky & Kaul "
                  "(2004), eq. 2.4.1 and section 2.3.1. Newmark: Guilkey & "
                  "Weiss (2003). Generalised alpha: Chung & Hulbert (1993), "
                  "damps what steps do not resolve. Energy-momentum: Simo & "
                  "Tarnow (1992), for bodies that turn; its matrix is "
                  "unsymmetric.");
      if (section.chooses(integrators, Integrator::newmark))
        {
          section.add("Beta",
                      time.beta,
                      {"0.25", 0.01, 0.5},
                      "Weight of the acceleration at the end in the "
                      "displacement; 0.25: trapezoidal.");
          section.add(
            "Gamma",
            time.gamma,
            {"0.5", 0.5, 1},
            "Weight of the same in the velocity; above 0.5 it damps.");
        }
      if (section.chooses(integrators, Integrator::generalised_alpha))
        section.add("Spectral radius",
                    time.spectral_radius,
                    {"0.8", 0, 1},
                    "What a step leaves of what it does not resolve; 1: all "
                    "of it.");
      if (section.chooses(integrators, Integrator::newmark) ||
          section.chooses(integrators, Integrator::generalised_alpha))
        section.add("Acceleration from",
                    time.keeps_acceleration,
                    {{"grid", false}, {"points", true}},
                    "At the start of a step: from the forces on the grid as "
                    "it is, or as the points carry it (Guilkey & Weiss "
                    "2003), which loses energy in long steps.");
      if (section.chooses(integrators, Integrator::theta))
        section.add("Theta",
                    time.theta,
                    {"1", 0, 1},
                    "Weight of the forces at the end of the step (mu in the "
                    "paper); 1: backward Euler, 0.5: trapezoidal, 0: "
                    "explicit. Below 0.5, long steps are unstable.");
      if (time.is_explicit())
        time.theta = 0;
      if (lagrangian)
        time.transfer = TransferKind::pic; // points only show the motion
      if (lagrangian || is_quasi_static(section.chosen))
        return;
      section.add("Formulation",
                  time.momentum_formulation,
                  {{"velocity", false}, {"momentum", true}},
                  "Strain from the grid's velocity, or from one that has been "
                  "mapped to the points and back (Sulsky & Kaul 2004, section "
                  "3.2.1), which spares nodes with little mass and makes the "
                  "tangent unsymmetric.");
      section.add("Transfer",
                  time.transfer,
                  {{"FLIP", TransferKind::flip},
                   {"PIC", TransferKind::pic},
                   {"APIC", TransferKind::apic}},
                  "Velocities of points: they take the change of the grid's "
                  "(FLIP), its value (PIC, which damps), or its value and "
                  "gradient (APIC).");
      if (time.momentum_formulation &&
          time.integrator == Integrator::energy_momentum)
        section.refuse("Formulation",
                       "allowed with the energy-momentum method, whose forces "
                       "do their work along the velocity of the grid, is "
                       "'velocity'");
      if (time.momentum_formulation && time.transfer != TransferKind::flip)
        section.refuse("Transfer",
                       "allowed in the momentum formulation, which maps "
                       "changes of velocity, is FLIP");
    }

    void
    add_steps(const Section &section, TimeSpec &time)
    {
      section.add("End time",
                  time.end,
                  {"1", above_zero},
                  "When the run ends (s).");
      if (!is_quasi_static(section.chosen))
        section.add("CFL number",
                    time.cfl_number,
                    {"0", 0},
                    "Time step in units of the smallest cell over the largest "
                    "speed of elastic waves and points; 0: given in seconds.");
      time.step = time.cfl_number;
      if (time.cfl_number == 0)
        section.add("Time step",
                    time.step,
                    {"0.01", above_zero},
                    "Of the first step (s).");
      section.add("Step control",
                  time.step_control,
                  {{"fixed", StepControlKind::fixed},
                   {"iterations", StepControlKind::iterations},
                   {"error", StepControlKind::error}},
                  "How long the next step is: as given, with its growth, but "
                  "for steps that fail; as long as Newton's method takes the "
                  "iterations wanted; as long as the error that the time "
                  "integrator makes is what is allowed.");
      const bool is_fixed = time.step_control == StepControlKind::fixed;
      if (!is_fixed && time.is_explicit())
        section.refuse("Step control",
                       "allowed with explicit steps, whose length is that in "
                       "which they are stable, is 'fixed'");
      if (time.step_control == StepControlKind::iterations)
        section.add("Wanted iterations",
                    time.wanted_iterations,
                    {"6", 2, 50},
                    "Of Newton's method in a step.");
      if (time.step_control == StepControlKind::error)
        section.add("Error tolerance",
                    time.error_tolerance,
                    {"0.01", 1e-12, 1},
                    "Of the displacements, over the way that the points go, as "
                    "means of squares: what all steps together may lose by "
                    "their length.");
      section.add("Growth",
                  time.growth,
                  {is_fixed ? "1" : "1.5", 1, 2},
                  "Factor from one time step to the next, or the largest one "
                  "where steps are controlled.");
      std::optional<double> largest_step;
      section.add("Largest time step",
                  largest_step,
                  "Where growth ends (s, or CFL number); empty: the first "
                  "step's, or none where steps are controlled.");
      time.largest_step = largest_step.value_or(
        is_fixed ? time.step : std::numeric_limits<double>::infinity());
      const std::string first =
        time.cfl_number > 0 ? "CFL number" : "Time step";
      if (time.largest_step < time.step)
        section.refuse("Largest time step",
                       "allowed is at least '" + first +
                         "' = " + section.get(first));
      if (is_fixed && time.growth > 1 && time.largest_step == time.step)
        section.refuse("Growth",
                       "which does nothing without a 'Largest time step' above "
                       "'" +
                         first + "'");
      section.add("Smallest time step",
                  time.smallest_step,
                  {"0.001", above_zero, 1},
                  "How small a step may be cut before the run gives up, as a "
                  "fraction of the first step.");
      if (!is_quasi_static(section.chosen))
        section.add("Energy tolerance",
                    time.energy_tolerance,
                    {"0.01", 0},
                    "What a run may gain by itself, over the largest energy "
                    "that it had: beyond, it warns, and cuts steps that gain "
                    "more than a tenth of it unless they are explicit. 0: no "
                    "limit.");
      section.add("Largest number of steps",
                  time.largest_number_of_steps,
                  {"10000000", 1},
                  "The run ends there at the latest.");
    }
  } // namespace

  bool
  is_quasi_static(const Chosen &chosen)
  {
    return integrators.is(chosen, "Time", Integrator::quasi_static);
  }

  void
  add_time(const Section            &top,
           TimeSpec                 &time,
           const bool                lagrangian,
           std::vector<std::string> &warnings)
  {
    const auto section = top.subsection("Time");
    add_integrator(section, time, lagrangian);
    add_steps(section, time);
    if (time.integrator == Integrator::theta && time.theta == 0)
      warnings.push_back(
        "with Theta = 0 steps are explicit, so that the sections Solver and "
        "Stabilization do nothing; 'Integrator = explicit' is cheaper");
    // Not on a Lagrangian grid, whose points only show the motion.
    if (time.transfer == TransferKind::pic && !lagrangian && time.has_inertia())
      warnings.push_back(
        "with Transfer = PIC points lose in every step what of their motion "
        "the grid does not see: the shorter the steps, the more forces and "
        "energy are too low (APIC keeps the gradient)");
  }
} // namespace impm
