#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>
#include <impm/input/scene_sections.h>
#include <impm/materials/list.h>

#include <algorithm>
#include <set>

namespace impm
{
  using dealii::FunctionParser;
  using dealii::ParameterHandler;

  namespace
  {
    Constants
    read_constants(const ParameterHandler &prm)
    {
      Constants constants{{"pi", 3.14159265358979323846}};
      for (const auto &pair : split_names(prm.get("Constants")))
        {
          const auto parts = dealii::Utilities::split_string_list(pair, '=');
          try
            {
              if (parts.size() != 2)
                throw InputError("", "");
              constants[parts[0]] =
                dealii::Utilities::string_to_double(parts[1]);
            }
          catch (...)
            {
              throw InputError("Constants",
                               "found '" + pair +
                                 "', allowed is 'name = number'");
            }
        }
      return constants;
    }

    template <int dim>
    dealii::Point<dim>
    read_point(const ParameterHandler &prm, const std::string &entry)
    {
      const auto         values = get_numbers(prm, entry, dim);
      dealii::Point<dim> point;
      std::copy(values.begin(), values.end(), point.begin_raw());
      return point;
    }

    template <int dim>
    GridSpec<dim>
    read_grid(const ParameterHandler &prm, const Constants &constants)
    {
      GridSpec<dim> grid;
      grid.lower_corner = read_point<dim>(prm, "Lower corner");
      grid.upper_corner = read_point<dim>(prm, "Upper corner");
      const auto cells  = get_numbers(prm, "Cells", dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          grid.cells[d] = static_cast<unsigned int>(cells[d]);
          if (!(grid.lower_corner[d] < grid.upper_corner[d]))
            throw InputError("Upper corner",
                             "found '" + prm.get("Upper corner") +
                               "', allowed is a corner above 'Lower corner' "
                               "in every direction");
        }
      if (prm.get("Method") == "GIMP")
        {
          grid.method        = GridMethod::gimp;
          grid.boxes_stretch = prm.get("Boxes") == "stretched";
        }
      else if (prm.get("Method") == "Lagrangian")
        {
          grid.method = GridMethod::lagrangian;
          grid.map = read_expressions<dim>(prm, "Map", dim, false, constants);
        }
      grid.refinement_levels = prm.get_integer("Local refinements");
      if (grid.refinement_levels > 0)
        grid.refine_where =
          read_expressions<dim>(prm, "Refine where", 1, false, constants);
      if (grid.refinement_levels > 0 && grid.map)
        throw InputError("Map",
                         "found a map of a grid with local refinements, which "
                         "would gape at hanging nodes; allowed is one of both");
      return grid;
    }

    template <int dim>
    FaceSpec<dim>
    read_face(const ParameterHandler &prm,
              const unsigned int      face,
              const bool              lagrangian,
              const Constants        &constants)
    {
      FaceSpec<dim> spec;
      spec.name                 = face_names()[face];
      const std::string  type   = prm.get("Type");
      const unsigned int normal = face / 2;
      const bool only_normal = type == "slip" || type.rfind("normal", 0) == 0;
      for (unsigned int d = 0; d < dim; ++d)
        spec.constrained[d] = type != "free" && (!only_normal || d == normal);
      if (type == "free" || type == "fixed" || type == "slip")
        return spec;
      if (type == "traction")
        {
          if (!lagrangian)
            throw InputError("Type",
                             "found 'traction', which is for a Lagrangian "
                             "grid: only there is the face of the domain one "
                             "of the body");
          spec.constrained.fill(false);
          spec.traction =
            read_expressions<dim>(prm, "Value", dim, true, constants);
          return spec;
        }
      spec.is_velocity = type.find("velocity") != std::string::npos;
      spec.value       = read_expressions<dim>(
        prm, "Value", only_normal ? 1 : dim, true, constants);
      if (!spec.value)
        throw InputError("Value", "found '', allowed are expressions");
      spec.moves_grid = !lagrangian && prm.get_bool("Moves the grid");
      return spec;
    }

    /** One number for all directions, or one for each. */
    template <int dim>
    std::array<unsigned int, dim>
    read_points_per_cell(const ParameterHandler &prm)
    {
      const std::string entry   = "Points per cell";
      const bool        one     = split_names(prm.get(entry)).size() == 1;
      const auto        numbers = get_numbers(prm, entry, one ? 1 : dim);
      std::array<unsigned int, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = static_cast<unsigned int>(numbers[one ? 0 : d]);
      return result;
    }

    using NamedMaterials =
      std::map<std::string, std::shared_ptr<const Material>>;

