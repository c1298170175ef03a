#ifndef impm_balance_terms_internal_forces_h
#define impm_balance_terms_internal_forces_h

#include <impm/balance/point_response.h>
#include <impm/balance/terms/term.h>
#include <impm/footprints/footprints.h>

#include <vector>

namespace impm
{
  /**
   * The forces of the material: f_I = sum_p V0_p P_p grad N_I with P = tau
   * dF^-T, where dF = I + sum_I u_I (x) grad N_I, F = dF F_n, gradients at t_n.
   * The tangent at a point is A = dP/d(dF), that is the spatial tangent of the
   * Newmark note carried back by dF^-1; see PointResponse.
   */
  template <int dim>
  class InternalForces : public Term
  {
  public:
    /** For footprints, which have patches when a matrix is wanted, and the
     * points' trial state. */
    InternalForces(const Footprints<dim> &footprints,
                   PointResponse<dim>    &response,
                   const double           smallest_cell_extent)
      : response(response)
      , prints(footprints)
      , axisymmetric(response.kinematics.axisymmetric)
      , n_gradients(response.kinematics.size)
      , extent(smallest_cell_extent)
    {}

    bool
    evaluate(const Vector &u, const bool with_tangent) override
    {
      gradients_at_points(u, response.gradients);
      return response.evaluate(with_tangent);
    }

    void
    add_force(const Vector &, Vector &force) const override
    {
      add_forces_of(response.acting(), force);
    }

    void
    add_end_force(const Vector &, Vector &force) const override
    {
      add_forces_of(response.stresses, force);
    }

    void
    add_start_force(Vector &force) const override
    {
      add_forces_of(response.start_stresses, force);
    }

    double
    energy(const Vector &, const Vector &) const override
    {
      return response.potential;
    }

    std::vector<double>
    squares_of_parts(const Vector &u, const ResidualNorm &norm) const override;

    void
    apply(const Vector &direction, Vector &image) const override;

    void
    add_matrix(bool only_pattern, const TakeBlock &take) const override;

    void
    project_tangent() override
    {
      response.project_tangent();
    }

  private:
    using Patch = typename Footprints<dim>::Patch;

    /** Gradients of a vector at all points. */
    void
    gradients_at_points(const Vector &u, std::vector<double> &gradients) const;

    /** force += sum_p B^T stress. */
    void
    add_forces_of(const std::vector<double> &stresses, Vector &force) const;

    void
    patch_matrix(const Patch &patch, dealii::FullMatrix<double> &matrix) const;

    /** Fills `slopes` and `hoops` for a point on all nodes of its patch, whose
     * number is filled up. */
    void
    place_on_patch(unsigned int point, unsigned int n) const;

    /** Adds B^T A B of such a point to `sums`. */
    void
    add_point(unsigned int point, unsigned int n) const;

    void
    add_coupling(const Patch &patch, dealii::FullMatrix<double> &matrix) const;

    PointResponse<dim>    &response;
    const Footprints<dim> &prints;
    const bool             axisymmetric;
    const unsigned int     n_gradients; ///< values of a gradient
    const double           extent;

    mutable std::vector<double> gradient_changes, stress_changes;
    // Of a point on its patch: d N_l / d x_d at [d n + l] (1/m), N_l / r.
    mutable std::vector<double> slopes, hoops;
    /** The matrix of a patch: row (l, b), column (m, c) at
     * [((m dim + c) dim + b) n + l], with n nodes filled up. */
    mutable std::vector<double> sums;
  };
} // namespace impm

#endif
