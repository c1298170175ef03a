#ifndef impm_grid_grips_h
#define impm_grid_grips_h

#include <impm/grid/discretization.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/points/material_points.h>

namespace impm
{
  /**
   * Sets the values of nodes that a grip holds, all of the cells of its points
   * in the layer of its body, to a number. Ghosts are not summed.
   */
  template <int dim>
  void
  hold_by_grip(const GripSpec<dim>       &grip,
               const MaterialPoints<dim> &points,
               const Discretization<dim> &discretization,
               double                     number,
               Vector                    &values);

  /**
   * What a grip prescribes of a component in a step (m), at a place where its
   * material is at the start of it. A displacement is a function of places at
   * the start of the run: they are those that the grip has brought here.
   * Throws ComputationError where none is found.
   */
  template <int dim>
  double
  grip_motion(const GripSpec<dim>      &grip,
              const dealii::Point<dim> &place,
              unsigned int              component,
              double                    time,
              double                    dt);

  /** Throws InputError for a grip that has no point. Collective. */
  template <int dim>
  void
  check_grips(const std::vector<GripSpec<dim>> &grips,
              const MaterialPoints<dim>        &points);
} // namespace impm

#endif