    template <int dim>
    BodySpec<dim>
    read_body(const ParameterHandler &prm,
              const std::string      &name,
              const NamedShapes<dim> &shapes,
              const NamedMaterials   &materials,
              const bool              inertia,
              const bool              lagrangian,
              const Constants        &constants)
    {
      const auto pick = [&](const auto &choices, const std::string &entry) {
        const auto it = choices.find(prm.get(entry));
        if (it != choices.end())
          return it->second;
        std::string allowed;
        for (const auto &choice : choices)
          allowed += (allowed.empty() ? "" : ", ") + choice.first;
        throw InputError(entry,
                         "found '" + prm.get(entry) + "', allowed are: " +
                           (allowed.empty() ? "none, since none is named" :
                                              allowed));
      };

      BodySpec<dim> body;
      body.name  = name;
      body.rigid = prm.get("Kind") == "rigid";
      if (lagrangian && prm.get("Points from") != "shape")
        throw InputError("Points from",
                         "found 'file', allowed on a Lagrangian grid, where "
                         "points are Gauss points, is 'shape'");
      if (prm.get("Points from") == "shape")
        {
          body.shape = pick(shapes, "Shape");
          if (lagrangian && body.rigid)
            {
              if (!body.shape->is_box())
                throw InputError("Shape",
                                 "found '" + prm.get("Shape") +
                                   "', allowed for a rigid body on a "
                                   "Lagrangian grid, whose nodes stick to it, "
                                   "are boxes");
            }
          else
            body.points_per_cell = read_points_per_cell<dim>(prm);
        }
      else
        body.point_file = prm.get("File");
      if (body.rigid)
        {
          body.displacement =
            read_expressions<1>(prm, "Displacement", dim, true, constants);
          const std::string contact = prm.get("Contact");
          if (contact != "no slip")
            body.slip_normal = contact.back() - 'x';
          if (contact != "no slip" && body.slip_normal >= dim)
            throw InputError("Contact",
                             "found '" + contact +
                               "', allowed in 2D are no "
                               "slip, slip x, slip y");
        }
      else
        {
          body.material = pick(materials, "Material");
          if (inertia)
            body.velocity =
              read_expressions<dim>(prm, "Velocity", dim, false, constants);
        }
      return body;
    }

    template <int dim>
    TractionSpec<dim>
    read_traction(const ParameterHandler &prm,
                  const std::string      &name,
                  const Constants        &constants)
    {
      TractionSpec<dim> traction;
      traction.name   = name;
      traction.body   = prm.get("Body");
      traction.normal = prm.get("Normal")[0] - 'x';
      if (traction.normal >= dim)
        throw InputError("Normal",
                         "found '" + prm.get("Normal") +
                           "', allowed in 2D are x, y");
      traction.where = read_expressions<dim>(prm, "Where", 1, false, constants);
      traction.value =
        read_expressions<dim>(prm, "Value", dim, true, constants);
      if (!traction.where)
        throw InputError("Where", "found '', allowed is an expression");
      if (!traction.value)
        throw InputError("Value", "found '', allowed are expressions");
      traction.is_initial = prm.get("Coordinates") == "initial";
      return traction;
    }

    template <int dim>
    void
    read_loads(ParameterHandler &prm, Scene<dim> &scene)
    {
      scene.body_force =
        read_expressions<dim>(prm, "Body force", dim, true, scene.constants);
      scene.body_force_is_initial =
        scene.body_force && prm.get("Coordinates") == "initial";
      const std::string names = prm.get("Tractions");
      if (!names.empty() && scene.grid.method == GridMethod::lagrangian)
        throw InputError("Tractions",
                         "found '" + names +
                           "', allowed on a Lagrangian grid, which fits the "
                           "bodies, are faces of the domain with Type = "
                           "traction");
      std::set<std::string> taken;
      for (const auto &name : split_names(names))
        {
          if (!taken.insert(name).second)
            throw InputError("Tractions", "found '" + name + "' twice");
          in_section(prm, name, [&]() {
            scene.tractions.push_back(
              read_traction<dim>(prm, name, scene.constants));
          });
        }
    }

    /** Of a material; 0 where it has none. */
    double
    read_specific_heat(const ParameterHandler &prm)
    {
      if (prm.get("Specific heat").empty())
        return 0;
      const double heat = get_numbers(prm, "Specific heat", 1)[0];
      if (!(heat > 0))
        throw InputError("Specific heat",
                         "found '" + prm.get("Specific heat") +
                           "', allowed is a number greater than 0, or nothing");
      return heat;
    }

    /** Whether a picture, a probe or a reference has photoelastic fringes. */
    template <int dim>
    bool
    shows_fringes(const Scene<dim> &scene)
    {
      const auto is_fringe = [](const auto &item) {
        return item.field == "photoelastic_fringe";
      };
      const auto &output = scene.output;
      return std::count(output.point_fields.begin(),
                        output.point_fields.end(),
                        "photoelastic_fringe") > 0 ||
             std::any_of(output.probes.begin(),
                         output.probes.end(),
                         is_fringe) ||
             std::any_of(scene.references.begin(),
                         scene.references.end(),
                         is_fringe);
    }
  } // namespace

  int
  scene_dimension(ParameterHandler &prm)
  {
    return prm.get({"Geometry"}, "Kind") == "3D" ? 3 : 2;
  }

