#ifndef impm_balance_kinematics_h
#define impm_balance_kinematics_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/materials/material.h>

#include <array>

namespace impm
{
  /**
   * The gradient of an increment u at a point as a list of numbers, and what
   * is dual to it: d u_i / d x_j at [i dim + j] and, when axisymmetric,
   * u_r / r behind.
   */
  template <int dim>
  struct Kinematics
  {
    static constexpr unsigned int max_size = dim * dim + 1;

    template <typename Number = double>
    using List = std::array<Number, max_size>;
    template <typename Number = double>
    using Matrix = std::array<Number, max_size * max_size>; ///< by rows

    explicit Kinematics(const bool axisymmetric)
      : axisymmetric(axisymmetric)
      , size(dim * dim + (axisymmetric ? 1 : 0))
      , n_dilating(axisymmetric ? 3 : dim)
    {}

    const bool         axisymmetric;
    const unsigned int size;
    /** Directions that a change of volume spreads over. */
    const unsigned int n_dilating;

    /** dF = 1 + gradient. */
    template <typename Number>
    dealii::Tensor<2, 3, Number>
    deformation(const Number *gradient) const
    {
      dealii::Tensor<2, 3, Number> dF;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          dF[i][j] = gradient[dim * i + j] + (i == j ? 1. : 0.);
      for (unsigned int i = dim; i < 3; ++i)
        dF[i][i] = 1.;
      if (axisymmetric)
        dF[2][2] += gradient[dim * dim];
      return dF;
    }

    /** A symmetric tensor as a list. */
    template <typename Number>
    List<Number>
    list(const dealii::SymmetricTensor<2, 3, Number> &tensor) const
    {
      List<Number> result{};
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result[dim * i + j] = tensor[i][j];
      if (axisymmetric)
        result[dim * dim] = tensor[2][2];
      return result;
    }

    /** factor * L^T list, where L carries a gradient on: g inverse. */
    template <typename Number>
    void
    carry_back(const List<Number>                 &list,
               const dealii::Tensor<2, 3, Number> &inverse,
               const Number                       &factor,
               Number                             *result) const
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            Number sum = 0.;
            for (unsigned int k = 0; k < dim; ++k)
              sum += list[dim * i + k] * inverse[j][k];
            result[dim * i + j] = factor * sum;
          }
      if (axisymmetric)
        result[dim * dim] = factor * list[dim * dim] * inverse[2][2];
    }

    /**
     * How tau L^-T, L = 1 + g, changes with g: c_ijkl + delta_ik tau_jl, the
     * material's stiffness, whose sum over the points is K_mat, and that of
     * stress that turns, K_geo (Guilkey & Weiss 2003, section 3.3). The same
     * from the full tangent is a_ijkl - tau_il delta_jk (Newmark note);
     * linearized there is no K_geo.
     */
    template <typename Number>
    void
    spatial_tangent(const Material::BasicResponse<Number> &response,
                    const Material::Form                   form,
                    Number                                *matrix) const
    {
      const auto &c   = response.tangent;
      const auto &a   = response.full_tangent;
      const auto &tau = response.kirchhoff_stress;
      switch (form)
        {
          case Material::Form::spatial:
            fill(matrix, [&](auto i, auto j, auto k, auto l) -> Number {
              const Number material  = c[i][j][k][l];
              const Number geometric = i == k ? tau[j][l] : Number(0.);
              return material + geometric;
            });
            break;
          case Material::Form::full:
            fill(matrix, [&](auto i, auto j, auto k, auto l) -> Number {
              return a[i][j][k][l] - (j == k ? tau[i][l] : Number(0.));
            });
            break;
          case Material::Form::linearized:
            fill(matrix, [&](auto i, auto j, auto k, auto l) -> Number {
              return c[i][j][k][l];
            });
        }
    }

    /** factor * L^T matrix L. */
    template <typename Number>
    void
    carry_back_tangent(const Number                       *matrix,
                       const dealii::Tensor<2, 3, Number> &inverse,
                       const Number                       &factor,
                       Number                             *result) const
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int k = 0; k < dim; ++k)
          {
            Number half[dim][dim];
            for (unsigned int j = 0; j < dim; ++j)
              for (unsigned int m = 0; m < dim; ++m)
                {
                  Number sum = 0.;
                  for (unsigned int l = 0; l < dim; ++l)
                    sum += matrix[(dim * i + j) * size + dim * k + l] *
                           inverse[m][l];
                  half[j][m] = factor * sum;
                }
            for (unsigned int j = 0; j < dim; ++j)
              for (unsigned int m = 0; m < dim; ++m)
                {
                  Number sum = 0.;
                  for (unsigned int l = 0; l < dim; ++l)
                    sum += inverse[j][l] * half[l][m];
                  result[(dim * i + j) * size + dim * k + m] = sum;
                }
          }
      if (!axisymmetric)
        return;
      const unsigned int h    = dim * dim;
      const Number       hoop = factor * inverse[2][2];
      result[h * size + h]    = hoop * matrix[h * size + h] * inverse[2][2];
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            Number row = 0., column = 0.;
            for (unsigned int l = 0; l < dim; ++l)
              {
                row += inverse[j][l] * matrix[(dim * i + l) * size + h];
                column += inverse[j][l] * matrix[h * size + dim * i + l];
              }
            result[(dim * i + j) * size + h] = hoop * row;
            result[h * size + dim * i + j]   = hoop * column;
          }
    }

  private:
    /** The matrix with the values of entry(i, j, k, l). */
    template <typename Number, typename Entry>
    void
    fill(Number *matrix, const Entry &entry) const
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int l = 0; l < dim; ++l)
              matrix[(dim * i + j) * size + dim * k + l] = entry(i, j, k, l);
      if (!axisymmetric)
        return;
      const unsigned int h = dim * dim;
      matrix[h * size + h] = entry(2u, 2u, 2u, 2u);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            matrix[(dim * i + j) * size + h] = entry(i, j, 2u, 2u);
            matrix[h * size + dim * i + j]   = entry(2u, 2u, i, j);
          }
    }
  };
} // namespace impm

#endif
