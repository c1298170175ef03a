#ifndef impm_balance_point_response_h
#define impm_balance_point_response_h

#include <impm/balance/kinematics.h>
#include <impm/balance/plane_stress.h>
#include <impm/balance/volume_average.h>
#include <impm/points/material_points.h>

#include <array>
#include <optional>
#include <vector>

namespace impm
{
  /**
   * What the points answer to the gradients of an increment: P = tau dF^-T
   * times V0, its tangent A = dP/d(dF), and the trial history. Lists of one
   * point are those of Kinematics, in units of N m.
   */
  template <int dim>
  class PointResponse
  {
  public:
    /**
     * For a step of length dt (s), with gradients that are zero. Evaluations of
     * laws are counted in `n_evaluations`.
     */
    PointResponse(const Bodies<dim>         &bodies,
                  const MaterialPoints<dim> &points,
                  double                     dt,
                  unsigned long             &n_evaluations);

    /**
     * Evaluates the laws at `gradients`; adds V0 times their potential.
     * Returns false when a point has no stress.
     */
    bool
    evaluate(bool with_tangent, double &potential);

    /**
     * Finds `start_stresses`, while the gradients are zero, whatever the
     * length of the step. Returns false as evaluate() does.
     */
    bool
    evaluate_start();

    /** stress_changes = tangent times gradient_changes. */
    void
    apply_tangent(const std::vector<double> &gradient_changes,
                  std::vector<double>       &stress_changes) const;

    /**
     * Replaces the tangent at every point by its positive part. Needs a
     * symmetric tangent.
     */
    void
    project_tangent();

    const double *
    tangent(const unsigned int point) const
    {
      return &tangents[point * kinematics.size * kinematics.size];
    }

    /**
     * The deformation over the step that the law has seen: dF, with the
     * average change of volume where the law asks for it, and with the
     * thickness that plane stress takes.
     */
    dealii::Tensor<2, 3>
    increment(unsigned int point) const;

    const double *
    trial_history(const unsigned int point) const
    {
      return histories.data() + point * points.history_size();
    }

    /** tau at the end of the step (Pa), as points that carry stress store it.
     */
    const double *
    end_stress(const unsigned int point) const
    {
      return &end_stresses[point * n_stress];
    }

    /** Adds the squares of the points' stresses (N m)^2, by groups of bodies.
     */
    void
    add_squares_of_stresses(const std::vector<unsigned int> &group_of_body,
                            std::vector<double>             &squares) const;

    const Kinematics<dim> kinematics;
    VolumeAverage<dim>    average;

    /** Of the stresses over the step, by the trapezoidal rule (J). */
    double
    work() const;

    std::vector<double> gradients, stresses, start_stresses;

  private:
    /** Consecutive points of one law, on their way through evaluate(). */
    struct Batch
    {
      static constexpr unsigned int max_size = 8;

      template <typename T>
      using List = std::array<T, max_size>;

      unsigned int                           first, size;
      const Material                        *law;
      List<dealii::Tensor<2, 3>>             start, increment, total, inverse;
      List<const double *>                   history;
      List<double *>                         trial_history;
      List<Material::Response>               response;
      List<typename Kinematics<dim>::Matrix> spatial; ///< tangents
    };

    /** Finds law and size of the batch that starts at `first`. */
    void
    begin_batch(Batch &batch) const;

    /** Fills in the rest. Returns false when a point has no stress. */
    bool
    evaluate_law(Batch &batch, bool with_tangent);

    /** Turns it into stresses and tangents; adds V0 times the potential. */
    void
    carry_back(Batch &batch, bool with_tangent, double &potential);

    const MaterialPoints<dim> &points;
    std::optional<PlaneStress> plane_stress;
    double                     dt;
    unsigned long             &n_evaluations;
    std::vector<double>        tangents, histories, end_stresses;
    const unsigned int         n_stress;   ///< values of a stress, if carried
    std::vector<double>        thickening; ///< dF_33 in plane stress
  };
} // namespace impm

#endif