  template <int dim>
  Scene<dim>
  read_scene(ParameterHandler &prm, const std::string &parameter_file)
  {
    Scene<dim> scene;
    in_section(prm, "General", [&]() {
      scene.title     = prm.get("Title");
      scene.constants = read_constants(prm);
    });

    NamedShapes<dim> shapes;
    in_section(prm, "Geometry", [&]() {
      const std::string kind = prm.get("Kind");
      scene.geometry         = kind == "3D"           ? GeometryKind::three_d :
                               kind == "axisymmetric" ? GeometryKind::axisymmetric :
                               kind == "plane stress" ? GeometryKind::plane_stress :
                                                        GeometryKind::plane_strain;
      for (const auto &name : split_names(prm.get("Shapes")))
        in_section(prm, name, [&]() {
          for (const auto &entry : shape_list<dim>())
            if (entry.name == prm.get("Kind"))
              shapes[name] = entry.create(prm, scene.constants, shapes);
        });
    });
    in_section(prm, "Grid", [&]() {
      scene.grid = read_grid<dim>(prm, scene.constants);
    });

    const bool lagrangian = scene.grid.method == GridMethod::lagrangian;

    // Points carry the history of the laws that some body has, not of others.
    std::set<std::string> used;
    in_section(prm, "Bodies", [&]() {
      for (const auto &name : split_names(prm.get("Names")))
        in_section(prm, name, [&]() {
          if (prm.get("Kind") != "rigid")
            used.insert(prm.get("Material"));
        });
    });
    scene.history.emplace(scene.geometry);
    NamedMaterials materials;
    in_section(prm, "Materials", [&]() {
      for (const auto &name : split_names(prm.get("Names")))
        in_section(prm, name, [&]() {
          MaterialSpec spec{prm.get_double("Density"),
                            prm.get_bool("F-bar"),
                            read_specific_heat(prm)};
          if (spec.specific_heat > 0)
            spec.initial_temperature = prm.get_double("Initial temperature");
          PointLayout unused(scene.geometry);
          for (const auto &entry : material_list())
            if (entry.name == prm.get("Law"))
              materials[name] =
                entry.create(prm,
                             spec,
                             used.count(name) ? *scene.history : unused);
          check_law(*materials[name], prm.get("Law"), scene.geometry);
        });
    });
    in_section(prm, "Time", [&]() { scene.time = read_time(prm, lagrangian); });
    in_section(prm, "Bodies", [&]() {
      std::set<std::string> taken(face_names().begin(), face_names().end());
      for (const auto &name : split_names(prm.get("Names")))
        {
          if (!taken.insert(name).second)
            throw InputError("Names",
                             "found '" + name +
                               "', which is taken by a face or another body");
          in_section(prm, name, [&]() {
            scene.bodies.push_back(read_body<dim>(prm,
                                                  name,
                                                  shapes,
                                                  materials,
                                                  scene.has_inertia(),
                                                  lagrangian,
                                                  scene.constants));
          });
        }
    });
    in_section(prm, "Boundary conditions", [&]() {
      for (unsigned int f = 0; f < 2 * dim; ++f)
        in_section(prm, face_names()[f], [&]() {
          scene.faces[f] = read_face<dim>(prm, f, lagrangian, scene.constants);
        });
    });
    in_section(prm, "Loads", [&]() { read_loads(prm, scene); });
    const bool explicit_steps = scene.time.integrator == "explicit";
    if (!explicit_steps)
      in_section(prm, "Solver", [&]() {
        scene.solver = read_solver(prm, scene.time);
      });
    scene.stabilization = {0, 0};
    if (!lagrangian && !explicit_steps)
      in_section(prm, "Stabilization", [&]() {
        scene.stabilization.ghost_penalty = prm.get_double("Ghost penalty");
        scene.stabilization.isolated_stiffness =
          scene.has_inertia() ? 0. : prm.get_double("Isolated stiffness");
      });
    in_section(prm, "Output", [&]() {
      scene.output = read_output<dim>(prm, scene.constants);
    });
    in_section(prm, "Reference", [&]() {
      scene.references =
        read_references<dim>(prm, scene.constants, parameter_file);
    });
    if (shows_fringes(scene))
      scene.output.fringe_number = prm.get_double({"Output"}, "Fringe number");
    check_scene(scene);
    warn_of_faces(scene);
    if (scene.time.integrator == "theta" && scene.time.theta == 0)
      scene.warnings.push_back(
        "with Theta = 0 steps are explicit, so that the sections Solver and "
        "Stabilization do nothing; 'Integrator = explicit' is cheaper");
    // Nothing else holds what no body and no other shape uses.
    for (const auto &[name, shape] : shapes)
      if (shape.use_count() == 1)
        scene.warnings.push_back("shape '" + name + "' is used by no body");
    for (const auto &[name, material] : materials)
      if (material.use_count() == 1)
        scene.warnings.push_back("material '" + name + "' is used by no body");
    return scene;
  }

  template Scene<2>
  read_scene<2>(ParameterHandler &, const std::string &);
  template Scene<3>
  read_scene<3>(ParameterHandler &, const std::string &);
} // namespace impm
