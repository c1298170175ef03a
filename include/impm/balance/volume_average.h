#ifndef impm_balance_volume_average_h
#define impm_balance_volume_average_h

#include <impm/balance/kinematics.h>
#include <impm/balance/point_batch.h>
#include <impm/base/memory.h>
#include <impm/points/material_points.h>

#include <functional>
#include <vector>

namespace impm
{
  /**
   * F-bar: the points of a body that lie in one cell share the change of
   * volume of that cell,
   *
   *   dF_bar = (theta / dJ)^(1/n) dF,
   *   theta  = sum_p v_p dJ_p / sum_p v_p,   v_p = V0_p J_p at t_n,
   *
   * so that constant pressure can be had from linear displacements (de Souza
   * Neto et al. 1996). Stresses are those of the virtual work of tau(dF_bar) on
   * variations of dF_bar, which is that of the energy where there is one: they
   * couple nothing beyond the cell. n is 2 in plane strain, else 3; with
   * m_p = (v_p dJ_p / sum v dJ) dF_p^-T,
   *
   *   s_g = d ln theta = sum_p m_p . g_p for gradients g of a variation,
   *   d (d W)(h) = sum_p (h . A_p g + (b_p . h) s_g + (b'_p . g) s_h +
   *                       c_p s_g s_h),
   *
   * where b' = b if the tangent of the law is symmetric.
   */
  template <int dim>
  class VolumeAverage
  {
  public:
    /** Groups the points as they are. */
    VolumeAverage(const MaterialPoints<dim> &points,
                  const Kinematics<dim>     &kinematics);

    /** Whether a point takes part. */
    bool
    includes(const unsigned int point) const
    {
      return !groups.empty() &&
             groups[point] != dealii::numbers::invalid_unsigned_int;
    }

    /**
     * Takes the gradients at all points. Returns false when some dJ is not
     * positive. What belongs to the tangent stays, here and below, until it
     * is wanted anew.
     */
    bool
    measure(const std::vector<double> &gradients, bool with_tangent);

    /** (theta / dJ)^(1/n) at a point. */
    double
    factor(unsigned int point) const;

    /** dF_bar from dF. */
    template <typename Number>
    void
    dilate(const Number &factor, dealii::Tensor<2, 3, Number> &dF) const
    {
      for (unsigned int i = 0; i < kinematics.n_dilating; ++i)
        for (unsigned int j = 0; j < kinematics.n_dilating; ++j)
          dF[i][j] *= factor;
    }

    /**
     * Takes the responses of the law to dF_bar at points and takes their mean
     * pressures out of them. With a tangent, `matrix` comes as the spatial one
     * and goes as A_p without what depends on the others.
     */
    void
    take_out_pressure(const PointBatch                  &batch,
                      const Lanes                       &volume,
                      const dealii::Tensor<2, 3, Lanes> &inverse,
                      Material::Responses               &response,
                      Lanes                             *matrix);

    /** Points, and what is added to their stresses and tangents. */
    using AddShare = std::function<
      void(const PointBatch &,
           const typename Kinematics<dim>::template List<Lanes> &,
           const typename Kinematics<dim>::template Matrix<Lanes> &)>;

    /** Gives all points their share of the mean pressure of their cell. */
    void
    share_pressure(const std::vector<double> &gradients,
                   bool                       with_tangent,
                   const AddShare            &add);

    /** Adds what couples the points to A g. */
    void
    apply_coupling(const std::vector<double> &gradient_changes,
                   std::vector<double>       &stress_changes) const;

    /** (bytes) */
    std::size_t
    memory_consumption() const
    {
      return bytes_of(
        groups, mean, coupling, left_coupling, square, start_volume, jacobian);
    }

    /** By point: the number of its group, or an invalid one; empty if none. */
    std::vector<unsigned int> groups;

    /** m_p and b_p, with the size of a gradient for each point. */
    std::vector<double> mean, coupling;
    std::vector<double> left_coupling; ///< b'_p, empty where all are b_p

    /** b'_p of a point. */
    const double *
    left_of(const unsigned int point) const
    {
      return &(left_coupling.empty() ? coupling :
                                       left_coupling)[point * kinematics.size];
    }

    std::vector<double> square;       ///< c_p
    std::vector<double> group_square; ///< sum of c_p over the group

  private:
    /** The next points that take part in something, from `first` on: in no
     * batch if there is none. */
    PointBatch
    next_batch(unsigned int first) const;

    const Kinematics<dim>      &kinematics;
    std::vector<double>         start_volume, jacobian;     ///< by point
    std::vector<double>         group_volume, group_change; ///< sums
    std::vector<double>         group_pressure;             ///< sum of V0 pi
    mutable std::vector<double> by_mean, by_coupling; ///< of apply_coupling
  };
} // namespace impm

#endif
