#include <impm/materials/failure.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  double
  FailureStrain::operator()(const double triaxiality,
                            const double rate,
                            const double temperature) const
  {
    const double above = (temperature - reference_temperature) /
                         (melting_temperature - reference_temperature);
    const double strain =
      (d1 + (d2 == 0 ? 0. : d2 * std::exp(d3 * triaxiality))) *
      (1 + d4 * std::log(std::max(1., rate / reference_rate))) *
      (1 + d5 * std::clamp(above, 0., 1.));
    return std::max(strain, smallest);
  }

  namespace
  {
    double
    in_lane(const double x, const unsigned int /*lane*/)
    {
      return x;
    }

    double
    in_lane(const Lanes &x, const unsigned int lane)
    {
      return x[lane];
    }

    template <typename Value>
    Value *
    in_lane(Value *place, const unsigned int /*lane*/)
    {
      return place;
    }

    template <typename Value>
    Value *
    in_lane(const std::array<Value *, n_lanes> &places, const unsigned int lane)
    {
      return places[lane];
    }

    /** Mean over von Mises stress; 0 without stress. */
    template <typename Number>
    double
    triaxiality(const SymmetricTensor<2, 3, Number> &stress,
                const unsigned int                   lane)
    {
      SymmetricTensor<2, 3> tau;
      for (unsigned int i = 0; i < tau.n_independent_components; ++i)
        tau.access_raw_entry(i) = in_lane(stress.access_raw_entry(i), lane);
      const double von_mises = std::sqrt(1.5) * deviator(tau).norm();
      return von_mises > 0 ? trace(tau) / (3 * von_mises) : 0.;
    }
  } // namespace

  FailingLaw::FailingLaw(std::unique_ptr<const Material> the_law,
                         PointLayout                    &history,
                         const FailureStrain            &failure_strain,
                         const double                    remaining_share)
    : LawInLanes(*the_law,
                 the_law->stiffness(),
                 the_law->density * the_law->wave_speed() *
                   the_law->wave_speed())
    , law(std::move(the_law))
    , failure_strain(failure_strain)
    , remaining_share(remaining_share)
    , strain_offset(history.offset("equivalent_plastic_strain"))
    , damage_offset(history.add("damage", PointLayout::Kind::scalar))
    , failed_offset(history.add("failed", PointLayout::Kind::scalar))
    , energy_offset(history.add("failure_energy", PointLayout::Kind::scalar))
  {}

  template <typename Number>
  void
  FailingLaw::take_damage(const BasicStep<Number>             &step,
                          const SymmetricTensor<2, 3, Number> &stress) const
  {
    for (unsigned int lane = 0;
         lane < (std::is_same_v<Number, double> ? 1 : n_lanes);
         ++lane)
      {
        const double *start = in_lane(step.history, lane);
        double       *end   = in_lane(step.trial_history, lane);
        for (const unsigned int i :
             {damage_offset, failed_offset, energy_offset})
          end[i] = start[i];
        const double flow = end[strain_offset] - start[strain_offset];
        if (start[failed_offset] > 0 || !(flow > 0))
          continue;
        const double dt = step.dt;
        Tensor<2, 3> F;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            F[i][j] = in_lane(step.total[i][j], lane);
        // as the yield stress, by what the step has begun with
        const double hot =
          failure_strain.d5 == 0 ?
            failure_strain.reference_temperature :
            temperature(law->energy(F, start).dissipated, start);
        end[damage_offset] += flow / failure_strain(triaxiality(stress, lane),
                                                    dt > 0 ? flow / dt : 0.,
                                                    hot);
        if (end[damage_offset] < 1)
          continue;
        const auto energy  = law->energy(F, end);
        end[damage_offset] = 1;
        end[failed_offset] = 1;
        end[energy_offset] =
          (1 - remaining_share) * (energy.stored + energy.dissipated);
      }
  }

  template <typename Number>
  bool
  FailingLaw::evaluate_any(const BasicStep<Number> &step,
                           const bool               with_tangent,
                           BasicResponse<Number>   &response) const
  {
    bool has_stress;
    if constexpr (std::is_same_v<Number, double>)
      has_stress = law->evaluate_one(step, with_tangent, response);
    else
      has_stress = law->evaluate(step, with_tangent, response);
    if (!has_stress)
      return false;
    take_damage(step, response.kirchhoff_stress);
    const auto has_failed = read(step.history, failed_offset) > Number(0.);
    if (!any_of(has_failed))
      return true;
    const Number share =
      select(has_failed, Number(remaining_share), Number(1.));
    response.kirchhoff_stress *= share;
    response.potential *= share;
    if (with_tangent && form() == Form::full)
      response.full_tangent *= share;
    else if (with_tangent)
      response.tangent *= share;
    return true;
  }

  Material::Energy
  FailingLaw::energy(const Tensor<2, 3> &deformation_gradient,
                     const double       *history) const
  {
    auto energy = law->energy(deformation_gradient, history);
    if (history[failed_offset] == 0)
      return energy;
    return {remaining_share * energy.stored,
            remaining_share * energy.dissipated + history[energy_offset]};
  }

  double
  FailingLaw::remaining_stiffness(const double *history) const
  {
    return (history[failed_offset] > 0 ? remaining_share : 1) * stiffness();
  }

  template bool
  FailingLaw::evaluate_any(const Step &, bool, Response &) const;
  template bool
  FailingLaw::evaluate_any(const Steps &, bool, Responses &) const;
} // namespace impm
