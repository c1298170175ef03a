#ifndef impm_materials_newtonian_fluid_h
#define impm_materials_newtonian_fluid_h

#include <impm/materials/pointwise_law.h>

#include <memory>

namespace impm
{
  /**
   * Sulsky & Kaul (2004), eq. 2.1.7, with a linear equation of state:
   *
   *   sigma = -p 1 + lambda tr(d) 1 + 2 mu d,   p = K (rho / rho_0 - 1),
   *
   * rho / rho_0 = 1 / J and d = strain / dt by the midpoint rule (see
   * midpoint_rate.h). The pressure stores K (J - 1 - ln J), the rest
   * dissipates.
   *
   * History: "viscous_stress" (Pa), which is that of the state at t_n, and
   * "viscous_work" per initial volume (J/m^3).
   */
  class NewtonianFluid final : public PointwiseLaw<NewtonianFluid>
  {
  public:
    /** K (Pa, > 0), mu and lambda (Pa s), 3 lambda + 2 mu >= 0. */
    NewtonianFluid(const MaterialSpec &spec,
                   PointLayout        &history,
                   double              bulk,
                   double              viscosity,
                   double              second_viscosity);

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<const Material>
    create(dealii::ParameterHandler &prm,
           const MaterialSpec       &spec,
           PointLayout              &history);

    void
    initialize_history(double *history) const override;

    /** With dt = 0 the viscous stress is that of the history. */
    bool
    evaluate_point(const Step &step,
                   bool        with_tangent,
                   Response   &response) const;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

    Form
    form() const override
    {
      return Form::full;
    }

    bool
    has_potential() const override
    {
      return false;
    }

    bool
    is_solid() const override
    {
      return false;
    }

  private:
    /** lambda tr(rate) 1 + 2 mu rate. */
    dealii::SymmetricTensor<2, 3>
    viscous_stress(const dealii::SymmetricTensor<2, 3> &rate) const;

    const double       bulk, viscosity, second_viscosity;
    const PointLayout  storage; ///< knows how tensors are stored
    const unsigned int stress_offset, work_offset;
  };
} // namespace impm

#endif
