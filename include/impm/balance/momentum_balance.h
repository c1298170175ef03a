#ifndef impm_balance_momentum_balance_h
#define impm_balance_momentum_balance_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <impm/balance/point_response.h>
#include <impm/balance/terms/ghost_penalty.h>
#include <impm/balance/velocity_smoothing.h>
#include <impm/footprints/footprint_builder.h>
#include <impm/grid/step_constraints.h>
#include <impm/scene/scene.h>
#include <impm/time/time_integrator.h>

#include <memory>

namespace impm
{
  /**
   * The balance of momentum on the grid over one step: residual, potential,
   * exact tangent as an operator, its diagonal and its matrix.
   *
   * Unknown is the grid's displacement increment u. At a point,
   * dF = I + sum_I u_I (x) grad N_I, F = dF F_n, and the internal force is
   * f_I = sum_p V0_p P_p grad N_I with P = tau dF^-T, gradients at t_n. The
   * tangent at a point is A = dP/d(dF), that is the spatial tangent of the
   * Newmark note carried back by dF^-1; see PointResponse.
   */
  template <int dim>
  class MomentumBalance
  {
  public:
    MomentumBalance(const Scene<dim>          &scene,
                    const BackgroundGrid<dim> &grid,
                    const MaterialPoints<dim> &points,
                    const RigidBodies<dim>    &rigid,
                    const TimeIntegrator      &integrator);

    /**
     * Takes points and grid as they are now for the step from `time` to
     * `time + dt`. Collective.
     */
    void
    begin_step(double time, double dt);

    /** The state of the points and forces at an increment. */
    struct Evaluation
    {
      bool   admissible = false; ///< J > 0 and a finite stress everywhere
      double potential  = 0;     ///< (J)
      double residual   = 0;     ///< scaled, see begin_step
      double round_off  = 0;     ///< below this `residual` is noise
    };

    /**
     * The increment of an explicit step, which the forces at its start give:
     * what is prescribed included. Collective.
     */
    void
    explicit_increment(Vector &u) const;

    /**
     * Evaluates forces and, unless told not to, the tangent at `u`, which
     * satisfies the constraints. Collective.
     */
    Evaluation
    evaluate(const Vector &u, bool with_tangent = true);

    /**
     * Replaces the tangent at every point by its positive part, so that the
     * next Newton step descends. Needs a symmetric tangent.
     */
    void
    project_tangent()
    {
      response.project_tangent();
    }

    /**
     * Velocity (m/s) and, if the integrator keeps it, acceleration (m/s^2) of
     * the grid after a step that has converged at `u`. What is prescribed has
     * the mean velocity of its step. Ghosts and hanging nodes are up to date.
     * Collective.
     */
    void
    end_motion(const Vector &u, Vector &velocity, Vector &acceleration) const;

    /**
     * Where the nodes keep their motion, takes it over from one step to the
     * next; elsewhere the points bring it. Moves a Lagrangian grid by `u`.
     */
    void
    carry_motion(BackgroundGrid<dim> &grid,
                 const Vector        &u,
                 const Vector        &end_velocity,
                 const Vector        &end_acceleration);

    /**
     * The balance of forces (N), zero where constrained. Its work_along() a
     * direction is the derivative of the potential.
     */
    const Vector &
    residual() const
    {
      return free_residual;
    }

    /**
     * What the potential gains of a force (N) along a direction that is zero
     * where prescribed, hanging nodes included (J). In the momentum formulation
     * points feel the direction smoothed. Collective.
     */
    double
    work_along(const Vector &direction, const Vector &force) const;

    /** Norm of the forces at a strain of one (N), the unit of residuals. */
    double
    unit_of_residual() const
    {
      return force_scale;
    }

    /** What faces and rigid bodies exert (N): the residual before they do. */
    const Vector &
    constraint_forces() const
    {
      return forces;
    }

    /**
     * dst = C^T K C src, identity on constrained values; C sets hanging nodes
     * and zeros. Collective.
     */
    void
    vmult(Vector &dst, const Vector &src) const;

    /** K src with prescribed values in src, zero where constrained. */
    void
    vmult_lift(Vector &dst, const Vector &src) const;

    /**
     * The same as vmult, but for constrained values, by the matrix that
     * assemble() has filled.
     */
    void
    vmult_by_matrix(const dealii::TrilinosWrappers::SparseMatrix &matrix,
                    Vector                                       &dst,
                    const Vector                                 &src) const;

    /**
     * The diagonal of vmult, of the velocity formulation in any case. At
     * masters of hanging nodes the terms that couple a hanging node to its
     * master are left out. Collective.
     */
    void
    diagonal(Vector &diagonal) const;

