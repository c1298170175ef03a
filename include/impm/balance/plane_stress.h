#ifndef impm_balance_plane_stress_h
#define impm_balance_plane_stress_h

#include <impm/balance/kinematics.h>

namespace impm
{
  /**
   * Plane stress: at every point the thickness follows from tau_33 = 0, and
   * the tangent is that of the plane with the thickness eliminated. What has
   * a potential keeps it, since the thickness makes it stationary.
   *
   * Evaluates the law at a point in each lane for a step of length dt (s) with
   * the dF_33 that leaves no stress across the plane and puts it into
   * `increment`. `start` is F at t_n. The iteration starts from dF_33 = 1,
   * whatever came before, and ends in each lane for itself. With a `matrix`,
   * it becomes the spatial tangent of the plane, as a list of Kinematics. Adds
   * to `n_evaluations` those that each lane has needed. Returns false when in
   * some lane there is no such thickness.
   */
  bool
  evaluate_plane_stress(const Material                    &material,
                        const dealii::Tensor<2, 3, Lanes> &start,
                        double                             dt,
                        const Places<Lanes, const double> &history,
                        const Places<Lanes, double>       &trial_history,
                        dealii::Tensor<2, 3, Lanes>       &increment,
                        Material::Responses               &response,
                        Lanes                             *matrix,
                        Lanes                             &n_evaluations);
} // namespace impm

#endif
