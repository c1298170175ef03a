#ifndef impm_materials_material_h
#define impm_materials_material_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/points/point_layout.h>

namespace dealii
{
  class ParameterHandler;
}

namespace impm
{
  /**
   * A constitutive law: from the deformation over one step and the history at
   * its start to the stress, its tangent, the energy and the history at its
   * end. Const and stateless: what a point remembers lives in fields of the
   * point, and a trial history is kept aside until the step has converged.
   *
   * All tensors are 3 x 3 and live in the current configuration, whatever the
   * dimension of the scene.
   */
  class Material
  {
  public:
    /** The deformation over one step at one point. */
    struct Deformation
    {
      dealii::Tensor<2, 3> increment; ///< dF: from t_n to t_{n+1}
      dealii::Tensor<2, 3> total;     ///< F at t_{n+1} = dF F_n
      /**
       * Length of the step (s). With 0 and no increment the stress is that of
       * the state at t_n, whatever came before it.
       */
      double dt;
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
       * c with (Lie derivative of tau) = c : d, that is
       * d tau_ij / dF_km F_lm = c_ijkl + delta_ik tau_jl + tau_il delta_jk
       * (symmetrized over k, l). Linearized: d (J_n sigma_ij) / d strain_kl.
       * Filled only when asked for. Units Pa.
       */
      dealii::SymmetricTensor<4, 3> tangent;

      /** a_ijkl = d tau_ij / d dF_km dF_lm (Pa), in its place when full. */
      dealii::Tensor<4, 3> full_tangent;

      /**
       * Incremental potential per initial volume (J/m^3), up to a constant of
       * the step: tau is its derivative. Only for laws with has_potential().
       */
      double potential = 0;
    };

    /** Energy per initial volume (J/m^3) in a state. */
    struct Energy
    {
      double stored     = 0; ///< recoverable
      double dissipated = 0; ///< plastic work since the start
    };

    explicit Material(const double density)
      : density(density)
    {}

    virtual ~Material() = default;

    /**
     * Adds the history fields that this law keeps at its points to the layout
     * of the history and remembers where they are. Offsets count from the
     * start of the history, which is what `history` points to below.
     */
    virtual void
    declare_history(PointLayout &layout) = 0;

    /** Writes the history of a point that has not been deformed. */
    virtual void
    initialize_history(double *history) const = 0;

    /**
     * Evaluates the law. Returns false when no stress exists (J <= 0, no
     * finite numbers); the other results are then meaningless and the caller
     * backs off. `trial_history` has the size of `history` and must not
     * overlap it. Allocates nothing.
     */
    virtual bool
    evaluate(const Deformation &deformation,
             const double      *history,
             double            *trial_history,
             bool               with_tangent,
             Response          &response) const = 0;

    /** Energy in the state (F, history) at the end of a step. */
    virtual Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const = 0;

    /**
     * Young's modulus (Pa), or what comes next to it in a fluid: scale of
     * residuals and of the ghost penalty.
     */
    virtual double
    stiffness() const = 0;

    /** Speed of longitudinal elastic waves (m/s). */
    virtual double
    wave_speed() const = 0;

    virtual Form
    form() const
    {
      return Form::spatial;
    }

    /** Whether the tangent of the forces is symmetric. */
    virtual bool
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

    /** Declares the entry of the density, for the laws. */
    static void
    declare_density(dealii::ParameterHandler &prm);

    /** Whether the stress derives from Response::potential. */
    virtual bool
    has_potential() const
    {
      return true;
    }

    /** Whether the points of a cell share its change of volume (F-bar). */
    bool average_volume = false;

    /** (J/(kg K)); 0: no temperature. */
    double specific_heat = 0;

    double initial_temperature = 0; ///< (K), if it has a specific heat

    const double density; ///< in the initial configuration (kg/m^3)
  };
} // namespace impm

#endif
