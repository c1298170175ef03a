#ifndef impm_materials_pointwise_law_h
#define impm_materials_pointwise_law_h

#include <impm/materials/material.h>

namespace impm
{
  /**
   * A law that evaluates one point after the other, with its own
   *
   *   bool evaluate_point(const Step &, bool with_tangent, Response &) const,
   *
   * which is not virtual: one virtual call is made for a batch.
   */
  template <typename Law, typename Base = Material>
  class PointwiseLaw : public Base
  {
  public:
    using Base::Base;

    bool
    evaluate(const Material::Batch &batch,
             const bool             with_tangent,
             Material::Response    *responses) const final
    {
      const auto &law = static_cast<const Law &>(*this);
      for (unsigned int p = 0; p < batch.n_points; ++p)
        if (!law.evaluate_point(batch.step(p), with_tangent, responses[p]))
          return false;
      return true;
    }
  };
} // namespace impm

#endif
