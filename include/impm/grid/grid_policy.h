#ifndef impm_grid_grid_policy_h
#define impm_grid_grid_policy_h

#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/boundary_conditions.h>

namespace impm
{
  template <int dim>
  class SurfacePoints;

  /** When a policy is asked. */
  struct PolicyTime
  {
    double       time  = 0; ///< (s)
    unsigned int round = 0; ///< of those before a step
  };

  /**
   * How the grid goes from one step to the next: with a face that moves it and,
   * if it is Lagrangian, with the material. Another policy may adapt it, too.
   * Nothing else changes the grid.
   */
  template <int dim>
  class GridPolicy
  {
  public:
    explicit GridPolicy(const Faces<dim> &faces)
      : faces(faces)
    {}

    virtual ~GridPolicy() = default;

    /**
     * Before a step: may flag cells of the grid for refinement or coarsening,
     * which is then carried out with all that lives in it. Returns whether it
     * did, on every rank alike. Collective.
     */
    virtual bool
    flag_cells(BackgroundGrid<dim> & /*grid*/,
               const MaterialPoints<dim> & /*points*/,
               const RigidBodies<dim> & /*rigid*/,
               const PolicyTime & /*now*/)
    {
      return false;
    }

    /** How often cells may be flagged before one step, by one level each. */
    virtual unsigned int
    largest_number_of_rounds() const
    {
      return 1;
    }

    /** After a step whose points have moved. Collective. */
    void
    advance(BackgroundGrid<dim> &grid,
            const StepResult    &result,
            double               from,
            double               to) const;

    /** Where a face will lie along its normal at the end of a step (m). */
    double
    face_position(const BackgroundGrid<dim> &grid,
                  unsigned int               face,
                  double                     from,
                  double                     to) const;

  private:
    const Faces<dim> &faces;
  };

  /**
   * Refines and coarsens the cells that are flagged and takes points, rigid
   * bodies and surfaces along. A Lagrangian grid cannot change. Collective.
   */
  template <int dim>
  void
  adapt_grid(BackgroundGrid<dim> &grid,
             MaterialPoints<dim> &points,
             RigidBodies<dim>    &rigid,
             SurfacePoints<dim>  *surfaces = nullptr);

  /** Sends cells to other ranks with all that lives in them. Not for a
   * Lagrangian grid. Collective. */
  template <int dim>
  void
  repartition_grid(BackgroundGrid<dim> &grid,
                   MaterialPoints<dim> &points,
                   RigidBodies<dim>    &rigid,
                   SurfacePoints<dim>  *surfaces = nullptr);
} // namespace impm

#endif
