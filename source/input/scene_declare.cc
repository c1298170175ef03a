#include <deal.II/base/patterns.h>

#include <impm/input/scene_sections.h>
#include <impm/materials/list.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    std::string
    names_of(const std::vector<std::string> &names)
    {
      std::string all;
      for (const auto &name : names)
        all += (all.empty() ? "" : "|") + name;
      return all;
    }

    template <typename Entry>
    std::string
    names_of(const std::vector<Entry> &entries)
    {
      std::vector<std::string> names;
      for (const auto &entry : entries)
        names.push_back(entry.name);
      return names_of(names);
    }

    void
    declare_general(ParameterHandler &prm)
    {
      prm.enter_subsection("General");
      prm.declare_entry("Title", "", Patterns::Anything(), "One line on it.");
      prm.declare_entry("Constants",
                        "",
                        Patterns::Anything(),
                        "Named numbers for the expressions of this file: "
                        "'speed = 1, height = 0.015'.");
      prm.leave_subsection();
    }

    template <int dim>
    void
    declare_shape(ParameterHandler            &prm,
                  const ParameterFile::Chosen &chosen,
                  const std::string           &name)
    {
      prm.enter_subsection(name);
      prm.declare_entry("Kind",
                        "box",
                        Patterns::Selection(names_of(shape_list<dim>())),
                        "What the shape is.");
      const auto kind = chosen("Geometry/" + name + "/Kind", "box");
      for (const auto &entry : shape_list<dim>())
        if (entry.name == kind)
          entry.declare(prm);
      prm.leave_subsection();
    }

    void
    declare_geometry(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Geometry");
      prm.declare_entry("Kind",
                        "plane strain",
                        Patterns::Selection(
                          "plane strain|plane stress|axisymmetric|3D"),
                        "Plane strain: x, y, forces per metre of thickness. "
                        "Plane stress: the same of a sheet, per metre of its "
                        "initial thickness, which is free to change. "
                        "Axisymmetric: r, z, forces of the whole circle.");
      prm.declare_entry("Shapes",
                        "",
                        Patterns::Anything(),
                        "Names of the shapes, each with a subsection.");
      for (const auto &name : split_names(chosen("Geometry/Shapes", "")))
        if (chosen("Geometry/Kind", "") == "3D")
          declare_shape<3>(prm, chosen, name);
        else
          declare_shape<2>(prm, chosen, name);
      prm.leave_subsection();
    }

    void
    declare_grid(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Grid");
      prm.declare_entry("Lower corner",
                        "",
                        Patterns::Anything(),
                        "Of the domain (m).");
      prm.declare_entry("Upper corner",
                        "",
                        Patterns::Anything(),
                        "Of the domain (m).");
      prm.declare_entry("Cells",
                        "10, 10",
                        Patterns::List(Patterns::Integer(1), 2, 3),
                        "Number of cells in each direction.");
      prm.declare_entry("Method",
                        "MPM",
                        Patterns::Selection("MPM|GIMP|Lagrangian"),
                        "What a material point is to the grid. MPM: a place. "
                        "GIMP: a box, so that forces change smoothly when "
                        "it crosses into the next cell. Lagrangian: a Gauss "
                        "point of a grid that fits the bodies and goes with "
                        "them, that is, finite elements.");
      if (may_be(chosen("Grid/Method", "MPM"), "Lagrangian"))
        prm.declare_entry("Map",
                          "",
                          Patterns::Anything(),
                          "Where a place x, y, z of the domain really is (m): "
                          "one expression for each direction, between "
                          "semicolons; empty: there.");
      if (may_be(chosen("Grid/Method", "MPM"), "GIMP"))
        prm.declare_entry("Boxes",
                          "stretched",
                          Patterns::Selection("stretched|fixed"),
                          "Whether the boxes of the points stretch with them "
                          "(with the diagonal of U).");
      prm.declare_entry("Local refinements",
                        "0",
                        Patterns::Integer(0, 10),
                        "How often the cells of a region are split.");
      if (chosen("Grid/Local refinements", "0") != "0")
        prm.declare_entry("Refine where",
                          "1",
                          Patterns::Anything(),
                          "Expression in x, y, z: cells are split whose "
                          "centre makes it positive.");
      prm.leave_subsection();
    }

    void
    declare_materials(ParameterHandler            &prm,
                      const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Materials");
      prm.declare_entry("Names",
                        "",
                        Patterns::Anything(),
                        "Names of the materials, each with a subsection.");
      for (const auto &name : split_names(chosen("Materials/Names", "")))
        {
          prm.enter_subsection(name);
          const std::string path = "Materials/" + name + "/";
          const auto       &laws = material_list();
          prm.declare_entry("Law",
                            laws.front().name,
                            Patterns::Selection(names_of(laws)),
                            "The constitutive law.");
          const auto law = chosen(path + "Law", laws.front().name);
          for (const auto &entry : laws)
            if (entry.name == law)
              {
                entry.declare(prm);
                if (entry.declare_chosen)
                  entry.declare_chosen(prm,
                                       [&](const std::string &choice,
                                           const std::string &fallback) {
                                         return chosen(path + choice, fallback);
                                       });
              }
          prm.declare_entry("F-bar",
                            "false",
                            Patterns::Bool(),
                            "The points of a cell share its change of volume, "
                            "against locking of materials that hardly change "
                            "theirs.");
          prm.declare_entry(
            "Specific heat",
            "",
            Patterns::Anything(),
            "(J/(kg K)), with which plastic or viscous work becomes "
            "temperature; empty: no temperature.");
          if (!chosen(path + "Specific heat", "").empty())
            prm.declare_entry("Initial temperature",
                              "293.15",
                              Patterns::Double(0),
                              "(K).");
          prm.leave_subsection();
        }
      prm.leave_subsection();
    }

    void
    declare_body(ParameterHandler            &prm,
                 const ParameterFile::Chosen &chosen,
                 const std::string           &name)
    {
      prm.enter_subsection(name);
      const std::string path = "Bodies/" + name + "/";
      prm.declare_entry("Kind",
                        "deformable",
                        Patterns::Selection("deformable|rigid"),
                        "Rigid bodies move as prescribed. Nodes of a "
                        "Lagrangian grid that reach one stick to it.");
      prm.declare_entry("Points from",
                        "shape",
                        Patterns::Selection("shape|file"),
                        "Where the points come from.");
      const auto source = chosen(path + "Points from", "shape");
      if (may_be(source, "shape"))
        {
          prm.declare_entry("Shape",
                            "",
                            Patterns::Anything(),
                            "Name of a shape of the section Geometry.");
          if (chosen(path + "Kind", "deformable") == "deformable" ||
              chosen("Grid/Method", "MPM") != "Lagrangian")
            prm.declare_entry("Points per cell",
                              "2",
                              Patterns::List(Patterns::Integer(1, 20), 1, 3),
                              "In each direction of a cell, one number for "
                              "all or one for each; Gauss points if the grid "
                              "is Lagrangian.");
        }
      if (may_be(source, "file"))
        prm.declare_entry("File",
                          "",
                          Patterns::Anything(),
                          "CSV (x, y, z, volume) or VTU file of the points.");

      if (chosen(path + "Kind", "deformable") == "deformable")
        {
          prm.declare_entry("Material",
                            "",
                            Patterns::Anything(),
                            "Name of a material.");
          if (chosen("Time/Integrator", "quasi-static") != "quasi-static")
            prm.declare_entry("Velocity",
                              "",
                              Patterns::Anything(),
                              "At the start (m/s): expressions in x, y, z, one "
                              "for each direction, between semicolons; empty: "
                              "at rest.");
        }
      else
        {
          prm.declare_entry("Displacement",
                            "",
                            Patterns::Anything(),
                            "Since the start (m): expressions in t, one for "
                            "each direction, between semicolons.");
          prm.declare_entry("Contact",
                            "no slip",
                            Patterns::Selection("no slip|slip x|slip y|slip z"),
                            "Whether material at its surface is held in all "
                            "directions, or only in the normal one that is "
                            "named (slip y: free along x and z).");
        }
      prm.leave_subsection();
    }

    void
    declare_faces(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Boundary conditions");
      const auto         method  = chosen("Grid/Method", "MPM");
      const unsigned int n_faces = chosen("Geometry/Kind", "") == "3D" ? 6 : 4;
      for (unsigned int f = 0; f < n_faces; ++f)
        {
          const auto &name = face_names()[f];
          prm.enter_subsection(name);
          prm.declare_entry(
            "Type",
            "free",
            Patterns::Selection("free|fixed|slip|displacement|velocity|normal "
                                "displacement|normal velocity|traction"),
            "Of the face of the domain. Slip: no motion through it. Traction: "
            "only on a Lagrangian grid, which fits the body.");
          const auto type =
            chosen("Boundary conditions/" + name + "/Type", "free");
          if (type != "free" && type != "fixed" && type != "slip")
            {
              prm.declare_entry("Value",
                                "",
                                Patterns::Anything(),
                                "Displacement since the start (m), velocity "
                                "(m/s) or force per initial area (Pa): "
                                "expressions in x, y, z, t, one for "
                                "each direction, between semicolons; a normal "
                                "one has one, along the axis.");
              if (type != "traction" && method != "Lagrangian")
                prm.declare_entry("Moves the grid",
                                  "false",
                                  Patterns::Bool(),
                                  "The grid is stretched with this face, which "
                                  "moves as a plane.");
            }
          prm.leave_subsection();
        }
      prm.leave_subsection();
    }

    void
    declare_coordinates(ParameterHandler &prm)
    {
      prm.declare_entry("Coordinates",
                        "current",
                        Patterns::Selection("current|initial"),
                        "Whether x, y, z in the expressions of this load are "
                        "where a point is or where it was at the start.");
    }

    void
    declare_traction(ParameterHandler &prm, const std::string &name)
    {
      prm.enter_subsection(name);
      prm.declare_entry("Body",
                        "",
                        Patterns::Anything(),
                        "Name of a deformable body.");
      prm.declare_entry("Where",
                        "",
                        Patterns::Anything(),
                        "Expression in x, y, z: the traction acts on points of "
                        "the body whose places at the start make it positive. "
                        "They should form one layer at its surface.");
      prm.declare_entry("Normal",
                        "x",
                        Patterns::Selection("x|y|z"),
                        "Direction across the layer. The area of a point is "
                        "its initial volume over its initial extent in this "
                        "direction (that of a cube for points from files).");
      prm.declare_entry("Value",
                        "",
                        Patterns::Anything(),
                        "Force per initial area (Pa), a dead load: expressions "
                        "in x, y, z, t, one for each direction, between "
                        "semicolons.");
      declare_coordinates(prm);
      prm.leave_subsection();
    }

    void
    declare_loads(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Loads");
      prm.declare_entry("Body force",
                        "",
                        Patterns::Anything(),
                        "Force per mass (m/s^2): expressions in x, y, z, t, "
                        "one for each direction, between semicolons; empty: "
                        "none.");
      if (!chosen("Loads/Body force", "").empty())
        declare_coordinates(prm);
      prm.declare_entry("Tractions",
                        "",
                        Patterns::Anything(),
                        "Names of forces on points at the surface of bodies, "
                        "each with a subsection. On a Lagrangian grid "
                        "tractions act on faces of the domain instead.");
      for (const auto &name : split_names(chosen("Loads/Tractions", "")))
        declare_traction(prm, name);
      prm.leave_subsection();
    }

  } // namespace

  const std::vector<std::string> &
  face_names()
  {
    static const std::vector<std::string> names = {
      "left", "right", "bottom", "top", "back", "front"};
    return names;
  }

  void
  declare_scene(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    declare_general(prm);
    declare_geometry(prm, chosen);
    declare_grid(prm, chosen);
    declare_materials(prm, chosen);
    prm.enter_subsection("Bodies");
    prm.declare_entry("Names",
                      "",
                      Patterns::Anything(),
                      "Names of the bodies, each with a subsection.");
    for (const auto &name : split_names(chosen("Bodies/Names", "")))
      declare_body(prm, chosen, name);
    prm.leave_subsection();
    declare_faces(prm, chosen);
    declare_loads(prm, chosen);
    declare_time(prm, chosen);
    declare_solver(prm, chosen);
    declare_stabilization(prm, chosen);
    declare_output(prm, chosen);
    declare_references(prm, chosen);
  }
} // namespace impm
