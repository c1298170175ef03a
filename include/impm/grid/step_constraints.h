#ifndef impm_grid_step_constraints_h
#define impm_grid_step_constraints_h

#include <impm/grid/background_grid.h>
#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * What is known of the grid's increment in one step: hanging nodes, faces
   * of the domain, rigid bodies, and nodes that no material touches.
   */
  template <int dim>
  class StepConstraints
  {
  public:
    StepConstraints(const Faces<dim>          &faces,
                    const BackgroundGrid<dim> &grid,
                    const RigidBodies<dim>    &rigid);

    /**
     * For the step from `time` to `time + dt`. `support` is positive where a
     * node that is not hanging has material; its ghosts are up to date.
     * Collective.
     */
    void
    build(double time, double dt, const Vector &support);

    /** Displacement of a face along its normal over a step (m). */
    double
    face_motion(unsigned int face, double from, double to) const;

    /** Writes what is prescribed into `u`, zero on unused nodes. Collective. */
    void
    set_prescribed(Vector &u) const
    {
      constraints.distribute(u);
    }

    /** Zero on all constrained values that this rank owns. */
    void
    set_zero(Vector &vector) const;

    /** Hanging nodes from their masters. Ghosts come up to date. Collective. */
    void
    interpolate_hanging(Vector &vector) const;

    /** Adds what stands at hanging nodes to their masters. Collective. */
    void
    condense_hanging(Vector &vector) const;

    /**
     * Sum of a vector's values that a face or rigid body holds, projected on
     * a direction. Collective.
     */
    double
    sum_over(const std::string         &carrier,
             const Vector              &vector,
             const std::vector<double> &direction) const;

    dealii::AffineConstraints<double> constraints;

    /** Whether a face or rigid body holds a local element. */
    bool
    is_prescribed(const unsigned int index) const
    {
      return carriers.local_element(index) > 0;
    }

    /** Whether a local element is constrained. */
    std::vector<char> is_constrained;

    /**
     * Zero where a face or a rigid body holds a node at rest in this step. The
     * points around it go on moving until forces stop them: were their motion
     * taken for the node's, the wall would stop its mass anew in every step.
     */
    void
    stop_held(Vector &vector) const;

  private:
    void
    mark_carriers();

    double
    prescribed(unsigned int carrier,
               unsigned int node,
               unsigned int component,
               double       time,
               double       dt) const;

    const Faces<dim>          &faces;
    const BackgroundGrid<dim> &grid;
    const RigidBodies<dim>    &rigid;

    /** One more than the number of the face, or of the rigid body behind the
     * faces, that holds a value; 0 if none does. */
    Vector carriers;

    struct HangingValue
    {
      unsigned int                                 index;
      std::vector<std::pair<unsigned int, double>> masters;
    };
    std::vector<HangingValue> hanging; ///< those that this rank owns
    std::vector<char>         rests;   ///< whether held without motion
  };
} // namespace impm

#endif
