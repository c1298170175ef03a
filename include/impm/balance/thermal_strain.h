#ifndef impm_balance_thermal_strain_h
#define impm_balance_thermal_strain_h

#include <impm/balance/point_batch.h>
#include <impm/points/material_points.h>

#include <vector>

namespace impm
{
  /**
   * The strain theta = expansion * (T - T_free) by which each point would
   * expand freely, at both ends of a step. A law knows nothing of it: it is
   * asked for what is left of the deformation,
   *
   *   F_e = exp(-theta) F,   dF_e = exp(theta_n - theta_{n+1}) dF,
   *
   * laws of small strains about t_n for dF_e = dF - (theta_{n+1} - theta_n) 1.
   * Theta does not change with dF, so stress and tangent are those of the law:
   * tau derives from the energy of F_e by F, c and a are relative to dF.
   *
   * Prescribed temperatures are those of the end of the step, all others those
   * that the step before has left: what it has dissipated and conducted. The
   * state of a point is that of the temperature that its last step has seen,
   * which is why it keeps theta; it begins with 0, without stress.
   */
  template <int dim>
  class ThermalStrain
  {
  public:
    /**
     * For a step that ends at a time. Temperature and strain of the end are
     * written to the histories that points will have then. Throws
     * ComputationError, on every rank alike, for a prescribed temperature that
     * is no finite number. Collective.
     */
    ThermalStrain(const MaterialPoints<dim> &points,
                  double                     end_time,
                  std::vector<double>       &trial_histories);

    /** Whether any material expands. */
    bool
    exists() const
    {
      return !end.empty();
    }

    /** Theta at the end of the step less that at its start; while the start is
     * evaluated, zero. */
    Lanes
    change(const PointBatch &batch) const
    {
      return batch.gather(
        [&](const unsigned int p) { return is_at_start ? 0. : change(p); });
    }

    double
    change(const unsigned int point) const
    {
      return end[point] - start[point];
    }

    /** Takes it out of what the law is asked for: of dF and of F at t_n. */
    void
    take_out(const PointBatch            &batch,
             Material::Form               form,
             dealii::Tensor<2, 3, Lanes> &increment,
             dealii::Tensor<2, 3, Lanes> &F) const;

    /** The other way for a stretch of the step that plane stress has found. */
    Lanes
    put_back(const PointBatch &batch,
             Material::Form    form,
             const Lanes      &stretch) const;

    /** While true, the temperature is still that of the state at t_n. */
    bool is_at_start = false;

  private:
    std::vector<double> start, end; ///< by point, or empty
  };
} // namespace impm

#endif
