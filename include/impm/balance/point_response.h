#ifndef impm_balance_point_response_h
#define impm_balance_point_response_h

#include <impm/balance/kinematics.h>
#include <impm/balance/point_batch.h>
#include <impm/balance/residual_norm.h>
#include <impm/balance/thermal_strain.h>
#include <impm/balance/volume_average.h>
#include <impm/base/memory.h>
#include <impm/points/material_points.h>

#include <vector>

namespace impm
{
  /**
   * What the points answer to the gradients of an increment: P = tau dF^-T
   * times V0, its tangent A = dP/d(dF), and the trial history. Lists of one
   * point are those of Kinematics, in units of N m.
   *
   * In the middle of the step (see EnergyMomentum), what acts instead is
   * P' with (P' + P_0) / 2 = F S, F = (1 + dF) / 2 and S the mean of the
   * stresses P_0 at the start and dF^-1 P at the end, which are symmetric:
   *
   *   P' = F P_0 + T P - P_0,  T = F dF^-1,
   *   A' g = g (P_0 + dF^-1 P) / 2 - T g dF^-1 P + T A g.
   */
  template <int dim>
  class PointResponse
  {
  public:
    /**
     * For a step of length dt (s) that ends at a time, with gradients that are
     * zero. Evaluations of laws are counted in `n_evaluations`. Throws as
     * ThermalStrain does. Collective.
     */
    PointResponse(const MaterialPoints<dim> &points,
                  double                     dt,
                  double                     end_time,
                  bool                       acts_in_the_middle,
                  unsigned long             &n_evaluations);

    /**
     * Evaluates the laws at `gradients`. Returns false when a point has no
     * stress. The first tangent of a step in which points expand by heat is
     * that of the temperature at its start: stresses where nothing has moved
     * yet are those of no equilibrium, and slender parts would seem to buckle.
     */
    bool
    evaluate(bool with_tangent);

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

    /** An entry of the tangent at a point (N m). */
    double
    tangent(const unsigned int point,
            const unsigned int a,
            const unsigned int b) const
    {
      return tangents[point * entries.size() +
                      place_of_entry[a * kinematics.size + b]];
    }

    /**
     * The deformation over the step that the law has seen: dF, with the
     * average change of volume where the law asks for it, and with the
     * thickness that plane stress takes.
     */
    dealii::Tensor<2, 3>
    increment(const unsigned int point) const
    {
      auto dF = kinematics.deformation(&gradients[point * kinematics.size]);
      if (is_plane_stress)
        dF[2][2] = thickening[point];
      if (average.includes(point))
        average.dilate(average.factor(point), dF);
      return dF;
    }

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

    /** T of a point times a list of one, where stress acts in the middle. */
    typename Kinematics<dim>::template List<>
    turn(unsigned int point, const double *list) const;

    /** Squares of the points' stresses (N m)^2, by the groups of a norm. */
    std::vector<double>
    squares_of_stresses(const ResidualNorm &norm) const;

    /** What the points' trial state takes (bytes). */
    std::size_t
    memory_consumption() const
    {
      return bytes_of(gradients,
                      stresses,
                      start_stresses,
                      tangents,
                      histories,
                      end_stresses,
                      thickening,
                      traces,
                      start_traces,
                      turns,
                      acting_stresses) +
             average.memory_consumption();
    }

    const Kinematics<dim> kinematics;
    VolumeAverage<dim>    average;
    const bool            acts_in_the_middle;

    /** Of the stresses over the step, by the trapezoidal rule (J). */
    double
    work() const;

    /**
     * What heat has given to the points in the step (J): where they would
     * expand freely by d theta, the energy of a law at rest changes by
     * - tr(tau) d theta. By the trapezoidal rule.
     */
    double
    work_of_heat() const;

    /** P, or what acts instead, which the tangent belongs to. */
    const std::vector<double> &
    acting() const
    {
      return acts_in_the_middle ? acting_stresses : stresses;
    }

    std::vector<double> gradients, stresses, start_stresses;
    double              potential = 0; ///< sum of V0 times those of the laws
    double              start_potential = 0; ///< likewise, if not explicit

  private:
    /** Points of one law, on their way through evaluate(). */
    struct Batch : public PointBatch
    {
      const Material                                  *law;
      typename Kinematics<dim>::template List<Lanes>   gradient;
      dealii::Tensor<2, 3, Lanes>                      increment, total;
      Material::Responses                              response;
      typename Kinematics<dim>::template Matrix<Lanes> spatial; ///< tangent
    };

    /** At points that begin with `first`, as many as there are lanes, if they
     * are of one law. Returns their number, or none when a point has no stress.
     */
    unsigned int
    evaluate_batch(unsigned int first, bool with_tangent, Batch &batch);

    bool
    evaluate_law(Batch &batch, bool with_tangent);

    /** evaluate() without what the first tangent is. */
    bool
    evaluate_points(bool with_tangent);

    /** Turns the response into stresses, tangents and potential. */
    void
    carry_back(Batch &batch, bool with_tangent);

    /** Finds what acts in the middle of the step. */
    void
    act_in_the_middle(bool with_tangent);

    const MaterialPoints<dim> &points;
    const bool                 is_plane_stress;
    double                     dt;
    unsigned long             &n_evaluations;
    /** Of a tangent: those that are stored, all or, where every law has a
     * symmetric one, its lower triangle, as row * size + column; and where. */
    std::vector<unsigned int>   entries, place_of_entry;
    std::vector<double>         tangents, histories;
    ThermalStrain<dim>          thermal;
    bool                        is_first_tangent = true;
    const unsigned int          n_stress; ///< values of a stress, if carried
    std::vector<double>         end_stresses;
    std::vector<double>         thickening; ///< dF_33 in plane stress
    std::vector<double>         turns, acting_stresses; ///< T and P'
    std::vector<double>         traces, start_traces;   ///< V0 tr(tau) (J)
    mutable std::vector<double> coupled;                ///< of apply_tangent
  };
} // namespace impm

#endif
