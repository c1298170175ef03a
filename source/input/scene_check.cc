#include <impm/base/exceptions.h>
#include <impm/input/scene_sections.h>
#include <impm/points/point_fields.h>

#include <algorithm>
#include <sstream>

namespace impm
{
  namespace
  {
    std::string
    join(const std::vector<std::string> &names)
    {
      std::string all;
      for (const auto &name : names)
        all += (all.empty() ? "" : ", ") + name;
      return all.empty() ? "none" : all;
    }

    /**
     * What holds one component holds the normal only where the map leaves the
     * face a plane across its axis: looks at all vertices of the face.
     */
    template <int dim>
    void
    check_mapped_face(const GridSpec<dim> &grid,
                      const FaceSpec<dim> &face,
                      const unsigned int   number)
    {
      const unsigned int     normal = number / 2;
      dealii::Vector<double> image(dim);
      dealii::Point<dim>     lower, upper;
      unsigned int           n = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n *= d == normal ? 1 : grid.cells[d] + 1;
      for (unsigned int k = 0; k < n; ++k)
        {
          dealii::Point<dim> place;
          unsigned int       index = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              double share = number % 2;
              if (d != normal)
                {
                  share = 1. * (index % (grid.cells[d] + 1)) / grid.cells[d];
                  index /= grid.cells[d] + 1;
                }
              place[d] = (1 - share) * grid.lower_corner[d] +
                         share * grid.upper_corner[d];
            }
          grid.map->vector_value(place, image);
          for (unsigned int d = 0; d < dim; ++d)
            {
              lower[d] = k == 0 ? image[d] : std::min(lower[d], image[d]);
              upper[d] = k == 0 ? image[d] : std::max(upper[d], image[d]);
            }
        }
      if (!(upper[normal] - lower[normal] > 1e-10 * upper.distance(lower)))
        return;
      const std::string  type = !face.value      ? "slip" :
                                face.is_velocity ? "normal velocity" :
                                                   "normal displacement";
      std::ostringstream text;
      text << "found '" << type << "', which holds "
           << "xyz"[normal] << ", but Map makes this face reach from "
           << "xyz"[normal] << " = " << lower[normal] << " to " << upper[normal]
           << " m; allowed on a face that is no plane across its axis are "
              "free, fixed, displacement, velocity, traction";
      throw InputError("Boundary conditions/" + face.name + "/Type",
                       text.str());
    }

