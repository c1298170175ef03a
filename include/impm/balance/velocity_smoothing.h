#ifndef impm_balance_velocity_smoothing_h
#define impm_balance_velocity_smoothing_h

#include <impm/footprints/transfer.h>
#include <impm/grid/step_constraints.h>
#include <impm/solve/sparse_matrix.h>

#include <vector>

namespace impm
{
  /**
   * The momentum formulation (Sulsky & Kaul 2004, section 3.2.1). Points move
   * with the grid's increment u as always, but their strain comes from a
   * velocity that has been through the points (eq. 3.2.6 and 3.2.7):
   *
   *   v_p^L     = v_p + sum_I N_I (u / dt - v)_I,
   *   m_I v_I^L = sum_p m_p N_I v_p^L,
   *
   * so that the strain's increment is s(u) = dt v + A (u - dt v), where
   * A = M^-1 S^T m S averages over the points around a node. A node with
   * little mass then has little to say. What a face or a rigid body prescribes
   * holds for both. s is affine in u; K A is not symmetric, so neither is the
   * tangent.
   */
  template <int dim>
  class VelocitySmoothing
  {
  public:
    /** For a step of length dt (s). Collective. */
    VelocitySmoothing(const MaterialPoints<dim>  &points,
                      const Footprints<dim>      &footprints,
                      const StepConstraints<dim> &constraints,
                      const Discretization<dim>  &discretization,
                      const NodalMotion          &motion,
                      double                      dt);

    /** result = s(u). Ghosts and hanging nodes of the result are up to date.
     * Collective. */
    void
    apply(const Vector &u, Vector &result) const;

    /** The derivative of s: result = A u, u itself where prescribed. */
    void
    apply_derivative(const Vector &u, Vector &result) const;

    // A, as a matrix, is the product of these two: then K A, for a K that
    // constraints have been condensed into, keeps the diagonal of constrained
    // values. It couples nodes that are two cells apart.

    /** M^-1 (1/kg), one where constrained. */
    Vector scaling;

    /** Makes S^T m S (kg) of an empty matrix, identity where constrained.
     * Collective. */
    void
    fill_spread_mass(SparseMatrix &matrix) const;

  private:
    const MaterialPoints<dim>  &points;
    const Footprints<dim>      &footprints;
    const StepConstraints<dim> &constraints;
    const Discretization<dim>  &discretization;
    Vector                      start; ///< dt v (m)

    mutable Vector                              change;
    mutable std::vector<dealii::Tensor<1, dim>> at_points;
  };
} // namespace impm

#endif
