#include <impm/base/exceptions.h>
#include <impm/input/scene_sections.h>
#include <impm/points/point_fields.h>

#include <algorithm>

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
  } // namespace

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
} // namespace impm
