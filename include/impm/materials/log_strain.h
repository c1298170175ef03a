#ifndef impm_materials_log_strain_h
#define impm_materials_log_strain_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>

/**
 * What isotropic laws in principal logarithmic strains share: such a law is
 * a function from three strains to three stresses, and everything that has
 * to do with axes is done here.
 *
 * With b = sum_a b_a n_a x n_a the (trial elastic) left Cauchy-Green tensor
 * and eps_a = ln(b_a) / 2, see J. C. Simo, "Algorithms for static and
 * dynamic multiplicative plasticity that preserve the classical return
 * mapping schemes of the infinitesimal theory", CMAME 99 (1992) 61-112.
 */
namespace impm::LogStrain
{
  /** Spectral form of a left Cauchy-Green tensor. */
  struct PrincipalStrains
  {
    std::array<double, 3>               strain; ///< eps_a, unordered (-)
    std::array<dealii::Tensor<1, 3>, 3> axis;   ///< n_a, orthonormal
    bool                                planar; ///< n_2 = e_z exactly
  };

  /** What a law makes of the three strains. */
  struct PrincipalStress
  {
    std::array<double, 3> stress; ///< tau_a (Pa)

    /** D_ab = d tau_a / d eps_b (Pa), symmetric or not. */
    std::array<std::array<double, 3>, 3> moduli;

    /**
     * (tau_a - tau_b) / (eps_a - eps_b) for ab = 01, 02, 12 (Pa), with its
     * limit D_aa - D_ab where the strains meet. The law knows the quotient
     * in closed form, so that no digit is lost near the limit. With
     * plasticity eps is the trial strain, here as in D.
     */
    std::array<double, 3> secant;
  };

  /**
   * Decomposes a left Cauchy-Green tensor (-). Returns false when it is not
   * positive definite or not finite.
   */
  bool
  decompose(const dealii::SymmetricTensor<2, 3> &left_cauchy_green,
            PrincipalStrains                    &principal);

  /** The tensor sum_a values_a n_a x n_a. */
  dealii::SymmetricTensor<2, 3>
  compose(const std::array<double, 3> &values,
          const PrincipalStrains      &principal);

  /**
   * The tangent of Material::Response, from the principal (trial) strains
   * and the response of the law to them:
   *
   *   c = sum_ab (D_ab - 2 tau_a delta_ab) n_a n_a n_b n_b
   *       + sum_{a<b} g_ab / 2 (n_a n_b + n_b n_a) x (n_a n_b + n_b n_a),
   *   g_ab = (tau_a - tau_b) coth(eps_a - eps_b) - (tau_a + tau_b).
   *
   * The first sum is how stresses follow strains along fixed axes, the
   * second how the axes turn; g is the usual
   * 2 (tau_a b_b - tau_b b_a) / (b_a - b_b).
   */
  void
  lie_tangent(const PrincipalStrains        &principal,
              const PrincipalStress         &response,
              dealii::SymmetricTensor<4, 3> &tangent);
} // namespace impm::LogStrain

#endif
