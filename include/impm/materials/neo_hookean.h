#ifndef impm_materials_neo_hookean_h
#define impm_materials_neo_hookean_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/material.h>

#include <cmath>
#include <limits>

namespace impm
{
  /**
   * Two laws whose energy is a function of tr b and J, with the constants of
   * small strains and no history. The most common one couples shape and
   * volume,
   *
   *   psi = G / 2 (tr b - 3 - 2 ln J) + lambda / 2 (ln J)^2,
   *   tau = G (b - 1) + lambda ln J 1;
   *
   * decoupled (Guilkey & Weiss 2003, eq. 20) the change of shape stands apart
   * from that of volume,
   *
   *   psi = G / 2 (J^(-2/3) tr b - 3) + K / 2 (ln J)^2,
   *   tau = G J^(-2/3) dev b + K ln J 1.
   */
  template <bool decoupled>
  class NeoHookean final : public LawInLanes<NeoHookean<decoupled>>
  {
  public:
    NeoHookean(const MaterialSpec &spec,
               PointLayout &,
               const ElasticConstants &constants)
      : LawInLanes<NeoHookean>(spec,
                               constants.young,
                               constants.longitudinal_modulus())
      , constants(constants)
      , volumetric(decoupled ? constants.bulk : constants.lame())
    {}

    template <typename Number>
    bool
    evaluate_any(const Material::BasicStep<Number> &step,
                 const bool                         with_tangent,
                 Material::BasicResponse<Number>   &response) const
    {
      dealii::SymmetricTensor<2, 3, Number> b_minus_1;
      const Number log_J    = measure(step.total, b_minus_1);
      const auto   unit     = dealii::unit_symmetric_tensor<3, Number>();
      const Number pressure = volumetric * log_J;
      const Number shear =
        decoupled ?
          constants.shear * each([](const double x) { return std::exp(x); },
                                 Number(-2. / 3. * log_J)) :
          Number(constants.shear);
      const dealii::SymmetricTensor<2, 3, Number> shape =
        shear * (decoupled ? dealii::deviator(b_minus_1) : b_minus_1);
      response.kirchhoff_stress = shape + pressure * unit;
      response.potential        = potential(b_minus_1, log_J);
      if (with_tangent && decoupled)
        {
          // eq. 21 times J, where the mu of 2 mu [...] is G tr(b) / (3 J^(2/3))
          const Number mu  = shear * (1. + dealii::trace(b_minus_1) / 3.);
          response.tangent = isotropic_tensor<Number>(volumetric - 2. / 3. * mu,
                                                      2. * (mu - pressure));
          // less 2/3 (shape x 1 + 1 x shape)
          for (unsigned int i = 0; i < 6; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              {
                const Number mixed = 2. / 3. * shape.access_raw_entry(i);
                response.tangent.access_raw_entry(6 * i + j) -= mixed;
                response.tangent.access_raw_entry(6 * j + i) -= mixed;
              }
        }
      else if (with_tangent)
        response.tangent =
          isotropic_tensor<Number>(volumetric, 2. * (shear - pressure));
      return all_of(is_finite(response.potential));
    }

    Material::Energy
    energy(const dealii::Tensor<2, 3> &F, const double *) const override
    {
      dealii::SymmetricTensor<2, 3> b_minus_1;
      const double                  log_J = measure(F, b_minus_1);
      return {potential(b_minus_1, log_J), 0.};
    }

  private:
    /** Sets F F^T - 1 and returns ln J; NaN where J <= 0, as all else then. */
    template <typename Number>
    static Number
    measure(const dealii::Tensor<2, 3, Number>    &F,
            dealii::SymmetricTensor<2, 3, Number> &b_minus_1)
    {
      // In terms of H = F - 1, so that small strains keep all of their digits.
      dealii::Tensor<2, 3, Number> H = F;
      for (unsigned int d = 0; d < 3; ++d)
        H[d][d] -= 1.;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          b_minus_1[i][j] = H[i][j] + H[j][i] + H[i] * H[j];

      const Number trace  = dealii::trace(H);
      const Number second = H[0][0] * H[1][1] - H[0][1] * H[1][0] +
                            H[1][1] * H[2][2] - H[1][2] * H[2][1] +
                            H[2][2] * H[0][0] - H[2][0] * H[0][2];
      const Number J_minus_1 = trace + second + dealii::determinant(H);
      const Number J         = dealii::determinant(F);
      using std::abs;
      return select(J > 0.,
                    select(abs(J_minus_1) < 0.5,
                           each([](const double x) { return std::log1p(x); },
                                J_minus_1),
                           each([](const double x) { return std::log(x); }, J)),
                    Number(std::numeric_limits<double>::quiet_NaN()));
    }

    /** psi (J/m^3). */
    template <typename Number>
    Number
    potential(const dealii::SymmetricTensor<2, 3, Number> &b_minus_1,
              const Number                                &log_J) const
    {
      const Number trace  = dealii::trace(b_minus_1);
      const Number shrink = // J^(-2/3) - 1
        each([](const double x) { return std::expm1(x); },
             Number(-2. / 3. * log_J));
      const Number shape = decoupled ? 3. * shrink + trace + shrink * trace :
                                       Number(trace - 2. * log_J);
      return 0.5 * constants.shear * shape + 0.5 * volumetric * log_J * log_J;
    }

    const ElasticConstants constants;
    const double           volumetric; ///< of (ln J)^2 / 2 (Pa)
  };
} // namespace impm

#endif
