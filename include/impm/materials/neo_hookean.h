#ifndef impm_materials_neo_hookean_h
#define impm_materials_neo_hookean_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/material.h>

#include <memory>

namespace impm
{
  /**
   * What the neo-Hookean laws share: the energy is a function of tr b and J,
   * the constants are those of small strains, and there is no history.
   */
  class NeoHookean : public Material
  {
  public:
    NeoHookean(const ElasticConstants &constants, double density);

    void
    declare_history(PointLayout &layout) override;

    void
    initialize_history(double *history) const override;

    bool
    evaluate(const Deformation &deformation,
             const double      *history,
             double            *trial_history,
             bool               with_tangent,
             Response          &response) const override;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

    double
    stiffness() const override;

    double
    wave_speed() const override;

  protected:
    struct Strain
    {
      dealii::SymmetricTensor<2, 3> b_minus_1; ///< F F^T - 1
      double                        log_J;
    };

    /** psi (J/m^3). */
    virtual double
    potential(const Strain &strain) const = 0;

    /** Fills in tau and, when asked for, c. */
    virtual void
    respond(const Strain &strain,
            bool          with_tangent,
            Response     &response) const = 0;

    const ElasticConstants constants;

  private:
    /** Returns false where J <= 0. */
    static bool
    measure(const dealii::Tensor<2, 3> &F, Strain &strain);
  };


  /**
   * The most common neo-Hookean law,
   *
   *   psi = G / 2 (tr b - 3 - 2 ln J) + lambda / 2 (ln J)^2,
   *   tau = G (b - 1) + lambda ln J 1,
   *
   * which couples shape and volume.
   */
  class CoupledNeoHookean final : public NeoHookean
  {
  public:
    using NeoHookean::NeoHookean;

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<Material>
    create(dealii::ParameterHandler &prm);

  protected:
    double
    potential(const Strain &strain) const override;

    void
    respond(const Strain &strain,
            bool          with_tangent,
            Response     &response) const override;
  };


  /**
   * Guilkey & Weiss (2003), eq. 20: the change of shape apart from that of
   * volume,
   *
   *   psi = G / 2 (J^(-2/3) tr b - 3) + K / 2 (ln J)^2,
   *   tau = G J^(-2/3) dev b + K ln J 1.
   */
  class DecoupledNeoHookean final : public NeoHookean
  {
  public:
    using NeoHookean::NeoHookean;

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<Material>
    create(dealii::ParameterHandler &prm);

  protected:
    double
    potential(const Strain &strain) const override;

    void
    respond(const Strain &strain,
            bool          with_tangent,
            Response     &response) const override;
  };
} // namespace impm

#endif
