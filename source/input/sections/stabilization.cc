#include <deal.II/base/patterns.h>

#include <impm/input/sections/grid.h>
#include <impm/input/sections/stabilization.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  // Cells of a Lagrangian grid are full; explicit forces need no solve.

  void
  declare_stabilization(ParameterHandler            &prm,
                        const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Stabilization");
    const bool useful = !is_lagrangian(chosen) && !is_explicit(chosen);
    if (useful)
      prm.declare_entry("Ghost penalty",
                        "0.033",
                        Patterns::Double(0, 10),
                        "On jumps of the gradient of the increment between "
                        "cells at the edge of a body, in units of Young's "
                        "modulus; 0: none.");
    if (useful && may_be_quasi_static(chosen))
      prm.declare_entry("Isolated stiffness",
                        "1e-3",
                        Patterns::Double(0, 1),
                        "Stiffness that holds cells which touch no other "
                        "material when there is no inertia, in units of "
                        "Young's modulus; 0: none.");
    prm.leave_subsection();
  }

  StabilizationSpec
  read_stabilization(ParameterHandler &prm,
                     const TimeSpec   &time,
                     const bool        lagrangian)
  {
    StabilizationSpec spec;
    const bool        useful = !lagrangian && !time.is_explicit();
    if (useful)
      spec.ghost_penalty = prm.get_double({"Stabilization"}, "Ghost penalty");
    if (useful && !time.has_inertia())
      spec.isolated_stiffness =
        prm.get_double({"Stabilization"}, "Isolated stiffness");
    return spec;
  }
} // namespace impm
