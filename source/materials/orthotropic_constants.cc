#include <impm/base/exceptions.h>
#include <impm/materials/number_list.h>
#include <impm/materials/orthotropic_constants.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    const std::string youngs_moduli = "Young's moduli";
    const std::string poissons      = "Poisson's ratios";
    const std::string shear_moduli  = "Shear moduli";
    const std::string first_axis    = "First axis";
    const std::string second_axis   = "Second axis";

    [[noreturn]] void
    refuse(const ParameterHandler &prm,
           const std::string      &entry,
           const std::string      &allowed)
    {
      throw InputError(entry,
                       "found '" + prm.get(entry) + "', allowed " + allowed);
    }

    std::array<double, 3>
    three_numbers(const ParameterHandler &prm, const std::string &entry)
    {
      const auto list = number_list(prm, entry);
      if (list.size() != 3)
        refuse(prm, entry, "are three numbers");
      return {{list[0], list[1], list[2]}};
    }

    Tensor<1, 3>
    axis(const ParameterHandler &prm, const std::string &entry)
    {
      const auto         list = three_numbers(prm, entry);
      const Tensor<1, 3> vector({list[0], list[1], list[2]});
      if (!(vector.norm() > 0) || !std::isfinite(vector.norm()))
        refuse(prm, entry, "is a vector other than 0");
      return vector / vector.norm();
    }

    /** Whether an axis is along one of the coordinates, to round-off. */
    bool
    is_along(const Tensor<1, 3> &axis, const unsigned int coordinate)
    {
      return std::abs(axis[coordinate]) > 1 - 1e-12;
    }
  } // namespace

  void
  OrthotropicConstants::declare_parameters(ParameterHandler &prm,
                                           const Chosen &)
  {
    const Patterns::Double positive(1e-300);
    declare_number_list(prm,
                        youngs_moduli,
                        "1e9, 1e9, 1e9",
                        positive,
                        "E_1, E_2, E_3: of small strains along the axes of the "
                        "material (Pa), positive.");
    declare_number_list(prm,
                        poissons,
                        "0.3, 0.3, 0.3",
                        Patterns::Double(),
                        "nu_12, nu_23, nu_13: by how much a tension along the "
                        "first axis of a pair shrinks the second, over its own "
                        "strain; nu_ij^2 < E_i / E_j.");
    declare_number_list(prm,
                        shear_moduli,
                        "4e8, 4e8, 4e8",
                        positive,
                        "G_12, G_23, G_13 between the axes (Pa), positive.");
    declare_number_list(prm,
                        first_axis,
                        "1, 0, 0",
                        Patterns::Double(),
                        "Axis 1 of the material in the initial configuration, "
                        "of any length. In the plane one of the axes is "
                        "perpendicular to it; with axisymmetry all are along "
                        "r, z and the circumference, in this order.");
    declare_number_list(prm,
                        second_axis,
                        "0, 1, 0",
                        Patterns::Double(),
                        "Axis 2; what it has along the first is taken away. "
                        "Axis 3 is perpendicular to both.");
  }

  OrthotropicConstants
  OrthotropicConstants::from_parameters(ParameterHandler &prm)
  {
    OrthotropicConstants result;
    const auto           E  = three_numbers(prm, youngs_moduli);
    const auto           nu = three_numbers(prm, poissons);
    const auto           G  = three_numbers(prm, shear_moduli);
    result.young            = E;
    result.shear            = {{G[0], G[2], G[1]}};

    SymmetricTensor<2, 3> compliance;
    for (unsigned int i = 0; i < 3; ++i)
      compliance[i][i] = 1 / E[i];
    constexpr unsigned int pairs[3][2] = {{0, 1}, {1, 2}, {0, 2}};
    for (unsigned int k = 0; k < 3; ++k)
      {
        const auto [i, j]       = pairs[k];
        const std::string of[2] = {std::to_string(i + 1),
                                   std::to_string(j + 1)};
        if (!(nu[k] * nu[k] < E[i] / E[j]))
          refuse(prm,
                 poissons,
                 "is nu_" + of[0] + of[1] + "^2 < E_" + of[0] + " / E_" +
                   of[1] + " = " + std::to_string(E[i] / E[j]) +
                   ", or the energy of some strain is not positive");
        compliance[i][j] = -nu[k] / E[i];
      }
    // without units, of which the energy does not depend
    const double determinant_of_ratios =
      determinant(compliance) * E[0] * E[1] * E[2];
    if (!(determinant_of_ratios > 1e-12))
      refuse(prm,
             poissons,
             "is 1 - nu_12 nu_21 - nu_23 nu_32 - nu_13 nu_31 - 2 nu_21 nu_32 "
             "nu_13 > 0 with nu_ji = nu_ij E_j / E_i, here it is " +
               std::to_string(determinant_of_ratios) +
               ", or the energy of some strain is not positive");
    result.stiffness = Tensor<2, 3>(invert(compliance));

    const auto first = axis(prm, first_axis);
    auto       third = cross_product_3d(first, axis(prm, second_axis));
    if (!(third.norm() > 1e-6))
      refuse(prm,
             second_axis,
             "is a vector that is not parallel to '" + first_axis +
               "' = " + prm.get(first_axis));
    third /= third.norm();
    const auto second = cross_product_3d(third, first);
    for (unsigned int d = 0; d < 3; ++d)
      {
        result.axes[d][0] = first[d];
        result.axes[d][1] = second[d];
        result.axes[d][2] = third[d];
      }
    return result;
  }

  void
  OrthotropicConstants::check_axes(const GeometryKind geometry) const
  {
    std::array<unsigned int, 3> along{{0, 0, 0}}; // axes, by coordinate
    for (unsigned int a = 0; a < 3; ++a)
      {
        const Tensor<1, 3> axis({axes[0][a], axes[1][a], axes[2][a]});
        for (unsigned int d = 0; d < 3; ++d)
          along[d] += is_along(axis, d);
      }
    if (geometry == GeometryKind::axisymmetric &&
        along != std::array<unsigned int, 3>{{1, 1, 1}})
      throw InputError(first_axis,
                       "with '" + second_axis +
                         "' is not along r, z and the circumference, allowed "
                         "with axisymmetry are 1, 0, 0 and 0, 1, 0 and 0, 0, "
                         "1: a body with other axes would twist");
    if (geometry != GeometryKind::three_d && along[2] != 1)
      throw InputError(first_axis,
                       "with '" + second_axis +
                         "' leaves no axis perpendicular to the plane, allowed "
                         "are two axes in it, or one along 0, 0, 1: others "
                         "would be sheared out of it");
  }

  double
  OrthotropicConstants::longitudinal_modulus() const
  {
    // Waves along n have the eigenvalues of n C n (Christoffel); the directions
    // of one octant stand for all.
    constexpr unsigned int n_steps = 45;
    double                 largest = 0;
    for (unsigned int a = 0; a <= n_steps; ++a)
      for (unsigned int b = 0; b <= n_steps; ++b)
        {
          const double polar         = numbers::PI_2 * a / n_steps,
                       angle         = numbers::PI_2 * b / n_steps;
          const double          n[3] = {std::sin(polar) * std::cos(angle),
                                        std::sin(polar) * std::sin(angle),
                                        std::cos(polar)};
          SymmetricTensor<2, 3> acoustic;
          for (unsigned int i = 0; i < 3; ++i)
            {
              acoustic[i][i] += stiffness[i][i] * n[i] * n[i];
              for (unsigned int j = i + 1; j < 3; ++j)
                {
                  const double G = shear[i + j - 1];
                  acoustic[i][i] += G * n[j] * n[j];
                  acoustic[j][j] += G * n[i] * n[i];
                  acoustic[i][j] = (stiffness[i][j] + G) * n[i] * n[j];
                }
            }
          largest = std::max(largest, eigenvalues(acoustic)[0]);
        }
    return largest;
  }
} // namespace impm
