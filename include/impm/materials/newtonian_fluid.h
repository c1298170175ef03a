#ifndef impm_materials_newtonian_fluid_h
#define impm_materials_newtonian_fluid_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/input/parameter_file.h>
#include <impm/materials/material.h>
#include <impm/materials/midpoint_rate.h>

#include <cmath>

namespace impm
{
  /**
   * Sulsky & Kaul (2004), eq. 2.1.7, with a linear equation of state:
   *
   *   sigma = -p 1 + lambda tr(d) 1 + 2 mu d,   p = K (rho / rho_0 - 1),
   *
   * rho / rho_0 = 1 / J and d = strain / dt by the midpoint rule (see
   * midpoint_rate.h). The pressure stores K (J - 1 - ln J), the rest
   * dissipates. With dt = 0 the viscous stress is that of the history.
   *
   * History: "viscous_stress" (Pa), which is that of the state at t_n, and
   * "viscous_work" per initial volume (J/m^3).
   */
  class NewtonianFluid final : public PointwiseLaw<NewtonianFluid>
  {
  public:
    struct Parameters
    {
      static void
      declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
      {
        prm.declare_entry("Bulk modulus",
                          "2e9",
                          dealii::Patterns::Double(1e-300),
                          "Pressure over relative change of density (Pa), "
                          "positive; to be given.");
        prm.declare_entry("Viscosity",
                          "0",
                          dealii::Patterns::Double(0.),
                          "Shear stress over rate of shear (Pa s), not "
                          "negative.");
        prm.declare_entry("Second viscosity",
                          "0",
                          dealii::Patterns::Double(),
                          "Stress over rate of dilation, besides what "
                          "'Viscosity' does (Pa s); at least -2/3 of it.");
      }

      static Parameters
      from_parameters(dealii::ParameterHandler &prm)
      {
        const double viscosity = prm.get_double("Viscosity"),
                     second    = prm.get_double("Second viscosity");
        if (3 * second + 2 * viscosity < -1e-12 * viscosity)
          throw InputError("Second viscosity",
                           "found '" + prm.get("Second viscosity") +
                             "', allowed is at least -2/3 of 'Viscosity' = " +
                             prm.get("Viscosity"));
        return {prm.get_double("Bulk modulus"), viscosity, second};
      }

      double bulk;                        ///< K (Pa, > 0)
      double viscosity, second_viscosity; ///< mu, lambda (Pa s)
    };

    // K is what a step resists with whatever its length.
    NewtonianFluid(const MaterialSpec &spec,
                   PointLayout        &history,
                   const Parameters   &parameters)
      : PointwiseLaw(spec, parameters.bulk, parameters.bulk)
      , parameters(parameters)
      , stress_field(history, "viscous_stress")
      , work_offset(history.add("viscous_work", PointLayout::Kind::scalar))
    {}

    bool
    evaluate_one(const Step &step,
                 const bool  with_tangent,
                 Response   &response) const override
    {
      const double J  = dealii::determinant(step.total);
      const double dt = step.dt;
      MidpointRate rate;
      if (!(J > 0) || !rate.measure(step.increment))
        return false;

      auto   viscous = stress_field.load(step.history);
      double work    = step.history[work_offset];
      if (dt > 0)
        {
          viscous = viscous_stress(rate.strain / dt);
          work += J * (viscous * rate.strain);
        }
      stress_field.store(viscous, step.trial_history);
      step.trial_history[work_offset] = work;

      // J p = K (1 - J)
      const auto   unit         = dealii::unit_symmetric_tensor<3>();
      const double bulk         = parameters.bulk;
      response.kirchhoff_stress = bulk * (J - 1) * unit + J * viscous;
      response.potential        = 0;
      const auto change =
        [&](const auto &strain_change, const auto &, const bool stretches) {
          dealii::SymmetricTensor<2, 3> result;
          if (dt > 0)
            result = J * viscous_stress(strain_change / dt);
          if (stretches)
            result += J * (bulk * unit + viscous);
          return result;
        };
      if (with_tangent)
        response.full_tangent = rate.tangent(step.increment, change);
      return std::isfinite(response.kirchhoff_stress.norm());
    }

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override
    {
      const double change = dealii::determinant(deformation_gradient) - 1;
      return {parameters.bulk * (change - std::log1p(change)),
              history[work_offset]};
    }

    Form
    form() const override
    {
      return Form::full;
    }

    bool
    is_solid() const override
    {
      return false;
    }

    bool
    depends_on_shape() const override
    {
      return false;
    }

  private:
    /** lambda tr(rate) 1 + 2 mu rate. */
    dealii::SymmetricTensor<2, 3>
    viscous_stress(const dealii::SymmetricTensor<2, 3> &rate) const
    {
      return 2 * parameters.viscosity * rate +
             parameters.second_viscosity * dealii::trace(rate) *
               dealii::unit_symmetric_tensor<3>();
    }

    const Parameters    parameters;
    const HistoryTensor stress_field;
    const unsigned int  work_offset;
  };
} // namespace impm

#endif
