#ifndef impm_balance_plane_stress_h
#define impm_balance_plane_stress_h

#include <impm/balance/kinematics.h>

namespace impm
{
  /**
   * Plane stress: at every point the thickness follows from tau_33 = 0, and
   * the tangent is that of the plane with the thickness eliminated. What has
   * a potential keeps it, since the thickness makes it stationary.
   */
  class PlaneStress
  {
  public:
    using Matrix = Kinematics<2>::Matrix;

    /**
     * Evaluates the law for a step of length dt (s) with the dF_33 that leaves
     * no stress across the plane and puts it into `increment`. `start` is F at
     * t_n. The iteration starts from dF_33 = 1, whatever came before. With a
     * `matrix`, it becomes the spatial tangent of the plane. Returns false
     * when there is no such thickness.
     */
    bool
    evaluate(const Material             &material,
             const dealii::Tensor<2, 3> &start,
             double                      dt,
             const double               *history,
             double                     *trial_history,
             dealii::Tensor<2, 3>       &increment,
             Material::Response         &response,
             double                     *matrix);

    unsigned long n_evaluations = 0; ///< of laws, since the start

  private:
    /** With the thickness as the hoop of axisymmetry. */
    const Kinematics<2> thick{true};
  };
} // namespace impm

#endif
