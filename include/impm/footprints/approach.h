#ifndef impm_footprints_approach_h
#define impm_footprints_approach_h

#include <impm/footprints/footprints.h>
#include <impm/grid/step_constraints.h>
#include <impm/points/material_points.h>

namespace impm
{
  /** How far bodies are from what they do not feel by a node in common. */
  enum class Distance
  {
    none, ///< there is nothing of that kind
    near, ///< they may after a step of less than a cell
    far
  };

  struct Approach
  {
    Distance of_bodies = Distance::none; ///< from each other
    Distance to_walls  = Distance::none; ///< faces and rigid bodies that hold
    bool     bodies_touch = false;       ///< any two share a node
  };

  /**
   * How near the nearest two bodies are to each other, and a body to a wall:
   * near if their nodes are two cells apart or less. Of more than two that
   * touch a node, those of lowest and highest number count. Collective.
   */
  template <int dim>
  Approach
  find_approach(const MaterialPoints<dim>  &points,
                const Footprints<dim>      &footprints,
                const Discretization<dim>  &discretization,
                const StepConstraints<dim> &constraints);
} // namespace impm

#endif
