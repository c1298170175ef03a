#include <deal.II/base/mpi.h>

#include <impm/points/point_fields.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace impm
{
  using namespace dealii;

  const std::vector<std::string> &
  point_field_names()
  {
    static const std::vector<std::string> names = {
      "position",
      "displacement",
      "velocity",
      "cauchy_stress",
      "kirchhoff_stress",
      "von_mises_stress",
      "pressure",
      "equivalent_plastic_strain",
      "deformation_gradient",
      "volume",
      "body",
      "temperature",
      "internal_energy",
      "principal_stress_difference",
      "photoelastic_fringe"};
    return names;
  }

  bool
  is_plane_field(const std::string &name)
  {
    return name == "principal_stress_difference" ||
           name == "photoelastic_fringe";
  }

  template <int dim>
  Tensor<2, 3>
  deformation_gradient(const MaterialPoints<dim> &points,
                       const unsigned int         point)
  {
    return points.layout.load_tensor(points.fields(point) +
                                     points.offset_deformation);
  }

  template <int dim>
  SymmetricTensor<2, 3>
  kirchhoff_stress(const MaterialPoints<dim> &points, const unsigned int point)
  {
    const Tensor<2, 3>  unit = unit_symmetric_tensor<3>();
    std::vector<double> unused(points.history_size());
    Material::Response  response;
    points.material(point).evaluate_one({unit,
                                         deformation_gradient(points, point),
                                         0.,
                                         points.fields(point) +
                                           points.offset_history,
                                         unused.data()},
                                        false,
                                        response);
    return response.kirchhoff_stress;
  }

  template <int dim>
  std::optional<PointField<dim>>
  make_point_field(const std::string         &name,
                   const MaterialPoints<dim> &points,
                   const double               fringe_number)
  {
    const auto &layout = points.layout;
    const auto  cauchy = [&points](const unsigned int p) {
      return kirchhoff_stress(points, p) /
             determinant(deformation_gradient(points, p));
    };
    const auto tensor = [](const Tensor<2, 3> &t, double *values) {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          values[3 * i + j] = t[i][j];
    };
    const auto stored_vector = [&points, &layout](const std::string &field) {
      return [&points, offset = layout.offset(field)](const unsigned int p,
                                                      const Point<dim> &,
                                                      double *values) {
        std::copy_n(points.fields(p) + offset, dim, values);
      };
    };
    const auto stored_scalar = [&points, &layout](const std::string &field) {
      return [&points, offset = layout.offset(field)](const unsigned int p,
                                                      const Point<dim> &,
                                                      double *values) {
        values[0] = points.fields(p)[offset];
      };
    };

    using Field = PointField<dim>;
    if (name == "position")
      return Field{name,
                   3,
                   [](unsigned int, const Point<dim> &x, double *values) {
                     std::copy_n(x.begin_raw(), dim, values);
                   }};
    if (name == "displacement" && layout.has("initial_position"))
      return Field{name,
                   3,
                   [&points, offset = layout.offset("initial_position")](
                     unsigned int p, const Point<dim> &x, double *values) {
                     for (unsigned int d = 0; d < dim; ++d)
                       values[d] = x[d] - points.fields(p)[offset + d];
                   }};
    if (name == "velocity" && layout.has(name))
      return Field{name, 3, stored_vector(name)};
    if (name == "cauchy_stress")
      return Field{name,
                   9,
                   [cauchy, tensor](unsigned int p,
                                    const Point<dim> &,
                                    double *values) {
                     tensor(cauchy(p), values);
                   }};
    if (name == "kirchhoff_stress")
      return Field{name,
                   9,
                   [&points, tensor](unsigned int p,
                                     const Point<dim> &,
                                     double *values) {
                     tensor(kirchhoff_stress(points, p), values);
                   }};
    if (name == "von_mises_stress")
      return Field{
        name, 1, [cauchy](unsigned int p, const Point<dim> &, double *values) {
          values[0] = std::sqrt(1.5) * deviator(cauchy(p)).norm();
        }};
    if (name == "pressure")
      return Field{
        name, 1, [cauchy](unsigned int p, const Point<dim> &, double *values) {
          values[0] = -trace(cauchy(p)) / 3;
        }};
    if (name == "equivalent_plastic_strain" && layout.has(name))
      return Field{name, 1, stored_scalar(name)};
    if (name == "deformation_gradient")
      return Field{name,
                   9,
                   [&points, tensor](unsigned int p,
                                     const Point<dim> &,
                                     double *values) {
                     tensor(deformation_gradient(points, p), values);
                   }};
    if (name == "volume")
      return Field{
        name, 1, [&points](unsigned int p, const Point<dim> &, double *values) {
          values[0] = points.initial_volume(p) *
                      determinant(deformation_gradient(points, p));
        }};
    if (name == "body")
      return Field{name, 1, stored_scalar(name)};
    const auto energy = [&points](const unsigned int p) {
      return points.material(p).energy(deformation_gradient(points, p),
                                       points.fields(p) +
                                         points.offset_history);
    };
    if (name == "temperature" && points.have_temperature())
      return Field{
        name,
        1,
        [&points, energy](unsigned int p, const Point<dim> &, double *values) {
          const auto &material = points.material(p);
          values[0] =
            material.initial_temperature +
            energy(p).dissipated / (material.density * material.specific_heat);
        }};
    if (name == "internal_energy")
      return Field{
        name,
        1,
        [&points, energy](unsigned int p, const Point<dim> &, double *values) {
          const auto now = energy(p);
          values[0] =
            (now.stored + now.dissipated) / points.material(p).density;
        }};
    if (dim == 3)
      return std::nullopt;
    const auto stress_difference = [cauchy](const unsigned int p) {
      const auto stress = cauchy(p);
      return std::hypot(stress[0][0] - stress[1][1], 2 * stress[0][1]);
    };
    if (name == "principal_stress_difference")
      return Field{name,
                   1,
                   [stress_difference](unsigned int p,
                                       const Point<dim> &,
                                       double *values) {
                     values[0] = stress_difference(p);
                   }};
    if (name == "photoelastic_fringe")
      {
        const auto largest = std::make_shared<double>(0.);
        Field      field{name,
                    1,
                    [stress_difference, fringe_number, largest](
                      unsigned int p, const Point<dim> &, double *values) {
                      values[0] = *largest > 0 ?
                                         std::cos(2 * numbers::PI * fringe_number *
                                             stress_difference(p) / *largest) :
                                         1;
                    }};
        field.prepare = [&points, stress_difference, largest]() {
          *largest = 0;
          for (unsigned int p = 0; p < points.size(); ++p)
            *largest = std::max(*largest, stress_difference(p));
          *largest = Utilities::MPI::max(*largest, points.communicator);
        };
        return field;
      }
    return std::nullopt;
  }

  template std::optional<PointField<2>>
  make_point_field(const std::string &, const MaterialPoints<2> &, double);
  template std::optional<PointField<3>>
  make_point_field(const std::string &, const MaterialPoints<3> &, double);
  template SymmetricTensor<2, 3>
  kirchhoff_stress(const MaterialPoints<2> &, unsigned int);
  template SymmetricTensor<2, 3>
  kirchhoff_stress(const MaterialPoints<3> &, unsigned int);
  template Tensor<2, 3>
  deformation_gradient(const MaterialPoints<2> &, unsigned int);
  template Tensor<2, 3>
  deformation_gradient(const MaterialPoints<3> &, unsigned int);
} // namespace impm
