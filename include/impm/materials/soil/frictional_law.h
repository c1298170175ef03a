#ifndef impm_materials_soil_frictional_law_h
#define impm_materials_soil_frictional_law_h

#include <impm/materials/hardening/find_flow.h>
#include <impm/materials/soil/drucker_prager.h>
#include <impm/materials/soil/mohr_coulomb.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  /**
   * Multiplicative plasticity of soils: Hencky's elasticity within a limit of
   * the principal Kirchhoff stresses, DruckerPrager or MohrCoulomb, to which
   * trial stresses return as at small strains (log_strain.h).
   *
   * Where a return ends without any stress, grains have come apart. What their
   * volume has grown by is the opening w, a logarithmic strain that compression
   * has to use up before there is stress again: the trial strains of the next
   * step are eps_a + w / 3 (A. P. Tampubolon et al., ACM Trans. Graph. 36
   * (2017) 105, section 4.3.4). Without it a step would forget the gap.
   *
   * The cohesion of a step is that of its start. The potential of a step is
   *
   *   W = psi(eps_e) + tau . (eps - eps_e),
   *
   * whose derivative is tau where the flow is associated.
   *
   * History: "elastic_left_cauchy_green" b_e (-), "equivalent_plastic_strain",
   * the sum of sqrt(2/3) |dev d eps_p| (-), "plastic_work" (J/m^3) and
   * "opening" w (-).
   */
  template <typename Limit>
  class FrictionalLaw final : public PointwiseLaw<FrictionalLaw<Limit>>
  {
  public:
    struct Parameters
    {
      static void
      declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
      {
        ElasticConstants::declare_parameters(prm, chosen);
        Limit::declare_parameters(prm, chosen);
      }

      static Parameters
      from_parameters(dealii::ParameterHandler &prm)
      {
        return {ElasticConstants::from_parameters(prm),
                Limit::from_parameters(prm)};
      }

      ElasticConstants elasticity;
      Limit            limit;
    };

    FrictionalLaw(const MaterialSpec &spec,
                  PointLayout        &history,
                  const Parameters   &parameters)
      : PointwiseLaw<FrictionalLaw>(
          spec,
          parameters.elasticity.young,
          parameters.elasticity.longitudinal_modulus())
      , elasticity{parameters.elasticity}
      , limit(parameters.limit)
      , elastic(history, "elastic_left_cauchy_green")
      , plastic_strain(
          history.add("equivalent_plastic_strain", PointLayout::Kind::scalar))
      , plastic_work(history.add("plastic_work", PointLayout::Kind::scalar))
      , opening(history.add("opening", PointLayout::Kind::scalar))
    {}

    void
    initialize_history(double *history) const override
    {
      elastic.store(dealii::unit_symmetric_tensor<3>(), history);
    }

    bool
    evaluate_one(const Material::Step &step,
                 const bool            with_tangent,
                 Material::Response   &response) const override
    {
      dealii::SymmetricTensor<2, 3, double> trial;
      LogStrain::PrincipalStrains<double>   principal;
      if (!find_trial(step, elastic, trial, principal))
        return false;

      // A cohesion that has changed waits for a step that takes time.
      const bool   may_flow = step.dt > 0 || limit.hardening == 0;
      const double gap      = may_flow ? step.history[opening] : 0.;
      auto         strain   = principal.strain;
      for (double &e : strain)
        e += gap / 3.;
      SoilReturn end{false, elasticity.stress(strain), strain};
      if (may_flow &&
          !limit.project(elasticity,
                         limit.cohesion_after(step.history[plastic_strain]),
                         end))
        return false;

      const auto               &stress = end.response.stress;
      LogStrain::Triple<double> flow, stretches_squared;
      double                    volume = 0, squares = 0, work = 0;
      for (unsigned int a = 0; a < 3; ++a)
        {
          flow[a] = strain[a] - end.elastic_strain[a];
          volume += flow[a];
          work += stress[a] * flow[a];
          stretches_squared[a] = std::exp(2. * end.elastic_strain[a]);
        }
      for (const double f : flow)
        squares += (f - volume / 3.) * (f - volume / 3.);
      elastic.store(end.flows || gap > 0 ?
                      LogStrain::compose(stretches_squared, principal) :
                      trial,
                    step.trial_history);
      step.trial_history[plastic_strain] =
        step.history[plastic_strain] + std::sqrt(2. / 3. * squares);
      step.trial_history[plastic_work] = step.history[plastic_work] + work;
      const bool apart = end.flows && stress == LogStrain::Triple<double>{};
      step.trial_history[opening] = !may_flow ? step.history[opening] :
                                    apart     ? volume :
                                                0.;

      response.kirchhoff_stress = LogStrain::compose(stress, principal);
      response.potential        = elasticity.energy(end.elastic_strain) + work;
      if (with_tangent)
        LogStrain::lie_tangent(principal, end.response, response.tangent);
      return is_finite(response.potential);
    }

    bool
    softens(const double *start, const double *end) const override
    {
      return has_fallen(limit.cohesion_after(start[plastic_strain]),
                        limit.cohesion_after(end[plastic_strain]));
    }

    Material::Energy
    energy(const dealii::Tensor<2, 3> &, const double *history) const override
    {
      return {elasticity.energy(elastic.load(history)), history[plastic_work]};
    }

    bool
    has_symmetric_tangent() const override
    {
      return limit.dilation == limit.friction;
    }

    bool
    depends_on_shape() const override
    {
      return false;
    }

  private:
    const HenckyElasticity elasticity;
    const Limit            limit;
    const HistoryTensor    elastic;
    const unsigned int     plastic_strain, plastic_work, opening; ///< offsets
  };
} // namespace impm

#endif
