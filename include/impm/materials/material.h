#ifndef impm_materials_material_h
#define impm_materials_material_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/points/point_layout.h>

#include <cmath>

namespace dealii
{
  class ParameterHandler;
}

namespace impm
{
  /** What every material has, whatever its law. */
  struct MaterialSpec
  {
    double density; ///< in the initial configuration (kg/m^3)

    /** Whether the points of a cell share its change of volume (F-bar). */
    bool average_volume = false;

    double specific_heat       = 0; ///< (J/(kg K)); 0: no temperature
    double initial_temperature = 0; ///< (K), if it has a specific heat
  };


  /**
   * A constitutive law: from the deformation over one step and the history at
   * its start to the stress, its tangent, the energy and the history at its
   * end. Const and stateless: what a point remembers lives in fields of the
   * point, and a trial history is kept aside until the step has converged.
   *
   * A law that keeps a history takes the layout of the history of the scene
   * where it is made, and adds its fields there. Their offsets count from the
   * start of the history, which is what `history` points to below.
   *
   * All tensors are 3 x 3 and live in the current configuration, whatever the
   * dimension of the scene.
   */
  class Material
  {
  public:
    /** One step at one point. */
    struct Step
    {
      const dealii::Tensor<2, 3> &increment; ///< dF: from t_n to t_{n+1}
      const dealii::Tensor<2, 3> &total;     ///< F at t_{n+1} = dF F_n
      /**
       * Length of the step (s). With 0 and no increment the stress is that of
       * the state at t_n, whatever came before it.
       */
      double        dt;
      const double *history;       ///< at t_n
      double       *trial_history; ///< at t_{n+1}, does not overlap the other
    };

    /** The same at many points: lists, and where the histories are. */
    struct Batch
    {
      unsigned int                n_points;
      const dealii::Tensor<2, 3> *increments;
      const dealii::Tensor<2, 3> *totals;
      double                      dt;
      const double *const        *histories;
      double *const              *trial_histories;

      Step
      step(const unsigned int point) const
      {
        return {increments[point],
                totals[point],
                dt,
                histories[point],
                trial_histories[point]};
      }
    };

    /** What a law takes the step for, and with it what its tangent is. */
    enum class Form
    {
      spatial,   ///< finite; c of the Lie derivative, symmetric in ij and in kl
      full,      ///< finite; a_ijkl, with what the spin of the step does
      linearized ///< small strains about t_n, where forces act, too
    };

    struct Response
    {
      /** tau = J sigma, per initial volume (Pa); linearized: J_n sigma. */
      dealii::SymmetricTensor<2, 3> kirchhoff_stress;

      /**
       * Incremental potential per initial volume (J/m^3), up to a constant of
       * the step: tau is its derivative. Only for laws with has_potential().
       */
      double potential = 0;

      /**
       * c with (Lie derivative of tau) = c : d, that is
       * d tau_ij / dF_km F_lm = c_ijkl + delta_ik tau_jl + tau_il delta_jk
       * (symmetrized over k, l). Linearized: d (J_n sigma_ij) / d strain_kl.
       * Filled only when asked for. Units Pa.
       */
      dealii::SymmetricTensor<4, 3> tangent;

      /**
       * a_ijkl = d tau_ij / d dF_km dF_lm (Pa), in its place when full. Last,
       * so that the other laws never touch its memory.
       */
      dealii::Tensor<4, 3> full_tangent;
    };

    /** Energy per initial volume (J/m^3) in a state. */
    struct Energy
    {
      double stored     = 0; ///< recoverable
      double dissipated = 0; ///< plastic work since the start
    };

    /** Stiffness and modulus of longitudinal waves (Pa): see below. */
    Material(const MaterialSpec &spec,
             const double        stiffness,
             const double        longitudinal_modulus)
      : density(spec.density)
      , average_volume(spec.average_volume)
      , specific_heat(spec.specific_heat)
      , initial_temperature(spec.initial_temperature)
      , scale(stiffness)
      , longitudinal_modulus(longitudinal_modulus)
    {}

    virtual ~Material() = default;

    /** Declares the entry of the density, for the laws. */
    static void
    declare_density(dealii::ParameterHandler &prm);

    /** Writes the history of a point that has not been deformed. */
    virtual void
    initialize_history(double *) const
    {}

    /**
     * Evaluates the law at all points of a batch, a response for each.
     * Returns false when some point has no stress (J <= 0, no finite numbers);
     * the other results are then meaningless and the caller backs off.
     * Allocates nothing. See PointwiseLaw for laws that look at one point
     * after the other.
     */
    virtual bool
    evaluate(const Batch &batch,
             bool         with_tangent,
             Response    *responses) const = 0;

    /** The same at one point. */
    bool
    evaluate_one(const Step &step,
                 const bool  with_tangent,
                 Response   &response) const
    {
      return evaluate({1,
                       &step.increment,
                       &step.total,
                       step.dt,
                       &step.history,
                       &step.trial_history},
                      with_tangent,
                      &response);
    }

    /** Energy in the state (F, history) at the end of a step. */
    virtual Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const = 0;

    virtual Form
    form() const
    {
      return Form::spatial;
    }

    /** Whether the tangent of the forces is symmetric. */
    bool
    has_symmetric_tangent() const
    {
      return form() != Form::full;
    }

    /** Whether it resists being stretched without a change of volume. */
    virtual bool
    is_solid() const
    {
      return true;
    }

    /** Whether the stress derives from Response::potential. */
    virtual bool
    has_potential() const
    {
      return true;
    }

    /**
     * Young's modulus (Pa), or what comes next to it in a fluid: scale of
     * residuals and of the ghost penalty.
     */
    double
    stiffness() const
    {
      return scale;
    }

    /** Speed of longitudinal elastic waves (m/s). */
    double
    wave_speed() const
    {
      return std::sqrt(longitudinal_modulus / density);
    }

    // those of MaterialSpec
    const double density;
    const bool   average_volume;
    const double specific_heat, initial_temperature;

  private:
    const double scale, longitudinal_modulus;
  };
} // namespace impm

#endif
