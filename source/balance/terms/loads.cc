#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <impm/balance/terms/loads.h>
#include <impm/base/exceptions.h>
#include <impm/contact/surface_points.h>
#include <impm/footprints/transfer.h>
#include <impm/input/expressions.h>

#include <algorithm>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    void
    subtract_forces_on_points(const LoadsSpec<dim>      &spec,
                              const MaterialPoints<dim> &points,
                              const Footprints<dim>     &footprints,
                              const double               instant,
                              Vector                    &load)
    {
      std::vector<Tensor<1, dim>> forces(points.size());
      dealii::Vector<double>      value(dim);
      // a density, times its amount at every point
      const auto subtract =
        [&](auto &density, const bool is_initial, const auto &amount) {
          density.set_time(instant);
          const bool varies = !is_uniform(density);
          if (!varies)
            density.vector_value(Point<dim>(), value);
          unsigned int next = 0;
          for (const auto &particle : points.sorted.particles)
            {
              const unsigned int p = next++;
              if (amount(p) == 0)
                continue;
              if (varies)
                density.vector_value(is_initial ? points.initial_position(p) :
                                                  particle.get_location(),
                                     value);
              for (unsigned int c = 0; c < dim; ++c)
                forces[p][c] -= amount(p) * value[c];
            }
        };
      if (spec.body_force && !is_uniform(*spec.body_force))
        subtract(*spec.body_force,
                 spec.body_force_is_initial,
                 [&](const unsigned int p) { return points.mass(p); });
      for (const auto &traction : spec.tractions)
        {
          const auto area = points.layout.offset(traction_field(traction));
          subtract(*traction.value,
                   traction.is_initial,
                   [&](const unsigned int p) {
                     return points.fields(p)[area];
                   });
        }
      footprints.spread(forces, load);
    }

    template <int dim>
    void
    subtract_forces_on_surfaces(const std::vector<SurfaceLoadSpec<dim>> &loads,
                                const SurfacePoints<dim> &surfaces,
                                const Footprints<dim>    &footprints,
                                const double              instant,
                                Vector                   &load)
    {
      std::vector<Tensor<1, dim>> forces(surfaces.size());
      dealii::Vector<double>      value(dim);
      for (unsigned int l = 0; l < loads.size(); ++l)
        {
          if (loads[l].kind != SurfaceLoadKind::dead)
            continue;
          auto &traction = *loads[l].value;
          traction.set_time(instant);
          unsigned int next = 0;
          for (const auto &particle : surfaces.sorted.particles)
            if (const unsigned int s = next++; surfaces.carries(s, l))
              {
                traction.vector_value(loads[l].is_initial ?
                                        surfaces.initial_position(s) :
                                        surfaces.place(particle),
                                      value);
                for (unsigned int c = 0; c < dim; ++c)
                  forces[s][c] -= surfaces.initial_area(s) * value[c];
              }
        }
      footprints.spread(forces, load);
    }

    template <int dim>
    void
    subtract_forces_on_faces(const Scene<dim>          &scene,
                             const BackgroundGrid<dim> &grid,
                             const PopulatedCells<dim> &populated,
                             const double               instant,
                             Vector                    &load)
    {
      const FE_Q<dim>        fe(1);
      FEFaceValues<dim>      values(*grid.mapping,
                               fe,
                               QGauss<dim - 1>(3),
                               update_values | update_quadrature_points |
                                 update_JxW_values);
      dealii::Vector<double> traction(dim);
      for (const auto &[cell, layer, nodes] : populated.cells)
        for (const unsigned int f : cell->face_indices())
          {
            if (!cell->face(f)->at_boundary())
              continue;
            const auto &face = scene.faces[cell->face(f)->boundary_id()];
            if (!face.traction)
              continue;
            face.traction->set_time(instant);
            values.reinit(
              typename Triangulation<dim>::active_cell_iterator(cell), f);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const auto &x = values.quadrature_point(q);
                face.traction->vector_value(x, traction);
                const double around =
                  scene.geometry == GeometryKind::axisymmetric ?
                    2 * numbers::PI * x[0] :
                    1.;
                for (unsigned int v = 0; v < nodes.size(); ++v)
                  for (unsigned int c = 0; c < dim; ++c)
                    load.local_element(dim * nodes[v] + c) -=
                      around * values.JxW(q) * values.shape_value(v, q) *
                      traction[c];
              }
          }
    }

    template <int dim>
    bool
    is_steady(const Scene<dim> &scene)
    {
      const auto changes = [](const auto &density) {
        return density && names_any_of(*density, "t|rand|rand_seed");
      };
      return !changes(scene.loads.body_force) &&
             std::none_of(scene.loads.tractions.begin(),
                          scene.loads.tractions.end(),
                          [&](const auto &traction) {
                            return changes(traction.value);
                          }) &&
             std::none_of(scene.loads.on_surfaces.begin(),
                          scene.loads.on_surfaces.end(),
                          [&](const auto &load) {
                            return load.kind == SurfaceLoadKind::dead &&
                                   changes(load.value);
                          }) &&
             std::none_of(scene.faces.begin(),
                          scene.faces.end(),
                          [&](const auto &face) {
                            return changes(face.traction);
                          });
    }

    /** Whether each point has its own: all but a body force that is the same
     * everywhere, which the mass of the nodes feels. */
    template <int dim>
    bool
    acts_on_points(const Scene<dim> &scene)
    {
      const auto &loads = scene.loads;
      return (loads.body_force && !is_uniform(*loads.body_force)) ||
             !loads.tractions.empty();
    }

    template <int dim>
    bool
    acts_on_surfaces(const Scene<dim> &scene)
    {
      const auto &loads = scene.loads.on_surfaces;
      return std::any_of(loads.begin(), loads.end(), [](const auto &load) {
        return load.kind == SurfaceLoadKind::dead;
      });
    }

    template <int dim>
    bool
    acts_on_nodes(const Scene<dim> &scene)
    {
      return scene.loads.body_force && is_uniform(*scene.loads.body_force);
    }

    template <int dim>
    void
    subtract_forces_on_nodes(const LoadsSpec<dim> &spec,
                             const Vector         &mass,
                             const double          instant,
                             Vector               &load)
    {
      dealii::Vector<double> value(dim);
      spec.body_force->set_time(instant);
      spec.body_force->vector_value(Point<dim>(), value);
      for (unsigned int i = 0; i < load.locally_owned_size(); ++i)
        load.local_element(i) -= mass.local_element(i) * value[i % dim];
    }

    template <int dim>
    bool
    acts_on_faces(const Scene<dim> &scene)
    {
      return std::any_of(scene.faces.begin(),
                         scene.faces.end(),
                         [](const auto &face) {
                           return face.traction != nullptr;
                         });
    }
  } // namespace

  template <int dim>
  bool
  Loads<dim>::exist_in(const Scene<dim> &scene)
  {
    return acts_on_points(scene) || acts_on_surfaces(scene) ||
           acts_on_nodes(scene) || acts_on_faces(scene);
  }

  template <int dim>
  double
  Loads<dim>::energy(const Vector &u, const Vector & /*felt*/) const
  {
    return std::inner_product(at_end.begin(), at_end.end(), u.begin(), 0.);
  }

  template <int dim>
  Loads<dim>::Loads(const Scene<dim>          &scene,
                    const BackgroundGrid<dim> &grid,
                    const MaterialPoints<dim> &points,
                    const Footprints<dim>     &footprints,
                    const PopulatedCells<dim> &populated,
                    const Discretization<dim> &discretization,
                    const SurfacePoints<dim>  *surfaces,
                    const Footprints<dim>     *surface_prints,
                    const Vector              &mass,
                    const double               from,
                    const double               to)
  {
    Vector own_mass;
    if (acts_on_nodes(scene) && mass.size() == 0)
      own_mass = gather_mass(points, footprints, discretization);
    const auto gather = [&](const double instant, Vector &load) {
      discretization.initialize(load);
      if (acts_on_points(scene))
        subtract_forces_on_points(
          scene.loads, points, footprints, instant, load);
      if (acts_on_surfaces(scene))
        subtract_forces_on_surfaces(
          scene.loads.on_surfaces, *surfaces, *surface_prints, instant, load);
      if (acts_on_faces(scene))
        subtract_forces_on_faces(scene, grid, populated, instant, load);
      load.compress(VectorOperation::add);
      discretization.condense_hanging(load);
      if (acts_on_nodes(scene))
        subtract_forces_on_nodes(scene.loads,
                                 mass.size() > 0 ? mass : own_mass,
                                 instant,
                                 load);
    };
    gather(from, at_start);
    if (is_steady(scene))
      at_end = at_start;
    else
      gather(to, at_end);
  }

  template <int dim>
  std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<dim>      &tractions,
                               const MaterialPoints<dim> &points)
  {
    std::vector<types::particle_index> counts;
    for (const auto &traction : tractions)
      {
        const unsigned int area =
          points.layout.offset(traction_field(traction));
        types::particle_index n = 0;
        for (unsigned int p = 0; p < points.size(); ++p)
          n += points.fields(p)[area] > 0;
        counts.push_back(Utilities::MPI::sum(n, points.communicator));
        if (counts.back() == 0)
          throw InputError("Loads/" + traction.name + "/Where",
                           "found no point of body '" + traction.body +
                             "' where the expression is positive, allowed is "
                             "one that picks a layer of points: they lie "
                             "inside the surface, the first half their extent");
      }
    return counts;
  }

  template class Loads<2>;
  template class Loads<3>;
  template std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<2> &, const MaterialPoints<2> &);
  template std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<3> &, const MaterialPoints<3> &);
} // namespace impm
