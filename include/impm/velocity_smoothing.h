#ifndef impm_velocity_smoothing_h
#define impm_velocity_smoothing_h

#include <impm/footprints.h>
#include <impm/step_constraints.h>

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
    VelocitySmoothing(const MaterialPoints<dim>  &points,
                      const Footprints<dim>      &footprints,
                      const StepConstraints<dim> &constraints,
                      const BackgroundGrid<dim>  &grid);

    /** For the lumped mass (kg) of this step. Collective. */
    void
    begin_step(const Vector &mass);

    /**
     * result = s(u), with `start` = dt v (m). Ghosts and hanging nodes of the
     * result are up to date. Collective.
     */
    void
    apply(const Vector &u, const Vector &start, Vector &result) const;

    /** The derivative of s: result = A u, u itself where prescribed. */
    void
    apply_derivative(const Vector &u, Vector &result) const;

  private:
    const MaterialPoints<dim>  &points;
    const Footprints<dim>      &footprints;
    const StepConstraints<dim> &constraints;
    const BackgroundGrid<dim>  &grid;

    Vector                                      inverse_mass;
    mutable Vector                              change;
    mutable std::vector<dealii::Tensor<1, dim>> at_points;
  };
} // namespace impm

#endif