    /** Prepares the matrix for assemble() in this step. Collective. */
    void
    initialize_matrix(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /**
     * Fills it with the tangent, where constrained with something positive on
     * the diagonal. Collective.
     */
    void
    assemble(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /**
     * External force of the step (N), with the sign of an internal one, by
     * local index.
     */
    double
    load_at(const unsigned int index) const
    {
      const double factor = integrator.force_factor();
      return factor * load.local_element(index) +
             (factor < 1 ? (1 - factor) * start_load.local_element(index) : 0.);
    }

    /** Whether this is the momentum formulation. */
    bool
    in_momentum() const
    {
      return smoothing != nullptr;
    }

    /** Inverse of the lumped mass (1/kg), one where constrained. */
    void
    inverse_mass(Vector &inverse) const;

    /** Whether a rotation of the body is free of energy. */
    bool
    has_rotations() const
    {
      return !axisymmetric;
    }

    const Footprints<dim> &
    footprints() const
    {
      return prints;
    }

    unsigned int
    n_limited_boxes() const
    {
      return builder->n_limited_boxes;
    }

    const BackgroundGrid<dim> &grid;
    StepConstraints<dim>       constraints;
    PointResponse<dim>         response;
    PopulatedCells<dim>        populated;

    // Of the nodes, at the start of the step.
    Vector                mass;         ///< lumped (kg), if inertia
    Vector                velocity;     ///< (m/s), if inertia
    Vector                acceleration; ///< (m/s^2), if the integrator wants it
    unsigned int          n_held_cells; ///< isolated ones
    unsigned int          n_active_dofs; ///< neither constrained nor unused
    mutable unsigned long n_operator_applications = 0;

  private:
    /** Gradients of a vector at all points; its ghosts are up to date. */
    void
    gradients_at_points(const Vector &u, std::vector<double> &gradients) const;

    /** force += sum_p B^T stress; ghosts of force not summed. */
    void
    add_point_forces(const std::vector<double> &stress, Vector &force) const;

    void
    mark_support();

    /** Minus the external forces at an instant (N). */
    void
    gather_load(double instant, Vector &load);

    void
    add_body_force(double instant, Vector &load);

    /** Forces at the start of the step, if the integrator weighs them. */
    void
    gather_start_forces();

    /** Stiffness times the size of a cell, Sulsky & Kaul's unit of forces. */
    double
    force_of_cell() const;

    void
    hold_isolated_cells();

    /** Inertia and holding stiffness of a local element (N/m). */
    double
    diagonal_stiffness(const unsigned int i) const
    {
      return holding.local_element(i) +
             (integrator.has_inertia() ?
                integrator.mass_factor(dt) * mass.local_element(i) :
                0.);
    }

    /** `strain_src` is what strains, `src` what has inertia. */
    void
    apply_tangent(Vector       &dst,
                  const Vector &strain_src,
                  const Vector &src) const;

    /** Adds inertia to `forces` and to its potential; returns their norm. */
    double
    add_inertia(const Vector &u, double &potential);

    using Patch = typename Footprints<dim>::Patch;

    void
    patch_matrix(const Patch &patch, dealii::FullMatrix<double> &matrix) const;

    template <typename Size>
    void
    add_points(const Patch                &patch,
               Size                        n_patch_nodes,
               dealii::FullMatrix<double> &matrix) const;

    /** Fills a matrix with what strain costs: inertia is not in it. */
    void
    assemble_stiffness(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    void
    add_coupling(const Patch &patch, dealii::FullMatrix<double> &matrix) const;

    std::vector<dealii::types::global_dof_index>
    dofs_of_nodes(const unsigned int *begin, const unsigned int *end) const;

    const Scene<dim>          &scene;
    const MaterialPoints<dim> &points;
    const TimeIntegrator      &integrator;
    const bool                 axisymmetric;
    const unsigned int         n_gradients; ///< values of a gradient
    double                     time, dt;
    bool                       nodes_have_motion = false;

    const std::unique_ptr<FootprintBuilder<dim>> builder;
    Footprints<dim>                              prints;
    GhostPenalty<dim>                            ghost;
    Vector holding;            ///< stiffness of isolated cells (N/m)
    Vector known_acceleration; ///< (m/s^2)
    Vector load, start_load;   ///< minus the external forces (N)
    Vector start_forces;       ///< f(0) (N), if the integrator weighs it
    Vector start_increment;    ///< dt v (m), in the momentum formulation
    double force_scale;        ///< norm of the forces at a strain of one (N)
    double smallest_extent;    ///< of a cell (m)

    std::vector<dealii::Tensor<1, dim>> point_forces; ///< (N)

    mutable std::vector<double> gradient_increments, stress_increments;
    mutable std::vector<double> slopes, shares; ///< of a point on its patch
    mutable Vector              work, smooth, smooth_direction;
    const std::unique_ptr<VelocitySmoothing<dim>> smoothing; ///< or null
    /** A factor of the matrix in the momentum formulation. */
    mutable dealii::TrilinosWrappers::SparseMatrix stiffness;
    Vector                                         forces, free_residual;
  };
} // namespace impm

#endif
