#ifndef impm_materials_elastic_constants_h
#define impm_materials_elastic_constants_h

#include <deal.II/base/parameter_handler.h>

#include <impm/input/parameter_file.h>

namespace impm
{
  /** The constants of isotropic elasticity at small strains. */
  struct ElasticConstants
  {
    /** Young's modulus (Pa, > 0) and Poisson's ratio (-1 < nu < 0.5). */
    ElasticConstants(double young, double poisson);

    /** From the shear and the bulk modulus (Pa, > 0). */
    static ElasticConstants
    from_moduli(double shear, double bulk);

    /** The entries of Young's modulus and Poisson's ratio. */
    static void
    declare_parameters(dealii::ParameterHandler &prm);

    /** The choice of a pair of constants. */
    static void
    declare_choice(dealii::ParameterHandler &prm);

    /** The entries of the pair that is chosen. */
    static void
    declare_chosen(dealii::ParameterHandler    &prm,
                   const ParameterFile::Chosen &chosen);

    /** Reads the pair that was declared. */
    static ElasticConstants
    from_parameters(dealii::ParameterHandler &prm);

    /** As from_parameters, after declare_choice and declare_chosen. */
    static ElasticConstants
    from_choice(dealii::ParameterHandler &prm);

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

    const double young; ///< Pa
    const double bulk;  ///< K (Pa)
    const double shear; ///< G (Pa)

  private:
    ElasticConstants(double young, double bulk, double shear);
  };
} // namespace impm

#endif
