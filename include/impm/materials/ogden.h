#ifndef impm_materials_ogden_h
#define impm_materials_ogden_h

#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/number_list.h>

#include <cmath>
#include <limits>
#include <vector>

namespace impm
{
  /**
   * Rubber by powers of the isochoric principal stretches
   * lb_a = J^(-1/3) lambda_a (R. W. Ogden, Proc. R. Soc. Lond. A 326 (1972)
   * 565-584), with a decoupled change of volume. Per initial volume:
   *
   *   psi   = sum_p mu_p / alpha_p (sum_a lb_a^alpha_p - 3) + K / 2 (ln J)^2,
   *   tau_a = sum_p mu_p (lb_a^alpha_p - mean_b lb_b^alpha_p) + K ln J.
   *
   * All mu_p alpha_p are positive, and with them the shear modulus of small
   * strains, sum_p mu_p alpha_p / 2. Keeps no history.
   */
  class Ogden final : public LawInLanes<Ogden>
  {
  public:
    struct Term
    {
      double modulus;  ///< mu (Pa)
      double exponent; ///< alpha (-); mu alpha > 0
    };

    struct Parameters
    {
      static void
      declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
      {
        declare_number_list(prm,
                            "Ogden moduli",
                            "0.63e6, 0.0012e6, -0.01e6",
                            dealii::Patterns::Double(),
                            "mu of each term (Pa), of the sign of its "
                            "exponent. By default Ogden's for Treloar's "
                            "rubber.");
        declare_number_list(prm,
                            "Ogden exponents",
                            "1.3, 5, -2",
                            dealii::Patterns::Double(),
                            "alpha of each term: the shear modulus of small "
                            "strains is half of the sum of mu alpha.");
        declare_bulk_modulus(prm);
      }

      static Parameters
      from_parameters(dealii::ParameterHandler &prm)
      {
        const std::string moduli    = "Ogden moduli",
                          exponents = "Ogden exponents";
        require_same_length(prm, moduli, exponents);
        const auto mu    = number_list(prm, moduli),
                   alpha = number_list(prm, exponents);
        if (mu.empty())
          throw InputError(moduli,
                           "found nothing, allowed is one term or more");
        Parameters result{{}, prm.get_double("Bulk modulus")};
        for (unsigned int p = 0; p < mu.size(); ++p)
          {
            if (!(mu[p] * alpha[p] > 0))
              throw InputError(
                exponents,
                "found '" + prm.get(exponents) + "' with '" + moduli +
                  "' = " + prm.get(moduli) +
                  ", allowed are exponents with the sign of their modulus, "
                  "neither of them 0, or the shear modulus of small strains "
                  "may not be positive");
            result.terms.push_back({mu[p], alpha[p]});
          }
        return result;
      }

      static void
      declare_bulk_modulus(dealii::ParameterHandler &prm)
      {
        prm.declare_entry("Bulk modulus",
                          "1e9",
                          dealii::Patterns::Double(1e-300),
                          "Pressure over logarithmic change of volume (Pa), "
                          "positive; to be given.");
      }

      /** Of small strains. */
      ElasticConstants
      constants() const
      {
        double shear = 0;
        for (const auto &[modulus, exponent] : terms)
          shear += 0.5 * modulus * exponent;
        return ElasticConstants::from_moduli(shear, bulk);
      }

      std::vector<Term> terms;
      double            bulk; ///< K (Pa, > 0)
    };

