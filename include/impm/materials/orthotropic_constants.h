#ifndef impm_materials_orthotropic_constants_h
#define impm_materials_orthotropic_constants_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/input/parameter_file.h>
#include <impm/points/point_layout.h>

#include <array>

namespace impm
{
  /**
   * Orthotropic elasticity of small strains and the axes of the material in
   * the initial configuration. A stress along axis i stretches by sigma / E_i
   * and shrinks along j by nu_ij of that, so that nu_ij / E_i = nu_ji / E_j.
   */
  struct OrthotropicConstants
  {
    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &);

    /** Throws InputError where the stiffness is not positive definite, or two
     * axes are parallel. */
    static OrthotropicConstants
    from_parameters(dealii::ParameterHandler &prm);

    /**
     * Throws InputError for axes that a geometry in the plane does not allow:
     * one has to be perpendicular to it, with axisymmetry all along r, z and
     * the circumference.
     */
    void
    check_axes(GeometryKind geometry) const;

    /** That of the fastest waves (Pa), rho c^2, over all directions. */
    double
    longitudinal_modulus() const;

    std::array<double, 3> young; ///< E_1, E_2, E_3 (Pa)
    /** sigma_ii over eps_jj (Pa), symmetric. */
    dealii::Tensor<2, 3>  stiffness;
    std::array<double, 3> shear; ///< G_12, G_13, G_23 (Pa)
    dealii::Tensor<2, 3>  axes;  ///< in columns, right-handed, orthonormal
  };
} // namespace impm

#endif
