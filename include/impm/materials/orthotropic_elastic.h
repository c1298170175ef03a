#ifndef impm_materials_orthotropic_elastic_h
#define impm_materials_orthotropic_elastic_h

#include <deal.II/physics/elasticity/kinematics.h>

#include <impm/materials/log_strain.h>
#include <impm/materials/log_strain_differences.h>
#include <impm/materials/material.h>
#include <impm/materials/orthotropic_constants.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace impm
{
  /**
   * Orthotropic elasticity in Lagrangian logarithmic strains, whose axes the
   * material takes along:
   *
   *   psi = E : C : E / 2 per initial volume,   E = ln(F^T F) / 2.
   *
   * With the stretches lambda_a = exp(eps_a), their axes N_a before and n_a
   * behind the deformation, T = C : E and T_ab = N_a . T N_b,
   *
   *   tau  = sum_ab s_ab T_ab n_a n_b,     s_ab = x / sinh x, x = eps_a -
   * eps_b, h : c : g = dE_h : C : dE_g + sum_abc T_ab p_acb (h_ac g_cb + g_ac
   * h_cb),
   *
   * where dE_h = sum_ab s_ab h_ab N_a N_b, components of h and g are by n_a,
   * and p_acb = 2 lambda_c^2 lambda_a lambda_b times the second divided
   * difference of the logarithm at lambda_a^2, lambda_c^2, lambda_b^2 (C.
   * Miehe & M. Lambrecht, Commun. Numer. Meth. Engng 17 (2001) 337-353, who
   * write the same by eigenprojections). Keeps no history.
   */
  class OrthotropicElastic final : public LawInLanes<OrthotropicElastic>
  {
  public:
    // The ghost penalty must not outweigh the softest direction.
    OrthotropicElastic(const MaterialSpec         &spec,
                       PointLayout                &history,
                       const OrthotropicConstants &constants)
      : LawInLanes(spec,
                   *std::min_element(constants.young.begin(),
                                     constants.young.end()),
                   constants.longitudinal_modulus())
      , constants(constants)
    {
      constants.check_axes(history.geometry);
    }

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 const bool               with_tangent,
                 BasicResponse<Number>   &response) const
    {
      State<Number> state;
      if (!all_of(dealii::determinant(step.total) > 0.) ||
          !state.measure(step.total, constants))
        return false;

      Components<Number> tau;
      for (unsigned int A = 0; A < 6; ++A)
        tau[A] = state.shear_factor[A] * state.stress[A];
      const auto turned = turn_to_space(state.spatial_axis);
      for (unsigned int i = 0; i < 6; ++i)
        {
          Number sum = 0.;
          for (unsigned int A = 0; A < 6; ++A)
            sum += turned[i][A] * tau[A];
          response.kirchhoff_stress.access_raw_entry(i) = sum;
        }
      response.potential = state.energy;
      if (with_tangent)
        fill_tangent(state, turned, response.tangent);
      return all_of(is_finite(response.potential));
    }

    Energy
    energy(const dealii::Tensor<2, 3> &deformation_gradient,
           const double *) const override
    {
      State<double> state;
      return {state.measure(deformation_gradient, constants) ?
                state.energy :
                std::numeric_limits<double>::quiet_NaN(),
              0.};
    }

  private:
    // Symmetric tensors by components 00, 11, 22, 01, 02, 12, as deal.II stores
    // them; those off the diagonal count twice in products.
    static constexpr unsigned int row[6]    = {0, 1, 2, 0, 0, 1};
    static constexpr unsigned int column[6] = {0, 1, 2, 1, 2, 2};
    static constexpr double       count[6]  = {1, 1, 1, 2, 2, 2};

    static constexpr unsigned int
    place(const unsigned int a, const unsigned int b)
    {
      return a == b ? a : 2 + a + b;
    }

    template <typename Number>
    using Components = std::array<Number, 6>;
    template <typename Number>
    using Matrix = std::array<Components<Number>, 6>;

    /** What a deformation is in the axes of the stretches. */
    template <typename Number>
    struct State
    {
      /** Returns false when the stretches are not positive and finite. */
      bool
      measure(const dealii::Tensor<2, 3, Number> &F,
              const OrthotropicConstants         &constants)
      {
        dealii::Tensor<2, 3, Number> G; // F of the axes of the material
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            {
              Number sum = 0.;
              for (unsigned int k = 0; k < 3; ++k)
                sum += F[i][k] * constants.axes[k][j];
              G[i][j] = sum;
            }
        if (!LogStrain::decompose(dealii::Physics::Elasticity::Kinematics::C(G),
                                  principal))
          return false;
        const auto &N   = principal.axis;
        const auto &eps = principal.strain;
        for (unsigned int a = 0; a < 3; ++a)
          spatial_axis[a] =
            each([](const double x) { return std::exp(x); }, Number(-eps[a])) *
            (G * N[a]);

        const auto E = LogStrain::compose(eps, principal);
        dealii::SymmetricTensor<2, 3, Number> T;
        energy = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          {
            Number sum = 0.;
            for (unsigned int j = 0; j < 3; ++j)
              sum += constants.stiffness[i][j] * E[j][j];
            T[i][i] = sum;
            energy += 0.5 * sum * E[i][i];
          }
        for (unsigned int k = 3; k < 6; ++k)
          {
            const Number &shear   = E.access_raw_entry(k);
            T.access_raw_entry(k) = 2. * constants.shear[k - 3] * shear;
            energy += T.access_raw_entry(k) * shear;
          }
        for (unsigned int A = 0; A < 6; ++A)
          {
            stress[A]       = N[row[A]] * (T * N[column[A]]);
            shear_factor[A] = x_over_sinh(Number(eps[row[A]] - eps[column[A]]));
          }
        return true;
      }

      LogStrain::PrincipalStrains<Number>         principal;
      std::array<dealii::Tensor<1, 3, Number>, 3> spatial_axis; ///< n_a
      Components<Number>                          stress;       ///< T_ab
      Components<Number>                          shear_factor; ///< s_ab
      Number                                      energy;       ///< psi
    };

    /** From components by axes to those in space. */
    template <typename Number>
    static Matrix<Number>
    turn_to_space(const std::array<dealii::Tensor<1, 3, Number>, 3> &n)
    {
      Matrix<Number> result;
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int A = 0; A < 6; ++A)
          {
            const auto &a = n[row[A]], &b = n[column[A]];
            result[i][A] =
              0.5 * count[A] *
              (a[row[i]] * b[column[i]] + a[column[i]] * b[row[i]]);
          }
      return result;
    }

    template <typename Number>
    void
    fill_tangent(const State<Number>                   &state,
                 const Matrix<Number>                  &turned,
                 dealii::SymmetricTensor<4, 3, Number> &tangent) const
    {
      // How strains by the axes of the material follow those by n_a, and
      // their stresses.
      Matrix<Number> strain, stress;
      const auto    &N = state.principal.axis;
      for (unsigned int K = 0; K < 6; ++K)
        for (unsigned int A = 0; A < 6; ++A)
          {
            const auto &a = N[row[A]], &b = N[column[A]];
            strain[K][A] =
              0.5 * state.shear_factor[A] *
              (a[row[K]] * b[column[K]] + a[column[K]] * b[row[K]]);
          }
      for (unsigned int A = 0; A < 6; ++A)
        {
          for (unsigned int i = 0; i < 3; ++i)
            {
              Number sum = 0.;
              for (unsigned int j = 0; j < 3; ++j)
                sum += constants.stiffness[i][j] * strain[j][A];
              stress[i][A] = sum;
            }
          for (unsigned int K = 3; K < 6; ++K)
            stress[K][A] = 4. * constants.shear[K - 3] * strain[K][A];
        }
      Matrix<Number> c{};
      for (unsigned int A = 0; A < 6; ++A)
        for (unsigned int B = 0; B <= A; ++B)
          {
            Number sum = 0.;
            for (unsigned int K = 0; K < 6; ++K)
              sum += strain[K][A] * stress[K][B];
            c[A][B] += sum;
            if (B < A)
              c[B][A] += sum;
          }

      const LogDifferences<Number> differences(state.principal.strain,
                                               {{state.shear_factor[3],
                                                 state.shear_factor[4],
                                                 state.shear_factor[5]}});
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          for (unsigned int k = 0; k < 3; ++k)
            {
              const unsigned int A = place(a, k), B = place(k, b);
              const Number       part = state.stress[place(a, b)] *
                                  differences.around(a, k, b) /
                                  (count[A] * count[B]);
              c[A][B] += part;
              c[B][A] += part;
            }

      for (unsigned int j = 0; j < 6; ++j)
        {
          Components<Number> half;
          for (unsigned int A = 0; A < 6; ++A)
            {
              half[A] = 0.;
              for (unsigned int B = 0; B < 6; ++B)
                half[A] += c[A][B] * turned[j][B];
            }
          for (unsigned int i = 0; i <= j; ++i)
            {
              Number sum = 0.;
              for (unsigned int A = 0; A < 6; ++A)
                sum += turned[i][A] * half[A];
              tangent.access_raw_entry(6 * i + j) = sum;
              tangent.access_raw_entry(6 * j + i) = sum;
            }
        }
    }

    const OrthotropicConstants constants;
  };
} // namespace impm

#endif
