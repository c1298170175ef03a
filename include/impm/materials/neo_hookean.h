#ifndef impm_materials_neo_hookean_h
#define impm_materials_neo_hookean_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/pointwise_law.h>

#include <memory>

namespace impm
{
  /**
   * Two laws whose energy is a function of tr b and J, with the constants of
   * small strains and no history. The most common one couples shape and
   * volume,
   *
   *   psi = G / 2 (tr b - 3 - 2 ln J) + lambda / 2 (ln J)^2,
   *   tau = G (b - 1) + lambda ln J 1;
   *
   * decoupled (Guilkey & Weiss 2003, eq. 20) the change of shape stands apart
   * from that of volume,
   *
   *   psi = G / 2 (J^(-2/3) tr b - 3) + K / 2 (ln J)^2,
   *   tau = G J^(-2/3) dev b + K ln J 1.
   */
  template <bool decoupled>
  class NeoHookean final : public PointwiseLaw<NeoHookean<decoupled>>
  {
  public:
    NeoHookean(const MaterialSpec &spec, const ElasticConstants &constants);

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<const Material>
    create(dealii::ParameterHandler &prm,
           const MaterialSpec       &spec,
           PointLayout              &history);

    bool
    evaluate_point(const Material::Step &step,
                   bool                  with_tangent,
                   Material::Response   &response) const;

    Material::Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

  private:
    struct Strain
    {
      dealii::SymmetricTensor<2, 3> b_minus_1; ///< F F^T - 1
      double                        log_J;
    };

    /** Returns false where J <= 0. */
    static bool
    measure(const dealii::Tensor<2, 3> &F, Strain &strain);

    /** psi (J/m^3). */
    double
    potential(const Strain &strain) const;

    const ElasticConstants constants;
  };

  using CoupledNeoHookean   = NeoHookean<false>;
  using DecoupledNeoHookean = NeoHookean<true>;
} // namespace impm

#endif
