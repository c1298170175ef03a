#ifndef impm_materials_newtonian_fluid_h
#define impm_materials_newtonian_fluid_h

#include <impm/materials/material.h>

#include <memory>
#include <optional>

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
  class NewtonianFluid final : public Material
  {
  public:
    /** K (Pa, > 0), mu and lambda (Pa s), 3 lambda + 2 mu >= 0. */
    NewtonianFluid(double bulk,
                   double viscosity,
                   double second_viscosity,
                   double density);

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<Material>
    create(dealii::ParameterHandler &prm);

    void
    declare_history(PointLayout &layout) override;

    void
    initialize_history(double *history) const override;

    /** With dt = 0 the viscous stress is that of the history. */
    bool
    evaluate(const Deformation &deformation,
             const double      *history,
             double            *trial_history,
             bool               with_tangent,
             Response          &response) const override;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

    /** K: what a step resists with whatever its length. */
    double
    stiffness() const override;

    /** sqrt(K / rho_0) */
    double
    wave_speed() const override;

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

    const double bulk, viscosity, second_viscosity;

    // where declare_history() has put the fields, and how they are stored
    std::optional<PointLayout> layout;
    unsigned int               stress_offset = 0, work_offset = 0;
  };
} // namespace impm

#endif
