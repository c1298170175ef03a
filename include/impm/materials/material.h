#ifndef impm_materials_material_h
#define impm_materials_material_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/points/point_layout.h>

#include <cmath>
#include <memory>
#include <string>

namespace dealii
{
  template <int dim>
  class FunctionParser;
}

namespace impm
{
  /**
   * What every material has, whatever its law. A material has a temperature if
   * it has a specific heat, and work heats it, or if the temperature is
   * prescribed.
   */
  struct MaterialSpec
  {
    double density; ///< in the initial configuration (kg/m^3)

    /** Whether the points of a cell share its change of volume (F-bar). */
    bool average_volume = false;

    double specific_heat       = 0; ///< (J/(kg K))
    double initial_temperature = 0; ///< (K), or a typical one
    double heating_share       = 1; ///< of plastic or viscous work, 0 to 1
    double conductivity        = 0; ///< (W/(m K)); 0: nothing is conducted

    /** (K) in (x, y, z, t), or null. */
    std::shared_ptr<dealii::FunctionParser<3>> prescribed_temperature = nullptr;
    /** Whether that is a function of initial places. */
    bool temperature_is_initial = false;
    /** The initial temperature in (x, y, z), if heat is conducted, or null. */
    std::shared_ptr<dealii::FunctionParser<3>> temperature_at_start = nullptr;

    double expansion               = 0; ///< of length (1/K)
    double stress_free_temperature = 0; ///< (K)

    /** In the history, where it is prescribed: the temperature (K); where heat
     * is conducted: what that has added to it (K). */
    unsigned int temperature_offset = 0;
    /** Likewise, where it expands: the strain by which it would do so freely in
     * the state of the point, expansion times what the temperature is above
     * that without stress. */
    unsigned int expansion_offset = 0;

    bool
    has_temperature() const
    {
      return specific_heat > 0 || prescribed_temperature;
    }

    bool
    conducts() const
    {
      return conductivity > 0;
    }

    bool
    expands() const
    {
      return expansion != 0;
    }

    /** (K) after what has been dissipated since the start (J/m^3). */
    template <typename Number, typename Place>
    Number
    temperature(const Number &dissipated, const Place &history) const
    {
      if (prescribed_temperature)
        return read(history, temperature_offset);
      const Number adiabatic =
        initial_temperature +
        heating_share / (density * specific_heat) * dissipated;
      return conducts() ?
               Number(adiabatic + read(history, temperature_offset)) :
               adiabatic;
    }
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
  class Material : public MaterialSpec
  {
  public:
    /** One step at one point, or at one point in each lane. */
    template <typename Number>
    struct BasicStep
    {
      const dealii::Tensor<2, 3, Number> &increment; ///< dF: t_n to t_{n+1}
      const dealii::Tensor<2, 3, Number> &total;     ///< F at t_{n+1} = dF F_n
      /**
       * Length of the step (s). With 0 and no increment the stress is that of
       * the state at t_n, whatever came before it.
       */
      double                       dt;
      Places<Number, const double> history; ///< at t_n
      /** At t_{n+1}, does not overlap the other. */
      Places<Number, double> trial_history;
    };

    using Step  = BasicStep<double>;
    using Steps = BasicStep<Lanes>;

    /** What a law takes the step for, and with it what its tangent is. */
    enum class Form
    {
      spatial,   ///< finite; c of the Lie derivative, symmetric in ij and in kl
      full,      ///< finite; a_ijkl, with what the spin of the step does
      linearized ///< small strains about t_n, where forces act, too
    };

    template <typename Number>
    struct BasicResponse
    {
      /** tau = J sigma, per initial volume (Pa); linearized: J_n sigma. */
      dealii::SymmetricTensor<2, 3, Number> kirchhoff_stress;

      /**
       * Incremental potential per initial volume (J/m^3), up to a constant of
       * the step: tau is its derivative. Only for laws with has_potential();
       * without a history it is the stored energy.
       */
      Number potential = 0.;

      /**
       * c with (Lie derivative of tau) = c : d, that is
       * d tau_ij / dF_km F_lm = c_ijkl + delta_ik tau_jl + tau_il delta_jk
       * (symmetrized over k, l). Linearized: d (J_n sigma_ij) / d strain_kl.
       * Filled only when asked for. Units Pa.
       */
      dealii::SymmetricTensor<4, 3, Number> tangent;

      /**
       * a_ijkl = d tau_ij / d dF_km dF_lm (Pa), in its place when full. Last,
       * so that the other laws never touch its memory.
       */
      dealii::Tensor<4, 3, Number> full_tangent;
    };

    using Response  = BasicResponse<double>;
    using Responses = BasicResponse<Lanes>;

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
      : MaterialSpec(spec)
      , scale(stiffness)
      , longitudinal_modulus(longitudinal_modulus)
    {}

    virtual ~Material() = default;

    /** Writes what is not zero in the history of an undeformed point. */
    virtual void
    initialize_history(double *) const
    {}

    /**
     * Stress, and tangent if asked for, at one point. Returns false when it has
     * no stress (J <= 0, no finite numbers); the response is then meaningless
     * and the caller backs off. Allocates nothing.
     */
    virtual bool
    evaluate_one(const Step &step,
                 bool        with_tangent,
                 Response   &response) const = 0;

    /**
     * The same at one point in each lane; false when some point has no stress.
     * Two lanes may be of one point.
     */
    virtual bool
    evaluate(const Steps &steps,
             bool         with_tangent,
             Responses   &responses) const = 0;

