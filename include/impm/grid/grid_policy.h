#ifndef impm_grid_grid_policy_h
#define impm_grid_grid_policy_h

#include <impm/grid/rigid_bodies.h>
#include <impm/grid/step_result.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/points/material_points.h>

#include <array>
#include <memory>

namespace impm
{
  /**
   * How the grid goes from one step to the next: it stays, follows a face, goes
   * with the material, or adapts. Nothing else changes the grid.
   */
  template <int dim>
  class GridPolicy
  {
  public:
    virtual ~GridPolicy() = default;

    /**
     * Before a step: may flag cells of the grid for refinement or coarsening,
     * which is then carried out with all that lives in it. Returns whether it
     * did, on every rank alike. Collective.
     */
    virtual bool
    flag_cells(BackgroundGrid<dim> & /*grid*/,
               const MaterialPoints<dim> & /*points*/,
               double /*time*/)
    {
      return false;
    }

    /** After a step whose points have moved. Collective. */
    virtual void
    advance(BackgroundGrid<dim> & /*grid*/,
            const StepResult & /*result*/,
            double /*from*/,
            double /*to*/) const
    {}

    /** Where a face will lie along its normal at the end of a step (m). */
    virtual double
    face_position(const BackgroundGrid<dim> &grid,
                  const unsigned int         face,
                  double /*from*/,
                  double /*to*/) const
    {
      return grid.face_position(face);
    }
  };

  /** The policy that a scene names: every one stands in here. */
  template <int dim>
  std::unique_ptr<GridPolicy<dim>>
  make_grid_policy(const GridSpec<dim> &spec, const Faces<dim> &faces);

  /**
   * Refines and coarsens the cells that are flagged and takes points and rigid
   * bodies along. A Lagrangian grid cannot change. Collective.
   */
  template <int dim>
  void
  adapt_grid(BackgroundGrid<dim> &grid,
             MaterialPoints<dim> &points,
             RigidBodies<dim>    &rigid);
} // namespace impm

#endif
