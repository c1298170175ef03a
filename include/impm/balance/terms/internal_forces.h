#ifndef impm_balance_terms_internal_forces_h
#define impm_balance_terms_internal_forces_h

#include <deal.II/base/array_view.h>

#include <deal.II/lac/full_matrix.h>

#include <impm/balance/point_response.h>
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
  class InternalForces
  {
  public:
    /** For footprints, which have patches when a matrix is wanted, and the
     * points' trial state. */
    InternalForces(const Footprints<dim> &footprints,
                   PointResponse<dim>    &response)
      : response(response)
      , prints(footprints)
      , axisymmetric(response.kinematics.axisymmetric)
      , n_gradients(response.kinematics.size)
    {}

    /** Takes the state at an increment, which all else refers to. Returns
     * false when a point has no stress. */
    bool
    evaluate(const Vector &u, const bool with_tangent)
    {
      gradients_at_points(u, response.gradients);
      return response.evaluate(with_tangent);
    }

    /** Adds f of the response as it is (N); ghosts are not summed. */
    void
    add_force(Vector &force) const
    {
      add_forces_of(response.stresses, force);
    }

    /** image += df/du direction; ghosts are not summed. */
    void
    apply(const Vector &direction, Vector &image) const;

    /** Calls `take` with the nodes of blocks of df/du, by local number, and
     * with the blocks, empty ones if only the pattern is wanted. */
    template <typename Take>
    void
    for_each_block(const bool only_pattern, const Take &take) const
    {
      dealii::FullMatrix<double> block;
      for (const auto &patch : prints.patches)
        {
          if (!only_pattern)
            patch_matrix(patch, block);
          take(dealii::make_array_view(
                 prints.patch_nodes.begin() + patch.begin_nodes,
                 prints.patch_nodes.begin() + patch.end_nodes),
               block);
        }
    }

    PointResponse<dim> &response;

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

    /** Fills `slopes` and `shares` for a point on all nodes of its patch. */
    void
    place_on_patch(unsigned int point) const;

    template <typename Size>
    void
    add_points(const Patch                &patch,
               Size                        n_patch_nodes,
               dealii::FullMatrix<double> &matrix) const;

    void
    add_coupling(const Patch &patch, dealii::FullMatrix<double> &matrix) const;

    const Footprints<dim> &prints;
    const bool             axisymmetric;
    const unsigned int     n_gradients; ///< values of a gradient

    mutable std::vector<double> gradient_changes, stress_changes;
    mutable std::vector<double> slopes, shares;
  };
} // namespace impm

#endif
