#include <deal.II/base/utilities.h>

#include <impm/exceptions.h>
#include <impm/expressions.h>
#include <impm/materials/list.h>
#include <impm/scene.h>

#include <algorithm>
#include <set>

namespace impm
{
  using dealii::FunctionParser;
  using dealii::ParameterHandler;

  namespace
  {
    using Constants = std::map<std::string, double>;

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

    template <int dim>
    BodySpec<dim>
    read_body(const ParameterHandler                                 &prm,
              const std::string                                      &name,
              const NamedShapes<dim>                                 &shapes,
              const std::map<std::string, std::shared_ptr<Material>> &materials,
              const bool                                              inertia,
              const bool       lagrangian,
              const Constants &constants)
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
      if (lagrangian && body.rigid)
        throw InputError("Kind",
                         "found 'rigid', allowed on a Lagrangian grid is "
                         "'deformable'");
      if (lagrangian && prm.get("Points from") != "shape")
        throw InputError("Points from",
                         "found 'file', allowed on a Lagrangian grid, where "
                         "points are Gauss points, is 'shape'");
      if (prm.get("Points from") == "shape")
        {
          body.shape           = pick(shapes, "Shape");
          body.points_per_cell = prm.get_integer("Points per cell");
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

    TimeSpec
    read_time(const ParameterHandler &prm, const bool lagrangian)
    {
      TimeSpec time;
      time.integrator = prm.get("Integrator");
      if (time.integrator == "theta")
        time.theta = prm.get_double("Theta");
      if (time.integrator == "explicit")
        time.theta = 0;
      if (!lagrangian && time.integrator != "quasi-static")
        time.momentum_formulation = prm.get("Formulation") == "momentum";
      if (time.integrator == "Newmark")
        {
          time.beta               = prm.get_double("Beta");
          time.gamma              = prm.get_double("Gamma");
          time.keeps_acceleration = prm.get("Acceleration from") == "points";
        }
      if (lagrangian)
        time.transfer = TransferKind::pic; // points only show the motion
      else if (time.integrator != "quasi-static")
        {
          const std::string transfer = prm.get("Transfer");
          time.transfer              = transfer == "FLIP" ? TransferKind::flip :
                                       transfer == "PIC"  ? TransferKind::pic :
                                                            TransferKind::apic;
          if (time.momentum_formulation && transfer != "FLIP")
            throw InputError("Transfer",
                             "found '" + transfer +
                               "', allowed in the momentum formulation, which "
                               "maps changes of velocity, is FLIP");
        }
      time.end = prm.get_double("End time");
      if (time.integrator != "quasi-static")
        time.cfl_number = prm.get_double("CFL number");
      const std::string step_entry =
        time.cfl_number > 0 ? "CFL number" : "Time step";
      time.step         = prm.get_double(step_entry);
      time.growth       = prm.get_double("Growth");
      time.largest_step = time.step;
      if (!prm.get("Largest time step").empty())
        time.largest_step = get_numbers(prm, "Largest time step", 1)[0];
      if (time.largest_step < time.step)
        throw InputError("Largest time step",
                         "found '" + prm.get("Largest time step") +
                           "', allowed is at least '" + step_entry +
                           "' = " + prm.get(step_entry));
      if (time.growth > 1 && time.largest_step == time.step)
        throw InputError("Growth",
                         "found '" + prm.get("Growth") +
                           "', which does nothing without a 'Largest time "
                           "step' above '" +
                           step_entry + "'");
      time.smallest_step           = prm.get_double("Smallest time step");
      time.largest_number_of_steps = prm.get_integer("Largest number of steps");
      return time;
    }

    SolverSpec
    read_solver(const ParameterHandler &prm, const TimeSpec &time)
    {
      SolverSpec        solver;
      const std::string scale  = prm.get("Residual scale");
      solver.residual_scale    = scale == "body" ? ResidualScale::body :
                                 scale == "cell" ? ResidualScale::cell :
                                                   ResidualScale::momentum;
      solver.newton_tolerance  = prm.get_double("Newton tolerance");
      solver.newton_reduction  = prm.get_double("Newton reduction");
      solver.newton_iterations = prm.get_integer("Newton iterations");
      solver.line_search       = prm.get_bool("Line search");
      solver.linear_solver     = prm.get("Linear solver");
      if (time.momentum_formulation && solver.linear_solver != "GMRES")
        throw InputError("Linear solver",
                         "found '" + solver.linear_solver +
                           "', allowed with the momentum formulation, whose "
                           "tangent is unsymmetric and never a matrix, is "
                           "GMRES");
      if (solver.linear_solver != "direct")
        {
          solver.linear_tolerance  = prm.get_double("Linear tolerance");
          solver.linear_iterations = prm.get_integer("Linear iterations");
          solver.preconditioner    = prm.get("Preconditioner");
          const std::string kind   = prm.get("Operator");
          solver.tangent           = kind == "matrix" ? TangentKind::matrix :
                                     kind == "matrix-free" ?
                                                        TangentKind::matrix_free :
                                                        TangentKind::difference_quotient;
          if (solver.tangent == TangentKind::difference_quotient)
            solver.difference_step = prm.get_double("Difference step");
          const std::string unfinished = prm.get("Unfinished solves");
          if (time.momentum_formulation && unfinished == "direct solver")
            throw InputError("Unfinished solves",
                             "found 'direct solver', allowed with the momentum "
                             "formulation, whose tangent is never a matrix, is "
                             "'next Newton step'");
          solver.accept_unfinished =
            time.momentum_formulation || unfinished == "next Newton step";
        }
      if (solver.linear_solver == "GMRES")
        solver.gmres_directions = prm.get_integer("GMRES directions");
      return solver;
    }

    template <int dim>
    ProbeSpec
    read_probe(const ParameterHandler &prm,
               const std::string      &name,
               const Constants        &constants)
    {
      const std::vector<std::string> kinds = {
        "point", "largest", "smallest", "spread", "mean", "extent", "motion"};
      const std::string kind = prm.get("Kind");

      ProbeSpec probe;
      probe.name = name;
      probe.kind = static_cast<ProbeSpec::Kind>(
        std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
      if (kind == "point")
        probe.position = get_numbers(prm, "Position", dim);
      else if (kind == "motion")
        probe.of = prm.get("Of");
      else
        {
          probe.bodies = split_names(prm.get("Bodies"));
          const std::shared_ptr<FunctionParser<dim>> where =
            read_expressions<dim>(prm, "Where", 1, false, constants);
          if (where)
            probe.where = [where](const double *initial_position) {
              dealii::Point<dim> place;
              std::copy_n(initial_position, dim, place.begin_raw());
              return where->value(place);
            };
        }
      if (kind != "motion" && kind != "extent")
        probe.field = prm.get("Field");
      probe.component = prm.get_integer("Component");
      probe.factor    = prm.get_double("Factor");
      return probe;
    }

    template <int dim>
    OutputSpec
    read_output(ParameterHandler &prm, const Constants &constants)
    {
      OutputSpec output;
      output.directory        = prm.get("Directory");
      output.pictures         = prm.get_bool("Pictures");
      output.picture_interval = 0;
      output.picture_steps    = 1;
      output.row_steps        = prm.get_integer("Steps between rows");
      if (output.pictures)
        {
          output.picture_interval = prm.get_double("Time between pictures");
          if (output.picture_interval == 0)
            output.picture_steps = prm.get_integer("Steps between pictures");
          output.point_fields = split_names(prm.get("Point fields"));
        }
      for (const auto &name : split_names(prm.get("Probes")))
        in_section(prm, name, [&]() {
          output.probes.push_back(read_probe<dim>(prm, name, constants));
        });
      for (const auto &name : split_names(prm.get("Reactions")))
        in_section(prm, name, [&]() {
          output.reactions.push_back({name,
                                      prm.get("On"),
                                      get_numbers(prm, "Direction", dim),
                                      prm.get_double("Factor")});
        });
      return output;
    }

    std::string
    join(const std::vector<std::string> &names)
    {
      std::string all;
      for (const auto &name : names)
        all += (all.empty() ? "" : ", ") + name;
      return all.empty() ? "none" : all;
    }

    /** What a law can be asked for. */
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

    /** What no single section can tell. */
    template <int dim>
    void
    check(const Scene<dim> &scene)
    {
      bool deformable = false;
      for (const auto &body : scene.bodies)
        {
          deformable = deformable || !body.rigid;
          const auto box =
            body.shape ? body.shape->bounding_box() : std::nullopt;
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
        if (!body.rigid && scene.solver.linear_solver == "CG" &&
            !body.material->has_symmetric_tangent())
          throw InputError("Solver/Linear solver",
                           "found 'CG', which needs a symmetric matrix, but "
                           "the law of body '" +
                             body.name +
                             "' has none: allowed are GMRES, direct");

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
      for (const auto &probe : scene.output.probes)
        {
          if (probe.kind == ProbeSpec::Kind::motion)
            require(movable, probe.of, "Output/" + probe.name + "/Of");
          for (const auto &body : probe.bodies)
            require(deformables, body, "Output/" + probe.name + "/Bodies");
          if (probe.component >= dim &&
              (probe.kind == ProbeSpec::Kind::extent ||
               probe.kind == ProbeSpec::Kind::motion))
            throw InputError("Output/" + probe.name + "/Component",
                             "found " + std::to_string(probe.component) +
                               ", allowed is less than " + std::to_string(dim));
        }
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

    std::map<std::string, std::shared_ptr<Material>> materials;
    in_section(prm, "Materials", [&]() {
      for (const auto &name : split_names(prm.get("Names")))
        in_section(prm, name, [&]() {
          for (const auto &entry : material_list())
            if (entry.name == prm.get("Law"))
              materials[name] = entry.create(prm);
          materials[name]->average_volume = prm.get_bool("F-bar");
          check_law(*materials[name], prm.get("Law"), scene.geometry);
          materials[name]->specific_heat = read_specific_heat(prm);
          if (materials[name]->specific_heat > 0)
            materials[name]->initial_temperature =
              prm.get_double("Initial temperature");
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
    check(scene);
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
