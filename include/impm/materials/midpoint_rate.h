#ifndef impm_materials_midpoint_rate_h
#define impm_materials_midpoint_rate_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace impm
{
  /**
   * Strain and spin of a step by the midpoint rule of Hughes & Winget (IJNME
   * 15, 1980, 1862-1867): the gradient of the increment by the places half
   * way,
   *
   *   h = g (1 + g/2)^-1, g = dF - 1,   strain = sym h,   w = skew h,
   *   Q = (1 - w/2)^-1 (1 + w/2).
   *
   * A rigid rotation has no strain and is Q itself.
   */
  struct MidpointRate
  {
    /** Returns false when the step turns inside out or has no middle. */
    bool
    measure(const dealii::Tensor<2, 3> &increment)
    {
      const dealii::Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();
      const auto                 g    = increment - unit;
      const auto                 half = unit + 0.5 * g;
      if (!(dealii::determinant(increment) > 0) ||
          !(dealii::determinant(half) > 0))
        return false;
      inverse      = dealii::invert(half);
      const auto h = g * inverse;
      const auto w = skew(h);
      strain       = dealii::symmetrize(h);
      spin_inverse = dealii::invert(unit - 0.5 * w);
      rotation     = spin_inverse * (unit + 0.5 * w);
      return true;
    }

    /**
     * Material::Response::full_tangent. `change(d strain, dQ, stretches)` gives
     * the change of the Kirchhoff stress where dF becomes dF + L dF, for each
     * L = e_k x e_l; whether L stretches tells that J grows by tr L = 1.
     */
    template <typename Change>
    dealii::Tensor<4, 3>
    tangent(const dealii::Tensor<2, 3> &increment, const Change &change) const
    {
      dealii::Tensor<4, 3> result;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l)
          {
            dealii::Tensor<2, 3> L;
            L[k][l]             = 1;
            const auto h_change = inverse * L * increment * inverse;
            const dealii::SymmetricTensor<2, 3> stress =
              change(dealii::symmetrize(h_change),
                     spin_inverse * skew(h_change) * spin_inverse,
                     k == l);
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                result[i][j][k][l] = stress[i][j];
          }
      return result;
    }

    dealii::SymmetricTensor<2, 3> strain;
    dealii::Tensor<2, 3>          rotation;

  private:
    static dealii::Tensor<2, 3>
    skew(const dealii::Tensor<2, 3> &t)
    {
      return 0.5 * (t - dealii::transpose(t));
    }

    dealii::Tensor<2, 3> inverse, spin_inverse;
  };
} // namespace impm

#endif
