#ifndef impm_grid_step_constraints_h
#define impm_grid_step_constraints_h

#include <impm/grid/background_grid.h>
#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <array>
#include <string>
#include <vector>

namespace impm
{
  /** Displacement of a face along its normal from one time to another (m). */
  template <int dim>
  double
  face_motion(const FaceSpec<dim>       &spec,
              const BackgroundGrid<dim> &grid,
              unsigned int               face,
              double                     from,
              double                     to);

  /**
   * What is known of the grid's increment in one step: hanging nodes, faces
   * of the domain, rigid bodies, and nodes that no material touches.
   */
  template <int dim>
  class StepConstraints
  {
  public:
    /**
     * For the step from `time` to `time + dt`. `support` is positive where a
     * node that is not hanging has material; its ghosts are up to date.
     * Collective.
     */
    StepConstraints(const Faces<dim>          &faces,
                    const BackgroundGrid<dim> &grid,
                    const Discretization<dim> &discretization,
                    const RigidBodies<dim>    &rigid,
                    double                     time,
                    double                     dt,
                    const Vector              &support);

    /** Writes what is prescribed into `u`, zero on unused nodes. Collective. */
    void
    set_prescribed(Vector &u) const
    {
      constraints.distribute(u);
    }

    /** Zero on all constrained values that this rank owns. */
    void
    set_zero(Vector &vector) const;

    /**
     * Zero where a face or a rigid body holds a node at rest in this step. The
     * points around it go on moving until forces stop them: were their motion
     * taken for the node's, the wall would stop its mass anew in every step.
     */
    void
    stop_held(Vector &vector) const;

    /**
     * Sum of a vector's values that a face or rigid body holds, projected on
     * a direction. Collective.
     */
    double
    sum_over(const std::string         &carrier,
             const Vector              &vector,
             const std::vector<double> &direction) const;

    /** Whether each face holds any node that has material. Collective. */
    std::array<bool, 2 * dim>
    faces_that_hold() const;

    /** Whether a face or rigid body holds a local element. */
    bool
    is_prescribed(const unsigned int index) const
    {
      return carriers.local_element(index) > 0;
    }

    static constexpr unsigned int no_carrier = -1;

    /** The face that holds a local element, or the rigid body behind the
     * faces, or no_carrier. */
    unsigned int
    carrier(const unsigned int index) const
    {
      return is_prescribed(index) ?
               static_cast<unsigned int>(carriers.local_element(index)) - 1 :
               no_carrier;
    }

    unsigned int
    n_carriers() const
    {
      return 2 * dim + rigid.size();
    }

    dealii::AffineConstraints<double> constraints;

    /** Whether a local element is constrained. */
    std::vector<char> is_constrained;

  private:
    void
    hold_faces();

    void
    hold_rigid_bodies();

    void
    hold(dealii::types::global_dof_index dof, unsigned int carrier);

    double
    prescribed(unsigned int carrier,
               unsigned int node,
               unsigned int component,
               double       time,
               double       dt) const;

    const Faces<dim>          &faces;
    const BackgroundGrid<dim> &grid;
    const Discretization<dim> &discretization;
    const RigidBodies<dim>    &rigid;

    /** One more than the number of the face, or of the rigid body behind the
     * faces, that holds a value; 0 if none does. */
    Vector            carriers;
    std::vector<char> rests; ///< whether held without motion
  };
} // namespace impm

#endif
