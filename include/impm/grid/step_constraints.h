#ifndef impm_grid_step_constraints_h
#define impm_grid_step_constraints_h

#include <impm/grid/rigid_bodies.h>
#include <impm/grid/touching.h>
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
   * of the domain, rigid bodies, grips, and nodes that no material touches.
   */
  template <int dim>
  class StepConstraints
  {
  public:
    /**
     * For the step from `time` to `time + dt`. `support` is positive where a
     * node that is not hanging has material, its ghosts are up to date. Throws
     * ComputationError, on every rank alike, for a grip that cannot tell where
     * its nodes come from. Collective.
     */
    StepConstraints(const Faces<dim>                 &faces,
                    const std::vector<GripSpec<dim>> &grips,
                    const BackgroundGrid<dim>        &grid,
                    const Discretization<dim>        &discretization,
                    const MaterialPoints<dim>        &points,
                    const RigidBodies<dim>           &rigid,
                    double                            time,
                    double                            dt,
                    const Vector                     &support,
                    const TouchedNodes<dim>          &touched);

    /** Writes what is prescribed into `u`, zero on unused nodes. Collective. */
    void
    set_prescribed(Vector &u) const;

    /** Zero on all constrained values that this rank owns. */
    void
    set_zero(Vector &vector) const;

    /**
     * Zero where a face, a rigid body or a grip holds a node at rest in this
     * step. The points around it go on moving until forces stop them: were
     * their motion taken for the node's, the wall would stop its mass anew in
     * every step.
     */
    void
    stop_held(Vector &vector) const;

    /**
     * Sum of a vector's values that a face, rigid body or grip holds, projected
     * on a direction. Collective.
     */
    double
    sum_over(const std::string         &name,
             const Vector              &vector,
             const std::vector<double> &direction) const;

    /**
     * Moment of a vector's values (N) that a face or rigid body holds about a
     * point (m), at the places to which the increment `u` takes the nodes;
     * along an axis, which the plane takes for z. Collective.
     */
    double
    moment_over(const std::string        &name,
                const Vector             &vector,
                const Vector             &u,
                const dealii::Point<dim> &about,
                const RotationVector     &axis) const;

    /** Motion in the step of the rigid body that is a carrier; null if it is a
     * face. */
    const RigidMotion<dim> *
    motion_of(const unsigned int carrier) const
    {
      return carrier < 2 * dim || carrier >= first_grip() ?
               nullptr :
               &motions[carrier - 2 * dim];
    }

    /** Whether each face holds any node that has material. Collective. */
    std::array<bool, 2 * dim>
    faces_that_hold() const;

    /** Faces, then rigid bodies, then grips. */
    unsigned int
    n_carriers() const
    {
      return first_grip() + grips.size();
    }

    static constexpr unsigned int no_carrier = -1;

    // What may hold nodes.
    const Faces<dim>                 &faces;
    const std::vector<GripSpec<dim>> &grips;
    const BackgroundGrid<dim>        &grid;
    const RigidBodies<dim>           &rigid;

    /** Whether a local element is constrained. */
    std::vector<char> is_constrained;

    /** What holds a local element, or no_carrier. */
    std::vector<unsigned int> carrier;

    /** What would hold it, had it material. */
    std::vector<unsigned int> wall;

    /** What is prescribed of a local element in the step (m), else zero. */
    std::vector<double> increment;

  private:
    /** The number, plus 1, of what holds each value; faces hold all of their
     * nodes, or those that are touched. Collective. */
    Vector
    find_carriers(const MaterialPoints<dim> &points,
                  const TouchedNodes<dim>   *touched) const;

    unsigned int
    first_grip() const
    {
      return 2 * dim + rigid.bodies.size();
    }

    const std::string &
    name_of(unsigned int carrier) const;

    void
    hold_faces(const TouchedNodes<dim> *touched, Vector &carriers) const;

    void
    hold_rigid_bodies(Vector &carriers) const;

    void
    hold_grips(const MaterialPoints<dim> &points, Vector &carriers) const;

    /** The motion that its carrier gives a local element in a step (m). */
    double
    prescribed(unsigned int index, double time, double dt) const;

    /** The number of what has a name, or no_carrier. */
    unsigned int
    find(const std::string &name) const;

    const Discretization<dim>    &discretization;
    std::vector<RigidMotion<dim>> motions; ///< of rigid bodies in the step
  };
} // namespace impm

#endif