    Ogden(const MaterialSpec &spec, PointLayout &, const Parameters &parameters)
      : LawInLanes(spec,
                   parameters.constants().young,
                   parameters.constants().longitudinal_modulus())
      , parameters(parameters)
    {}

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 const bool               with_tangent,
                 BasicResponse<Number>   &response) const
    {
      return evaluate_elastic(step,
                              with_tangent,
                              response,
                              [&](const auto &strain, auto &stress) {
                                return respond(strain, with_tangent, stress);
                              });
    }

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double *) const override
    {
      LogStrain::PrincipalStrains<double> principal;
      LogStrain::PrincipalStress<double>  unused;
      if (!LogStrain::decompose(dealii::Physics::Elasticity::Kinematics::b(
                                  deformation_gradient),
                                principal))
        return {std::numeric_limits<double>::quiet_NaN(), 0.};
      return {respond(principal.strain, false, unused), 0.};
    }

  private:
    /** Returns psi (J/m^3) of principal strains; moduli and secants of the
     * stress only when asked for. */
    template <typename Number>
    Number
    respond(const LogStrain::Triple<Number>    &strain,
            const bool                          with_tangent,
            LogStrain::PrincipalStress<Number> &result) const
    {
      const auto exp   = [](const double x) { return std::exp(x); };
      const auto expm1 = [](const double x) { return std::expm1(x); };
      const auto sinhc = [](const double x) {
        return x == 0 ? 1. : std::sinh(x) / x;
      };
      const Number log_J    = strain[0] + strain[1] + strain[2];
      const Number pressure = parameters.bulk * log_J;
      result.stress.fill(pressure);
      result.secant.fill(Number(0.));
      for (auto &row : result.moduli)
        row.fill(Number(parameters.bulk));
      Number potential = 0.5 * pressure * log_J;
      for (const auto &[modulus, exponent] : parameters.terms)
        {
          // lb^alpha - 1, so that small strains keep their digits
          LogStrain::Triple<Number> change;
          for (unsigned int a = 0; a < 3; ++a)
            change[a] =
              each(expm1, Number(exponent * (strain[a] - log_J / 3.)));
          const Number sum = change[0] + change[1] + change[2];
          potential += modulus / exponent * sum;
          for (unsigned int a = 0; a < 3; ++a)
            result.stress[a] += modulus * (change[a] - sum / 3.);
          if (!with_tangent)
            continue;
          const double stiffness = modulus * exponent;
          for (unsigned int a = 0; a < 3; ++a)
            {
              for (unsigned int b = 0; b < 3; ++b)
                result.moduli[a][b] +=
                  stiffness *
                  (sum / 9. - (change[a] + change[b]) / 3. - 1. / 3.);
              result.moduli[a][a] += stiffness * (1. + change[a]);
            }
          // lb_a^alpha - lb_b^alpha by its mean exponent, which is minus half
          // of the third: their sum is 0
          for (unsigned int a = 0; a < 2; ++a)
            for (unsigned int b = a + 1; b < 3; ++b)
              result.secant[a + b - 1] +=
                stiffness *
                each(exp,
                     Number(-0.5 * exponent *
                            (strain[3 - a - b] - log_J / 3.))) *
                each(sinhc, Number(0.5 * exponent * (strain[a] - strain[b])));
        }
      return potential;
    }

    const Parameters parameters;
  };

  /**
   * The entries of M. Mooney and R. S. Rivlin's rubber, which is Ogden's with
   * the exponents 2 and -2 (J. Appl. Phys. 11 (1940) 582-592; Phil. Trans. R.
   * Soc. Lond. A 241 (1948) 379-397):
   *
   *   psi = C10 (tr bb - 3) + C01 (tr bb^-1 - 3) + K / 2 (ln J)^2,
   *   bb  = J^(-2/3) b.
   */
  struct MooneyRivlin
  {
    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      prm.declare_entry("C10",
                        "2e5",
                        dealii::Patterns::Double(0.),
                        "Energy per squared stretch (Pa), not negative. Twice "
                        "the sum with C01 is the shear modulus of small "
                        "strains; to be given.");
      prm.declare_entry("C01",
                        "5e4",
                        dealii::Patterns::Double(0.),
                        "Energy per inverse squared stretch (Pa), not "
                        "negative; to be given.");
      Ogden::Parameters::declare_bulk_modulus(prm);
    }

    static Ogden::Parameters
    from_parameters(dealii::ParameterHandler &prm)
    {
      const double C10 = prm.get_double("C10"), C01 = prm.get_double("C01");
      if (!(C10 + C01 > 0))
        throw InputError("C10",
                         "found '" + prm.get("C10") +
                           "', allowed is more than 0 where 'C01' is 0, or "
                           "nothing would resist shear");
      return from_constants(C10, C01, prm.get_double("Bulk modulus"));
    }

    /** All in Pa. A constant that is 0 has no term. */
    static Ogden::Parameters
    from_constants(const double C10, const double C01, const double bulk)
    {
      Ogden::Parameters result{{}, bulk};
      if (C10 > 0)
        result.terms.push_back({2. * C10, 2.});
      if (C01 > 0)
        result.terms.push_back({-2. * C01, -2.});
      return result;
    }
  };
} // namespace impm

#endif
