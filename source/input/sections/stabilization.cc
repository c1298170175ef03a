#include <impm/input/sections/stabilization.h>

namespace impm
{
  void
  add_stabilization(const Section     &top,
                    StabilizationSpec &stabilization,
                    const TimeSpec    &time,
                    const bool         lagrangian)
  {
    const auto section = top.subsection("Stabilization");
    // Cells of a Lagrangian grid are full; explicit forces need no solve.
    if (lagrangian || time.is_explicit())
      return;
    section.add("Ghost penalty",
                stabilization.ghost_penalty,
                {"0.033", 0, 10},
                "On jumps of the gradient of the increment between cells at "
                "the edge of a body, in units of Young's modulus; 0: none.");
    if (!time.has_inertia())
      section.add("Isolated stiffness",
                  stabilization.isolated_stiffness,
                  {"1e-3", 0, 1},
                  "Stiffness that holds cells which touch no other material "
                  "when there is no inertia, in units of Young's modulus; 0: "
                  "none.");
  }
} // namespace impm
