#include <deal.II/base/patterns.h>

#include <impm/materials/elastic_constants.h>

namespace impm
{
  namespace
  {
    const std::string engineering = "Young's modulus and Poisson's ratio";
    const std::string moduli      = "shear and bulk modulus";
  } // namespace


  ElasticConstants::ElasticConstants(const double young, const double poisson)
    : ElasticConstants(young,
                       young / (3. * (1. - 2. * poisson)),
                       young / (2. * (1. + poisson)))
  {}


  ElasticConstants::ElasticConstants(const double young,
                                     const double bulk,
                                     const double shear)
    : young(young)
    , bulk(bulk)
    , shear(shear)
  {}


  ElasticConstants
  ElasticConstants::from_moduli(const double shear, const double bulk)
  {
    return ElasticConstants(9. * bulk * shear / (3. * bulk + shear),
                            bulk,
                            shear);
  }


  void
  ElasticConstants::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Young's modulus",
                      "1e9",
                      dealii::Patterns::Double(1e-300),
                      "Young's modulus of small strains (Pa), positive.");

    // The ends are excluded by a margin that error messages can show.
    prm.declare_entry("Poisson's ratio",
                      "0.3",
                      dealii::Patterns::Double(-0.9999, 0.499999),
                      "Poisson's ratio of small strains, between -1 and 0.5, "
                      "both excluded.");
  }


  void
  ElasticConstants::declare_choice(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Constants from",
                      engineering,
                      dealii::Patterns::Selection(engineering + "|" + moduli),
                      "Which pair of elastic constants is given.");
  }


  void
  ElasticConstants::declare_chosen(dealii::ParameterHandler    &prm,
                                   const ParameterFile::Chosen &chosen)
  {
    // it may be "any"
    const std::string pair = chosen("Constants from", engineering);
    if (pair != moduli)
      declare_parameters(prm);
    if (pair != engineering)
      {
        prm.declare_entry("Shear modulus",
                          "4e8",
                          dealii::Patterns::Double(1e-300),
                          "Of small strains (Pa), positive.");
        prm.declare_entry("Bulk modulus",
                          "1e9",
                          dealii::Patterns::Double(1e-300),
                          "Of small strains (Pa), positive.");
      }
  }


  ElasticConstants
  ElasticConstants::from_parameters(dealii::ParameterHandler &prm)
  {
    return ElasticConstants(prm.get_double("Young's modulus"),
                            prm.get_double("Poisson's ratio"));
  }


  ElasticConstants
  ElasticConstants::from_choice(dealii::ParameterHandler &prm)
  {
    return prm.get("Constants from") == engineering ?
             from_parameters(prm) :
             from_moduli(prm.get_double("Shear modulus"),
                         prm.get_double("Bulk modulus"));
  }
} // namespace impm
