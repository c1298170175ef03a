#ifndef impm_materials_elastic_constants_h
#define impm_materials_elastic_constants_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/symmetric_tensor.h>

#include <impm/input/parameter_file.h>

#include <string>
#include <utility>

namespace impm
{
  /** The constants of isotropic elasticity at small strains. */
  struct ElasticConstants
  {
    /** Young's modulus (Pa, > 0) and Poisson's ratio (-1 < nu < 0.5). */
    static ElasticConstants
    from_young(const double young, const double poisson)
    {
      return {young,
              young / (3. * (1. - 2. * poisson)),
              young / (2. * (1. + poisson))};
    }

    /** From the shear and the bulk modulus (Pa, > 0). */
    static ElasticConstants
    from_moduli(const double shear, const double bulk)
    {
      return {9. * bulk * shear / (3. * bulk + shear), bulk, shear};
    }

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      prm.declare_entry("Young's modulus",
                        "1e9",
                        dealii::Patterns::Double(1e-300),
                        "Young's modulus of small strains (Pa), positive; to "
                        "be given.");
      // The ends are excluded by a margin that error messages can show.
      prm.declare_entry("Poisson's ratio",
                        "0.3",
                        dealii::Patterns::Double(-0.9999, 0.499999),
                        "Poisson's ratio of small strains, between -1 and 0.5, "
                        "both excluded; to be given.");
    }

    static ElasticConstants
    from_parameters(dealii::ParameterHandler &prm)
    {
      return from_young(prm.get_double("Young's modulus"),
                        prm.get_double("Poisson's ratio"));
    }

    /** Lame's first constant (Pa). */
    double
    lame() const
    {
      return bulk - 2. / 3. * shear;
    }

    /** K + 4/3 G (Pa): that of longitudinal waves. */
    double
    longitudinal_modulus() const
    {
      return bulk + 4. / 3. * shear;
    }

    double young; ///< Pa
    double bulk;  ///< K (Pa)
    double shear; ///< G (Pa)
  };

  /** volumetric 1 x 1 + shear times the symmetric identity. */
  template <typename Number>
  dealii::SymmetricTensor<4, 3, Number>
  isotropic_tensor(const Number &volumetric, const Number &shear)
  {
    // by its stored entries: products of tensors would go through all 81
    dealii::SymmetricTensor<4, 3, Number> result;
    for (unsigned int i = 0; i < 3; ++i)
      {
        for (unsigned int j = 0; j < 3; ++j)
          result.access_raw_entry(6 * i + j) = volumetric;
        result.access_raw_entry(7 * i) += shear;
        result.access_raw_entry(7 * (i + 3)) = 0.5 * shear;
      }
    return result;
  }

  /** Elastic constants of which a scene chooses the pair that it gives. */
  struct ElasticPair
  {
    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &chosen)
    {
      const std::string moduli = "shear and bulk modulus";
      prm.declare_entry("Constants from",
                        engineering,
                        dealii::Patterns::Selection(engineering +
                                                    ("|" + moduli)),
                        "Which pair of elastic constants is given.");
      const std::string pair = chosen("Constants from", engineering);
      if (pair != moduli)
        ElasticConstants::declare_parameters(prm, chosen);
      else
        for (const auto &[name, value] :
             {std::make_pair("Shear modulus", "4e8"),
              std::make_pair("Bulk modulus", "1e9")})
          prm.declare_entry(name,
                            value,
                            dealii::Patterns::Double(1e-300),
                            "Of small strains (Pa), positive; to be given.");
    }

    static ElasticConstants
    from_parameters(dealii::ParameterHandler &prm)
    {
      if (prm.get("Constants from") == engineering)
        return ElasticConstants::from_parameters(prm);
      return ElasticConstants::from_moduli(prm.get_double("Shear modulus"),
                                           prm.get_double("Bulk modulus"));
    }

  private:
    static constexpr const char *engineering =
      "Young's modulus and Poisson's ratio";
  };
} // namespace impm

#endif
