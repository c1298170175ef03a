#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <impm/output/quantities.h>
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
    static const auto names = []() {
      std::vector<std::string> all;
      for (const auto &field : point_quantities())
        all.push_back(field.name);
      return all;
    }();
    return names;
  }

  namespace
  {
    /** Scalars that laws keep. */
    bool
    is_in_the_history(const std::string &name)
    {
      return name == "equivalent_plastic_strain" || name == "damage" ||
             name == "opening" || name == "preconsolidation_pressure";
    }

    /** The displacement (m) of the nodes of a Lagrangian grid, at the points.
     */
    template <int dim>
    std::vector<Tensor<1, dim>>
    displacements_of_nodes(const MaterialPoints<dim> &points,
                           const BackgroundGrid<dim> &grid)
    {
      std::vector<Tensor<1, dim>> result(points.size());
      if (!grid.is_moved())
        return result;
      const Vector &u              = grid.nodal_state().displacement;
      const auto    discretization = grid.discretization();
      unsigned int  p              = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const auto nodes =
            discretization->nodes_of(discretization->with_dofs(
                                       particle.get_surrounding_cell()),
                                     points.layer(p));
          for (unsigned int v = 0; v < nodes.size(); ++v)
            {
              const double share = GeometryInfo<dim>::d_linear_shape_function(
                particle.get_reference_location(), v);
              for (unsigned int d = 0; d < dim; ++d)
                result[p][d] += share * u.local_element(dim * nodes[v] + d);
            }
          ++p;
        }
      return result;
    }
  } // namespace

  bool
  is_plane_field(const std::string &name)
  {
    return name == "principal_stress_difference" ||
           name == "photoelastic_fringe";
  }

  template <int dim>
  std::optional<PointField<dim>>
  make_point_field(const std::string         &name,
                   const MaterialPoints<dim> &points,
                   const double               fringe_number,
                   const BackgroundGrid<dim> *grid)
  {
    // The kinds of fields, each made of a function that gives its values.
    using Field       = PointField<dim>;
    const auto scalar = [&name](const auto &value) {
      return Field{name,
                   1,
                   [value](unsigned int p, const Point<dim> &, double *values) {
                     *values = value(p);
                   }};
    };
    const auto vector = [&name](const auto &value) {
      return Field{
        name, 3, [value](unsigned int p, const Point<dim> &x, double *values) {
          const Tensor<1, dim> v = value(p, x);
          std::copy_n(v.begin_raw(), dim, values);
        }};
    };
    const auto tensor = [&name](const auto &value) {
      return Field{name,
                   9,
                   [value](unsigned int p, const Point<dim> &, double *values) {
                     const Tensor<2, 3> t = value(p);
                     for (unsigned int i = 0; i < 9; ++i)
                       values[i] = t[i / 3][i % 3];
                   }};
    };

    // What several of them follow from.
    const auto F = [&points](const unsigned int p) {
      return deformation_gradient(points, p);
    };
    const auto tau = [&points, F](const unsigned int p) {
      const Tensor<2, 3>  unit = unit_symmetric_tensor<3>();
      std::vector<double> unused(points.history_size());
      Material::Response  response;
      const auto         &material = points.material(p);
      const double       *history  = points.fields(p) + points.offset_history;
      const auto          seen =
        material.expands() ?
                   material.cooled(F(p), history[material.expansion_offset]) :
                   F(p);
      material.evaluate_one({unit, seen, 0., history, unused.data()},
                            false,
                            response);
      return response.kirchhoff_stress;
    };
    const auto cauchy = [F, tau](const unsigned int p) {
      return tau(p) / determinant(F(p));
    };
    const auto energy = [&points, F](const unsigned int p) {
      return points.material(p).energy_of_point(F(p),
                                                points.fields(p) +
                                                  points.offset_history);
    };
    const auto stress_difference = [cauchy](const unsigned int p) {
      const auto stress = cauchy(p);
      return std::hypot(stress[0][0] - stress[1][1], 2 * stress[0][1]);
    };

    if (name == "position")
      return vector([](unsigned int, const Point<dim> &x) { return x; });
    if (name == "displacement" && points.offset_initial_position > 0)
      return vector([&points](unsigned int p, const Point<dim> &x) {
        return x - points.initial_position(p);
      });
    if (name == "displacement" && grid != nullptr && grid->is_lagrangian)
      {
        const auto all   = std::make_shared<std::vector<Tensor<1, dim>>>();
        auto       field = vector(
          [all](unsigned int p, const Point<dim> &) { return (*all)[p]; });
        field.prepare = [&points, grid, all]() {
          *all = displacements_of_nodes(points, *grid);
        };
        return field;
      }
    if (name == "velocity" && points.offset_velocity > 0)
      return vector([&points](unsigned int p, const Point<dim> &) {
        return points.velocity(p);
      });
    if (name == "cauchy_stress")
      return tensor(cauchy);
    if (name == "kirchhoff_stress")
      return tensor(tau);
    if (name == "von_mises_stress")
      return scalar([cauchy](unsigned int p) {
        return std::sqrt(1.5) * deviator(cauchy(p)).norm();
      });
    if (name == "pressure")
      return scalar([cauchy](unsigned int p) { return -trace(cauchy(p)) / 3; });
    if (const auto offset = points.layout.find(name);
        offset && is_in_the_history(name))
      return scalar([&points, offset = *offset](unsigned int p) {
        return points.fields(p)[offset];
      });
    if (name == "deformation_gradient")
      return tensor(F);
    if (const auto offset = points.layout.find(name);
        offset && name == "initial_domain")
      return vector(
        [&points, offset = *offset](unsigned int p, const Point<dim> &) {
          return points.vector(p, offset);
        });
    if (name == "volume")
      return scalar([&points, F](unsigned int p) {
        return points.initial_volume(p) * determinant(F(p));
      });
    if (name == "body")
      return scalar([&points](unsigned int p) { return points.body(p); });
    if (name == "id")
      return scalar([&points](unsigned int p) { return points.id(p); });
    if (const auto offset = points.layout.find(name);
        offset && name == "parent")
      return scalar([&points, offset = *offset](unsigned int p) {
        return points.fields(p)[offset];
      });
    if (name == "temperature" &&
        points.all_materials(
          [](const Material &material) { return material.has_temperature(); }))
      return scalar([&points, energy](unsigned int p) {
        return points.material(p).temperature(energy(p).dissipated,
                                              points.fields(p) +
                                                points.offset_history);
      });
    if (name == "internal_energy")
      return scalar([&points, energy](unsigned int p) {
        const auto now = energy(p);
        return (now.stored + now.dissipated) / points.material(p).density;
      });
    if (dim == 3)
      return std::nullopt;
    if (name == "principal_stress_difference")
      return scalar(stress_difference);
    if (name == "photoelastic_fringe")
      {
        const auto largest = std::make_shared<double>(0.);
        auto       field   = scalar([=](unsigned int p) {
          return *largest > 0 ? std::cos(2 * numbers::PI * fringe_number *
                                         stress_difference(p) / *largest) :
                                        1;
        });
        field.prepare      = [&points, stress_difference, largest]() {
          *largest = 0;
          for (unsigned int p = 0; p < points.size(); ++p)
            *largest = std::max(*largest, stress_difference(p));
          *largest = Utilities::MPI::max(*largest, points.communicator);
        };
        return field;
      }
    return std::nullopt;
  }

  template <int dim>
  double
  present_measure(const MaterialPoints<dim> &points,
                  const unsigned int         point,
                  const Point<dim>          &place)
  {
    const double start = points.initial_volume(point);
    if (dim == 3)
      return start * determinant(deformation_gradient(points, point));
    const double *F     = points.fields(point) + points.offset_deformation;
    const double around = points.layout.geometry == GeometryKind::axisymmetric ?
                            F[4] / (2 * numbers::PI * place[0]) :
                            1.;
    return start * around * (F[0] * F[3] - F[1] * F[2]);
  }

  template double
  present_measure(const MaterialPoints<2> &, unsigned int, const Point<2> &);
  template double
  present_measure(const MaterialPoints<3> &, unsigned int, const Point<3> &);
  template std::optional<PointField<2>>
  make_point_field(const std::string &,
                   const MaterialPoints<2> &,
                   double,
                   const BackgroundGrid<2> *);
  template std::optional<PointField<3>>
  make_point_field(const std::string &,
                   const MaterialPoints<3> &,
                   double,
                   const BackgroundGrid<3> *);
} // namespace impm
