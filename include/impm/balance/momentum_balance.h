#ifndef impm_balance_momentum_balance_h
#define impm_balance_momentum_balance_h

#include <impm/balance/terms/term.h>
#include <impm/balance/velocity_smoothing.h>
#include <impm/grid/step_constraints.h>
#include <impm/solve/nonlinear_system.h>

#include <memory>
#include <vector>

namespace impm
{
  /**
   * The balance of momentum on the grid over one step, condensed to the nodes
   * that are free. Unknown is the grid's displacement increment u:
   *
   *   w f(u) + (1 - w) f(0) + n(u) = 0,
   *
   * with the sums f of terms that strain has to do with, weighed by the
   * integrator, and n of those of the nodes alone. A scene has the terms that
   * it needs and no others. In the momentum formulation f feels an increment
   * that is smoothed.
   */
  template <int dim>
  class MomentumBalance final : public NonlinearSystem
  {
  public:
    /** What it consists of, and lives no longer than. */
    struct Parts
    {
      const Discretization<dim>  &discretization;
      const StepConstraints<dim> &constraints;
      const ResidualNorm         *norm; ///< null if none asks for residuals
      std::vector<Term *>         strain_terms, node_terms;
      const Vector               &start_forces; ///< f(0) (N), if w is below one
      const Vector               &mass;         ///< (kg), or empty
      /** Of the momentum formulation, or null. */
      const VelocitySmoothing<dim> *smoothing;
      double                        end_weight; ///< w
      bool minds_forces_at_work; ///< whether residuals are small beside these
      bool has_potential;
      bool has_guide;     ///< whether it has one nearly
      bool has_rotations; ///< whether a rotation of the body is free
    };

    MomentumBalance(const Parts &parts, WorkCounts &work_counts)
      : parts(parts)
    {
      counts = &work_counts;
      if (parts.norm)
        for (Vector *vector : {&forces, &free_residual, &work})
          initialize(*vector);
      if (parts.smoothing)
        initialize(smooth);
    }

    /** Takes the state of the points at `u`, whose ghosts are up to date;
     * false, on every rank alike, when a point has none. Collective. */
    bool
    strain(const Vector &u, bool with_tangent);

    Evaluation
    evaluate(const Vector &u, bool with_tangent = true) override;

    const Vector &
    residual() const override
    {
      return free_residual;
    }

    std::vector<double>
    norms_of(const Vector &force) const override
    {
      return parts.norm->largest_nearby(force);
    }

    bool
    has_potential() const override
    {
      return parts.has_potential;
    }

    bool
    has_guide() const override
    {
      return parts.has_guide;
    }

    double
    work_along(const Vector &direction, const Vector &force) const override;

    void
    take_tangent() override
    {
      for (Term *term : parts.strain_terms)
        term->take_tangent();
    }

    void
    project_tangent() override
    {
      for (Term *term : parts.strain_terms)
        term->project_tangent();
    }

    /**
     * dst = C^T K C src, identity on constrained values; C sets hanging nodes
     * and zeros.
     */
    void
    vmult(Vector &dst, const Vector &src) const override;

    void
    vmult_lift(Vector &dst, const Vector &src) const override;

    /**
     * That of the velocity formulation in any case. At masters of hanging
     * nodes the terms that couple a hanging node to its master are left out.
     */
    void
    diagonal(Vector &diagonal) const override;

    Unknowns
    make_unknowns() const override;

    std::unique_ptr<SparseMatrix>
    make_matrix(const Unknowns &unknowns) const override;

    void
    assemble(SparseMatrix &matrix) const override;

    LowRank
    correction() const override;

    /** Translations and, where they are free, rotations. */
    std::vector<std::vector<double>>
    near_null_space(const Unknowns &unknowns) const override;

    NodeLattice
    lattice(const Unknowns &unknowns) const override;

    void
    initialize(Vector &vector) const override
    {
      parts.discretization.initialize(vector);
    }

    void
    set_prescribed(Vector &u) const override
    {
      parts.constraints.set_prescribed(u);
    }

    void
    interpolate_hanging(Vector &vector) const override
    {
      parts.discretization.interpolate_hanging(vector);
    }

    bool
    is_constrained(const unsigned int local_index) const override
    {
      return parts.constraints.is_constrained[local_index];
    }

    const Vector *
    weight_of_unknowns() const override
    {
      return parts.smoothing ? &parts.mass : nullptr;
    }

    double
    length_scale() const override
    {
      return parts.discretization.smallest_cell_extent;
    }

    /** What faces and rigid bodies exert (N), as the integrator weighs it over
     * the step: the residual before they do. */
    const Vector &
    constraint_forces() const
    {
      return forces;
    }

    /**
     * The forces of strain and loads alone, f(u) (N), at the increment where
     * the balance stands evaluated. Collective.
     */
    Vector
    forces_of_strain(const Vector &u) const;

  private:
    /** What strains for an increment: this one, or what smoothing makes of it,
     * in `smooth`. */
    const Vector &
    strain_increment(const Vector &u) const
    {
      if (!parts.smoothing)
        return u;
      parts.smoothing->apply(u, smooth);
      return smooth;
    }

    /** The same for a direction, with its hanging nodes set in `work`. */
    const Vector &
    strain_direction() const
    {
      interpolate_hanging(work);
      if (!parts.smoothing)
        return work;
      parts.smoothing->apply_derivative(work, smooth);
      return smooth;
    }

    /** Adds f(u) for what strains. Collective. */
    void
    add_forces_of_strain(const Vector &strain_u, Vector &result) const;

    /** dst = K C times `work`, condensed. */
    void
    apply_tangent(Vector &dst) const;

    /** Takes apart the residual that `forces` have, which came of `strain
     * forces` alone before. */
    void
    judge(const Vector              &u,
          const std::vector<double> &strain_forces,
          Evaluation                &result) const;

    const Parts parts;

    Vector         forces, free_residual;
    mutable Vector work, smooth;
    /** A factor of the matrix in the momentum formulation. */
    mutable std::unique_ptr<SparseMatrix> stiffness, spread_mass;
  };
} // namespace impm

#endif
