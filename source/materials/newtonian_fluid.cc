#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/materials/midpoint_rate.h>
#include <impm/materials/newtonian_fluid.h>

#include <cmath>

namespace impm
{
  // K is what a step resists with whatever its length.
  NewtonianFluid::NewtonianFluid(const MaterialSpec &spec,
                                 PointLayout        &history,
                                 const double        bulk,
                                 const double        viscosity,
                                 const double        second_viscosity)
    : PointwiseLaw(spec, bulk, bulk)
    , bulk(bulk)
    , viscosity(viscosity)
    , second_viscosity(second_viscosity)
    , storage(history.geometry)
    , stress_offset(
        history.add("viscous_stress", PointLayout::Kind::symmetric_tensor))
    , work_offset(history.add("viscous_work", PointLayout::Kind::scalar))
  {}


  void
  NewtonianFluid::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Bulk modulus",
                      "2e9",
                      dealii::Patterns::Double(1e-300),
                      "Pressure over relative change of density (Pa), "
                      "positive.");
    prm.declare_entry("Viscosity",
                      "0",
                      dealii::Patterns::Double(0.),
                      "Shear stress over rate of shear (Pa s), not negative.");
    prm.declare_entry("Second viscosity",
                      "0",
                      dealii::Patterns::Double(),
                      "Stress over rate of dilation, besides what 'Viscosity' "
                      "does (Pa s); at least -2/3 of it.");
    declare_density(prm);
  }


  std::unique_ptr<const Material>
  NewtonianFluid::create(dealii::ParameterHandler &prm,
                         const MaterialSpec       &spec,
                         PointLayout              &history)
  {
    const double viscosity = prm.get_double("Viscosity"),
                 second    = prm.get_double("Second viscosity");
    if (3 * second + 2 * viscosity < -1e-12 * viscosity)
      throw InputError("Second viscosity",
                       "found '" + prm.get("Second viscosity") +
                         "', allowed is at least -2/3 of 'Viscosity' = " +
                         prm.get("Viscosity"));
    return std::make_unique<NewtonianFluid>(
      spec, history, prm.get_double("Bulk modulus"), viscosity, second);
  }


  void
  NewtonianFluid::initialize_history(double *history) const
  {
    storage.store_symmetric({}, history + stress_offset);
    history[work_offset] = 0;
  }


  dealii::SymmetricTensor<2, 3>
  NewtonianFluid::viscous_stress(
    const dealii::SymmetricTensor<2, 3> &rate) const
  {
    return 2 * viscosity * rate + second_viscosity * dealii::trace(rate) *
                                    dealii::unit_symmetric_tensor<3>();
  }


  bool
  NewtonianFluid::evaluate_point(const Step &step,
                                 const bool  with_tangent,
                                 Response   &response) const
  {
    const double J  = dealii::determinant(step.total);
    const double dt = step.dt;
    MidpointRate rate;
    if (!(J > 0) || !(dealii::determinant(step.increment) > 0) ||
        !rate.measure(step.increment))
      return false;

    auto   viscous = storage.load_symmetric(step.history + stress_offset);
    double work    = step.history[work_offset];
    if (dt > 0)
      {
        viscous = viscous_stress(rate.strain / dt);
        work += J * (viscous * rate.strain);
      }
    storage.store_symmetric(viscous, step.trial_history + stress_offset);
    step.trial_history[work_offset] = work;

    // J p = K (1 - J)
    const auto unit           = dealii::unit_symmetric_tensor<3>();
    response.kirchhoff_stress = bulk * (J - 1) * unit + J * viscous;
    response.potential        = 0;
    if (with_tangent)
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l)
          {
            dealii::SymmetricTensor<2, 3> change;
            if (dt > 0)
              {
                dealii::Tensor<2, 3> L, rotation_change;
                L[k][l] = 1;
                dealii::SymmetricTensor<2, 3> strain_change;
                rate.differentiate(L,
                                   step.increment,
                                   strain_change,
                                   rotation_change);
                change = J * viscous_stress(strain_change / dt);
              }
            if (k == l)
              change += J * (bulk * unit + viscous);
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                response.full_tangent[i][j][k][l] = change[i][j];
          }
    return std::isfinite(response.kirchhoff_stress.norm());
  }


  Material::Energy
  NewtonianFluid::energy(const dealii::Tensor<2, 3> &deformation_gradient,
                         const double               *history) const
  {
    const double change = dealii::determinant(deformation_gradient) - 1;
    Energy       result;
    result.stored     = bulk * (change - std::log1p(change));
    result.dissipated = history[work_offset];
    return result;
  }
} // namespace impm
