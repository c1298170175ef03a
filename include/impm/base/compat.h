#ifndef impm_base_compat_h
#define impm_base_compat_h

#include <deal.II/base/config.h>
#include <deal.II/base/index_set.h>

#include <deal.II/lac/affine_constraints.h>

/** What deal.II 9.6 says otherwise than 9.4: nobody else asks for its version.
 */
namespace impm::compat
{
  inline dealii::AffineConstraints<double>
  make_constraints([[maybe_unused]] const dealii::IndexSet &owned,
                   const dealii::IndexSet                  &relevant)
  {
#if DEAL_II_VERSION_GTE(9, 6, 0)
    return dealii::AffineConstraints<double>(owned, relevant);
#else
    return dealii::AffineConstraints<double>(relevant);
#endif
  }

  /** How many directions GMRES takes before it starts again. */
  template <typename AdditionalData>
  void
  set_basis_size(AdditionalData &data, const unsigned int size)
  {
#if DEAL_II_VERSION_GTE(9, 6, 0)
    data.max_basis_size = size;
#else
    data.max_n_tmp_vectors = size + 2;
#endif
  }
} // namespace impm::compat

#endif