    /**
     * Whether a face is to move along its normal: looks at some instants of
     * the run, on a coarse lattice of the face.
     */
    template <int dim>
    bool
    moves_along_normal(const Scene<dim> &scene, const unsigned int number)
    {
      const auto        &face   = scene.faces[number];
      const unsigned int normal = number / 2;
      if (!face.value || !face.constrained[normal])
        return false;
      const unsigned int component = face.value->n_components == 1 ? 0 : normal;
      const unsigned int n_times = 16, n_places = dim == 2 ? 3 : 9;
      for (unsigned int k = 0; k < n_places; ++k)
        {
          dealii::Point<dim> place;
          unsigned int       index = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double share = d == normal ? number % 2 : 0.5 * (index % 3);
              if (d != normal)
                index /= 3;
              place[d] = (1 - share) * scene.grid.lower_corner[d] +
                         share * scene.grid.upper_corner[d];
            }
          face.value->set_time(0);
          const double start =
            face.is_velocity ? 0. : face.value->value(place, component);
          for (unsigned int i = 1; i <= n_times; ++i)
            {
              face.value->set_time(scene.time.end * i / n_times);
              if (face.value->value(place, component) != start)
                return true;
            }
        }
      return false;
    }
  } // namespace

  template <int dim>
  void
  warn_of_faces(Scene<dim> &scene)
  {
    if (scene.grid.method == GridMethod::lagrangian)
      return;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (!scene.faces[f].moves_grid && moves_along_normal(scene, f))
        scene.warnings.push_back(
          "face '" + scene.faces[f].name +
          "' is to move, but not the grid with it: the face holds the nodes of "
          "the cells at it as long as material is there, and nothing once the "
          "material has left them; see 'Moves the grid'");
  }

  void
  check_law(const Material    &material,
            const std::string &law,
            const GeometryKind geometry)
  {
    const bool plane_stress = geometry == GeometryKind::plane_stress;
    if (plane_stress && !material.is_solid())
      throw InputError("Law",
                       "found '" + law +
                         "', allowed in plane stress are laws of solids: "
                         "nothing holds the thickness of a fluid");
    if (!material.average_volume)
      return;
    if (plane_stress)
      throw InputError("F-bar",
                       "found 'true', allowed in plane stress is false: "
                       "there the thickness keeps the volume, nothing locks");
    if (material.form() != Material::Form::spatial)
      throw InputError("F-bar",
                       "found 'true', allowed with the law '" + law +
                         "' is false: the average is a derivative of the "
                         "energy of F, which this law does not have");
  }

  template <int dim>
  void
  check_scene(const Scene<dim> &scene)
  {
    bool deformable = false;
    for (const auto &body : scene.bodies)
      {
        deformable     = deformable || !body.rigid;
        const auto box = body.shape ? body.shape->bounding_box() : std::nullopt;
        if (!box || scene.grid.method == GridMethod::lagrangian)
          continue;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double lower = box->lower_bound(d),
                         upper = box->upper_bound(d);
            const double slack = 1e-10 * (upper - lower);
            if (lower < scene.grid.lower_corner[d] - slack ||
                upper > scene.grid.upper_corner[d] + slack)
              throw InputError(
                "Bodies/" + body.name + "/Shape",
                "body '" + body.name + "' reaches from " +
                  std::to_string(lower) + " to " + std::to_string(upper) +
                  " m in direction " + "xyz"[d] + ", allowed is the grid's " +
                  std::to_string(scene.grid.lower_corner[d]) + " to " +
                  std::to_string(scene.grid.upper_corner[d]) + " m");
          }
      }
    if (!deformable)
      throw InputError("Bodies/Names",
                       "found no deformable body, allowed is at least one");
    if (scene.geometry == GeometryKind::axisymmetric &&
        scene.grid.lower_corner[0] < 0)
      throw InputError("Grid/Lower corner",
                       "found a negative radius, allowed is r >= 0");

    for (const auto &body : scene.bodies)
      if (!body.rigid && !body.material->has_symmetric_tangent())
        {
          const std::string law =
            ", which needs a symmetric matrix, but the law of body '" +
            body.name + "' has none: allowed ";
          if (scene.solver.linear_solver == "CG")
            throw InputError("Solver/Linear solver",
                             "found 'CG'" + law + "are GMRES, direct");
          if (scene.solver.bfgs_updates > 0)
            throw InputError("Solver/Nonlinear solver",
                             "found 'BFGS'" + law + "is Newton");
        }

    if (scene.grid.map)
      for (unsigned int f = 0; f < 2 * dim; ++f)
        {
          const auto &held = scene.faces[f].constrained;
          if (std::count(held.begin(), held.end(), true) == 1)
            check_mapped_face(scene.grid, scene.faces[f], f);
        }

    unsigned int movers = 0;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (scene.faces[f].moves_grid && ++movers > 1)
        throw InputError("Boundary conditions/" + face_names()[f] +
                           "/Moves the grid",
                         "found a second face that moves the grid, allowed "
                         "is one");

    std::vector<std::string> carriers, movable, deformables;
    for (const auto &face : scene.faces)
      if (std::count(face.constrained.begin(), face.constrained.end(), true))
        {
          carriers.push_back(face.name);
          if (face.moves_grid)
            movable.push_back(face.name);
        }
    for (const auto &body : scene.bodies)
      if (body.rigid)
        {
          carriers.push_back(body.name);
          movable.push_back(body.name);
        }
      else
        deformables.push_back(body.name);
    const auto require = [](const std::vector<std::string> &allowed,
                            const std::string              &found,
                            const std::string              &entry) {
      if (std::find(allowed.begin(), allowed.end(), found) == allowed.end())
        throw InputError(entry,
                         "found '" + found +
                           "', allowed are: " + join(allowed));
    };
    for (const auto &traction : scene.tractions)
      require(deformables, traction.body, "Loads/" + traction.name + "/Body");
    for (const auto &reaction : scene.output.reactions)
      require(carriers, reaction.on, "Output/" + reaction.name + "/On");
    const auto require_plane = [](const std::string &field,
                                  const std::string &entry) {
      if (dim == 3 && is_plane_field(field))
        throw InputError(entry,
                         "found '" + field +
                           "', a field of the plane, which 3D does not have");
    };
    for (const auto &field : scene.output.point_fields)
      require_plane(field, "Output/Point fields");
    for (const auto &reference : scene.references)
      require_plane(reference.field, "Reference/" + reference.name + "/Field");
    for (const auto &probe : scene.output.probes)
      {
        require_plane(probe.field, "Output/" + probe.name + "/Field");
        if (probe.kind == ProbeSpec::Kind::motion)
          require(movable, probe.of, "Output/" + probe.name + "/Of");
        for (const auto &body : probe.bodies)
          require(deformables, body, "Output/" + probe.name + "/Bodies");
        if (probe.component >= dim && (probe.kind == ProbeSpec::Kind::extent ||
                                       probe.kind == ProbeSpec::Kind::motion))
          throw InputError("Output/" + probe.name + "/Component",
                           "found " + std::to_string(probe.component) +
                             ", allowed is less than " + std::to_string(dim));
      }
  }

  template void
  check_scene(const Scene<2> &);
  template void
  check_scene(const Scene<3> &);
  template void
  warn_of_faces(Scene<2> &);
  template void
  warn_of_faces(Scene<3> &);
} // namespace impm
