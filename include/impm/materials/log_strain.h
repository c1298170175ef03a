#ifndef impm_materials_log_strain_h
#define impm_materials_log_strain_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/base/lanes.h>

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
  template <typename Number>
  using Triple = std::array<Number, 3>;

  /** Spectral form of a left Cauchy-Green tensor. */
  template <typename Number>
  struct PrincipalStrains
  {
    Triple<Number>                       strain; ///< eps_a, unordered (-)
    Triple<dealii::Tensor<1, 3, Number>> axis;   ///< n_a, orthonormal
    bool                                 planar; ///< n_2 = e_z exactly
  };

  /** What a law makes of the three strains. */
  template <typename Number>
  struct PrincipalStress
  {
    Triple<Number> stress; ///< tau_a (Pa)

    /** D_ab = d tau_a / d eps_b (Pa), symmetric or not. */
    Triple<Triple<Number>> moduli;

    /**
     * (tau_a - tau_b) / (eps_a - eps_b) for ab = 01, 02, 12 (Pa), with its
     * limit D_aa - D_ab where the strains meet. The law knows the quotient
     * in closed form, so that no digit is lost near the limit. With
     * plasticity eps is the trial strain, here as in D.
     */
    Triple<Number> secant;
  };

  // Here as everywhere: of one point, or of one in each lane.

  /**
   * Decomposes a left Cauchy-Green tensor (-). Returns false when it is not
   * positive definite or not finite.
   */
  template <typename Number>
  bool
  decompose(const dealii::SymmetricTensor<2, 3, Number> &left_cauchy_green,
            PrincipalStrains<Number>                    &principal);

  /** The tensor sum_a values_a n_a x n_a. */
  template <typename Number>
  dealii::SymmetricTensor<2, 3, Number>
  compose(const Triple<Number>           &values,
          const PrincipalStrains<Number> &principal);

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
  template <typename Number>
  void
  lie_tangent(const PrincipalStrains<Number>        &principal,
              const PrincipalStress<Number>         &response,
              dealii::SymmetricTensor<4, 3, Number> &tangent);
} // namespace impm::LogStrain

#endif
