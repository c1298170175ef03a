#ifndef impm_balance_momentum_balance_h
#define impm_balance_momentum_balance_h

#include <impm/balance/residual_norm.h>
#include <impm/balance/terms/term.h>
#include <impm/balance/velocity_smoothing.h>
#include <impm/solve/nonlinear_system.h>

#include <memory>
#include <vector>

namespace impm
{
  /**
   * The balance of momentum on the grid over one step: a sum of terms,
   * condensed to the nodes that are free. Unknown is the grid's displacement
   * increment u:
   *
   *   w f(u) + (1 - w) f(0) + n(u) = 0,
   *
   * with the terms f that strain has to do with (points, ghost penalty, loads),
   * weighed by the integrator, and those n of the nodes alone, whose derivative
   * is a diagonal (inertia, holding). In the momentum formulation f feels an
   * increment that is smoothed.
   */
  template <int dim>
  class MomentumBalance : public NonlinearSystem
  {
  public:
    using Terms = std::vector<std::unique_ptr<Term>>;

    struct Parts
    {
      Terms  strain_terms, node_terms;
      double end_weight;   ///< w
      Vector start_forces; ///< f(0) (N), where w is below one
      /** What residuals are measured by, and whether beside what acts, too. */
      const ResidualNorm *norm;
      bool                minds_forces_at_work;
      bool                has_potential;
      bool has_rotations; ///< whether a rotation of the body is free
      /** Of the momentum formulation, or null; and dt v (m), the mass (kg). */
      const VelocitySmoothing<dim> *smoothing = nullptr;
      Vector                        start_increment;
      const Vector                 *mass = nullptr;
    };

    MomentumBalance(const Discretization<dim>  &discretization,
                    const StepConstraints<dim> &constraints,
                    Parts                       parts,
                    WorkCounts                 &counts);

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

    double
    work_along(const Vector &direction, const Vector &force) const override;

    void
    project_tangent() override;

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

    std::unique_ptr<SparseMatrix>
    make_matrix() const override;

    void
    assemble(SparseMatrix &matrix) const override;

    /** Translations and, where they are free, rotations. */
    std::vector<std::vector<double>>
    near_null_space() const override;

    void
    initialize(Vector &vector) const override
    {
      discretization.initialize(vector);
    }

    void
    set_prescribed(Vector &u) const override
    {
      constraints.set_prescribed(u);
    }

    void
    interpolate_hanging(Vector &vector) const override
    {
      discretization.interpolate_hanging(vector);
    }

    bool
    is_constrained(const unsigned int local_index) const override
    {
      return constraints.is_constrained[local_index];
    }

    const Vector *
    weight_of_unknowns() const override
    {
      return parts.smoothing != nullptr ? parts.mass : nullptr;
    }

    double
    length_scale() const override
    {
      return discretization.smallest_cell_extent;
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
    /** `strain_src` is what strains, `src` what the nodes do. */
    void
    apply_tangent(Vector       &dst,
                  const Vector &strain_src,
                  const Vector &src) const;

    /** Fills a matrix with what strain costs. */
    void
    assemble_stiffness(SparseMatrix &matrix) const;

    /** Takes apart the residual that `forces` have, which came of `strain
     * forces` alone before. */
    void
    judge(const Vector              &u,
          const std::vector<double> &strain_forces,
          Evaluation                &result) const;

    const Discretization<dim>  &discretization;
    const StepConstraints<dim> &constraints;
    const Parts                 parts;

    Vector         forces, free_residual;
    mutable Vector work, smooth;
    /** A factor of the matrix in the momentum formulation. */
    mutable std::unique_ptr<SparseMatrix> stiffness, spread_mass;
  };
} // namespace impm

#endif