    /**
     * Whether a point has lost strength by flowing, from the history at the
     * start of a step to that at its end: strain then gathers in a band.
     */
    virtual bool
    softens(const double * /*start*/, const double * /*end*/) const
    {
      return false;
    }

    /** Energy in the state (F, history) at the end of a step, where nothing has
     * expanded by heat. */
    virtual Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double               *history) const = 0;

    virtual Form
    form() const
    {
      return Form::spatial;
    }

    /**
     * Whether the tangent of the forces is symmetric. A law whose flow does not
     * derive from its yield function overrides it.
     */
    virtual bool
    has_symmetric_tangent() const
    {
      return form() != Form::full;
    }

    /**
     * What the law is asked for where a point has F and would expand freely by
     * a strain: F without that expansion. Laws of small strains about t_n take
     * it out of the strain of the step instead (see ThermalStrain).
     */
    dealii::Tensor<2, 3>
    cooled(const dealii::Tensor<2, 3> &F, const double strain) const
    {
      return form() == Form::linearized ? F : std::exp(-strain) * F;
    }

    /** Energy in the state (F, history) of a point. */
    Energy
    energy_of_point(const dealii::Tensor<2, 3> &F, const double *history) const
    {
      return energy(expands() ? cooled(F, history[expansion_offset]) : F,
                    history);
    }

    /** Whether it resists being stretched without a change of volume. */
    virtual bool
    is_solid() const
    {
      return true;
    }

    /**
     * Whether stress and energy depend on F at the start of a step, by more
     * than its determinant: where they do not, F may begin anew from another
     * shape of the same volume.
     */
    virtual bool
    depends_on_shape() const
    {
      return true;
    }

    /** Whether the stress derives from Response::potential. */
    virtual bool
    has_potential() const
    {
      return has_symmetric_tangent();
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

    /** What a point has left of it, which may have failed (Pa, above 0). */
    virtual double
    remaining_stiffness(const double * /*history*/) const
    {
      return scale;
    }

    /** Speed of longitudinal elastic waves (m/s). */
    double
    wave_speed() const
    {
      return std::sqrt(longitudinal_modulus / density);
    }

  private:
    const double scale, longitudinal_modulus;
  };

  /**
   * A law (final, derived from Base) that evaluates one point after the other,
   * in evaluate_one().
   */
  template <typename Law, typename Base = Material>
  class PointwiseLaw : public Base
  {
  public:
    using Base::Base;

    bool
    evaluate(const Material::Steps &steps,
             const bool             with_tangent,
             Material::Responses   &responses) const final
    {
      const auto        &law  = static_cast<const Law &>(*this);
      const bool         full = this->form() == Material::Form::full;
      Material::Response response;
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        {
          dealii::Tensor<2, 3> increment, total;
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              {
                increment[i][j] = steps.increment[i][j][lane];
                total[i][j]     = steps.total[i][j][lane];
              }
          if (!law.evaluate_one({increment,
                                 total,
                                 steps.dt,
                                 steps.history[lane],
                                 steps.trial_history[lane]},
                                with_tangent,
                                response))
            return false;
          const auto put = [lane](auto &into, const auto &from) {
            for (unsigned int i = 0; i < from.n_independent_components; ++i)
              into.access_raw_entry(i)[lane] = from.access_raw_entry(i);
          };
          put(responses.kirchhoff_stress, response.kirchhoff_stress);
          responses.potential[lane] = response.potential;
          if (with_tangent && !full)
            for (unsigned int i = 0; i < 6; ++i)
              for (unsigned int j = 0; j < 6; ++j)
                responses.tangent.access_raw_entry(6 * i + j)[lane] =
                  response.tangent.access_raw_entry(6 * i + j);
          if (with_tangent && full)
            for (unsigned int ij = 0; ij < 9; ++ij)
              for (unsigned int kl = 0; kl < 9; ++kl)
                responses.full_tangent[ij / 3][ij % 3][kl / 3][kl % 3][lane] =
                  response.full_tangent[ij / 3][ij % 3][kl / 3][kl % 3];
        }
      return true;
    }
  };

  /**
   * A law (final, derived from Base) whose evaluate_any() is written for any
   * number: it evaluates a point in each lane at once.
   */
  template <typename Law, typename Base = Material>
  class LawInLanes : public Base
  {
  public:
    using Base::Base;

    bool
    evaluate_one(const Material::Step &step,
                 const bool            with_tangent,
                 Material::Response   &response) const final
    {
      return static_cast<const Law &>(*this).evaluate_any(step,
                                                          with_tangent,
                                                          response);
    }

    bool
    evaluate(const Material::Steps &steps,
             const bool             with_tangent,
             Material::Responses   &responses) const final
    {
      return static_cast<const Law &>(*this).evaluate_any(steps,
                                                          with_tangent,
                                                          responses);
    }
  };

  /** A symmetric tensor that a law keeps in its history. */
  class HistoryTensor
  {
  public:
    HistoryTensor(PointLayout &history, const std::string &name)
      : storage(history.geometry)
      , offset(history.add(name, PointLayout::Kind::symmetric_tensor))
    {}

    template <typename Place>
    auto
    load(const Place &history) const
    {
      return storage.load_symmetric(history, offset);
    }

    template <typename Number, typename Place>
    void
    store(const dealii::SymmetricTensor<2, 3, Number> &tensor,
          const Place                                 &history) const
    {
      storage.store_symmetric(tensor, history, offset);
    }

  private:
    const PointLayout  storage; ///< knows how tensors are stored
    const unsigned int offset;
  };
} // namespace impm

#endif
