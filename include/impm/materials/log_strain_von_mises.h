#ifndef impm_materials_log_strain_von_mises_h
#define impm_materials_log_strain_von_mises_h

#include <deal.II/base/parameter_handler.h>

#include <impm/materials/log_strain_elastic.h>

#include <array>
#include <memory>

namespace impm
{
  /**
   * Multiplicative von Mises plasticity: Hencky's elasticity below the yield
   * limit
   *
   *   q = sqrt(3/2) |dev tau| <= sigma_y + H alpha
   *
   * with associated, isochoric flow and alpha the equivalent plastic strain.
   * In principal logarithmic strains the exponential map makes the return
   * mapping that of small strains (Simo 1992, see log_strain.h), closed form
   * with linear hardening. A step minimizes over alpha the potential
   *
   *   W = psi(eps_e) + sigma_y alpha + H / 2 alpha^2,
   *
   * whose derivative by the trial strains is tau, so that D is symmetric.
   *
   * History: "elastic_left_cauchy_green" b_e (-) and
   * "equivalent_plastic_strain" alpha (-).
   */
  class LogStrainVonMises final : public PointwiseLaw<LogStrainVonMises>
  {
  public:
    /**
     * Yield stress sigma_y (Pa, > 0) and slope H >= 0 (Pa) of the yield
     * stress over the equivalent plastic strain.
     */
    LogStrainVonMises(const MaterialSpec     &spec,
                      PointLayout            &history,
                      const HenckyElasticity &elasticity,
                      double                  yield_stress,
                      double                  hardening);

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    static std::unique_ptr<const Material>
    create(dealii::ParameterHandler &prm,
           const MaterialSpec       &spec,
           PointLayout              &history);

    void
    initialize_history(double *history) const override;

    bool
    evaluate_point(const Step &step,
                   bool        with_tangent,
                   Response   &response) const;

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const override;

  private:
    /** Plastic work sigma_y alpha + H / 2 alpha^2 (J/m^3). */
    double
    plastic_work(double equivalent_plastic_strain) const;

    const HenckyElasticity elasticity;
    const double           yield_stress, hardening;
    const PointLayout      storage; ///< knows how tensors are stored
    const unsigned int     elastic_offset, plastic_offset;
  };
} // namespace impm

#endif
