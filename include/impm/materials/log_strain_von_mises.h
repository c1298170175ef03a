#ifndef impm_materials_log_strain_von_mises_h
#define impm_materials_log_strain_von_mises_h

#include <impm/materials/hardening/find_flow.h>
#include <impm/materials/log_strain_elastic.h>

#include <array>
#include <cmath>

namespace impm
{
  /**
   * Multiplicative von Mises plasticity: Hencky's elasticity below the yield
   * limit
   *
   *   q = sqrt(3/2) |dev tau| <= limit of the hardening
   *
   * with associated, isochoric flow and alpha the equivalent plastic strain.
   * In principal logarithmic strains the exponential map makes the return
   * mapping that of small strains (Simo 1992, see log_strain.h). A step
   * minimizes over alpha the potential
   *
   *   W = psi(eps_e) + integral of the yield limit over alpha,
   *
   * whose derivative by the trial strains is tau, so that D is symmetric.
   *
   * History: "elastic_left_cauchy_green" b_e (-) and that of the hardening (see
   * CurveHardening).
   */
  template <typename Hardening>
  class LogStrainVonMises final
    : public LawInLanes<LogStrainVonMises<Hardening>>
  {
  public:
    template <typename Number>
    using BasicStep = Material::BasicStep<Number>;

    template <typename Number>
    using BasicResponse = Material::BasicResponse<Number>;

    LogStrainVonMises(const MaterialSpec                   &spec,
                      PointLayout                          &history,
                      const ElasticConstants               &elasticity,
                      const typename Hardening::Parameters &parameters)
      : LawInLanes<LogStrainVonMises>(spec,
                                      elasticity.young,
                                      elasticity.longitudinal_modulus())
      , elasticity{elasticity}
      , elastic(history, "elastic_left_cauchy_green")
      , hardening(spec, history, parameters)
    {}

    void
    initialize_history(double *history) const override
    {
      elastic.store(dealii::unit_symmetric_tensor<3>(), history);
    }

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 const bool               with_tangent,
                 BasicResponse<Number>   &response) const
    {
      dealii::SymmetricTensor<2, 3, Number> trial;
      LogStrain::PrincipalStrains<Number>   principal;
      if (!find_trial(step, elastic, trial, principal))
        return false;

      auto                  stress = elasticity.stress(principal.strain);
      std::array<Number, 3> elastic_strain = principal.strain;

      const Number mean =
        (stress.stress[0] + stress.stress[1] + stress.stress[2]) / 3.;
      std::array<Number, 3> deviator;
      Number                squares = 0.;
      for (unsigned int a = 0; a < 3; ++a)
        {
          deviator[a] = stress.stress[a] - mean;
          squares += deviator[a] * deviator[a];
        }
      using std::sqrt;
      const Number q = sqrt(1.5 * squares);

      const double shear = elasticity.shear;
      const auto   limit = hardening.limit(step);
      const Number flow  = find_flow(q, limit, 3. * shear);
      const auto   flows = flow != 0.; // or there is none, NaN
      auto         end   = trial;
      if (any_of(flows))
        {
          const Number resistance = 3. * shear + limit.slope(flow);

          // The deviator shrinks onto the yield limit along its own direction.
          const Number size = select(flows, q, Number(1.));
          const Number part = limit.yield_stress(flow) / size;
          const Number scale =
            select(flows, select(part > 1., Number(1.), part), Number(1.));
          const Number mean_strain =
            (elastic_strain[0] + elastic_strain[1] + elastic_strain[2]) / 3.;
          std::array<Number, 3> stretches_squared;
          for (unsigned int a = 0; a < 3; ++a)
            {
              const Number shrunk =
                mean_strain + scale * (elastic_strain[a] - mean_strain);
              elastic_strain[a] = select(flows, shrunk, elastic_strain[a]);
              stretches_squared[a] =
                each([](const double x) { return std::exp(x); },
                     Number(2. * elastic_strain[a]));
              stress.stress[a] =
                select(flows, mean + scale * deviator[a], stress.stress[a]);
            }
          const auto returned =
            LogStrain::compose(stretches_squared, principal);
          for (unsigned int i = 0; i < end.n_independent_components; ++i)
            end.access_raw_entry(i) = select(flows,
                                             returned.access_raw_entry(i),
                                             trial.access_raw_entry(i));

          // The scale itself changes with the trial strains, through q only.
          if (with_tangent)
            {
              const Number softening =
                select(flows,
                       9. * shear * shear * (1. / resistance - flow / size),
                       Number(0.));
              const Number lame = elasticity.bulk - 2. / 3. * shear * scale;
              for (unsigned int a = 0; a < 3; ++a)
                {
                  for (unsigned int b = 0; b < 3; ++b)
                    stress.moduli[a][b] = lame - softening *
                                                   (deviator[a] / size) *
                                                   (deviator[b] / size);
                  stress.moduli[a][a] += 2. * shear * scale;
                }
              stress.secant.fill(2. * shear * scale);
            }
        }
      elastic.store(end, step.trial_history);
      const Number work = limit.work(flow);
      hardening.store(limit, flow, work, step.trial_history);

      response.kirchhoff_stress = LogStrain::compose(stress.stress, principal);
      response.potential        = elasticity.energy(elastic_strain) + work;
      if (with_tangent)
        LogStrain::lie_tangent(principal, stress, response.tangent);
      return all_of(is_finite(response.potential));
    }

    bool
    softens(const double *start, const double *end) const override
    {
      return hardening.work(end) > hardening.work(start) &&
             has_fallen(hardening.yield_stress(start),
                        hardening.yield_stress(end));
    }

    Material::Energy
    energy(const dealii::Tensor<2, 3> &, const double *history) const override
    {
      return {elasticity.energy(elastic.load(history)),
              hardening.work(history)};
    }

    bool
    depends_on_shape() const override
    {
      return false;
    }

  private:
    const HenckyElasticity elasticity;
    const HistoryTensor    elastic;
    const Hardening        hardening;
  };
} // namespace impm

#endif
