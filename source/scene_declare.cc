#include <deal.II/base/patterns.h>

#include <impm/materials/list.h>
#include <impm/scene.h>

#include <limits>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    // "Greater than zero" for a pattern that knows closed ranges only.
    const double tiny = std::numeric_limits<double>::min();

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

    /** Whether an option is chosen; "any" stands for all of them. */
    bool
    may_be(const std::string &chosen, const std::string &option)
    {
      return chosen == option || chosen == "any";
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
                        "Rigid bodies move as prescribed.");
      prm.declare_entry("Points from",
                        "shape",
                        Patterns::Selection("shape|file"),
                        "Where the points come from.");
      if (chosen(path + "Points from", "shape") == "shape")
        {
          prm.declare_entry("Shape",
                            "",
                            Patterns::Anything(),
                            "Name of a shape of the section Geometry.");
          prm.declare_entry("Points per cell",
                            "2",
                            Patterns::Integer(1, 20),
                            "In each direction of a cell; Gauss points if the "
                            "grid is Lagrangian.");
        }
      else
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

    void
    declare_time(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Time");
      prm.declare_entry("Integrator",
                        "quasi-static",
                        Patterns::Selection(
                          "quasi-static|explicit|theta|Newmark"),
                        "Quasi-static: no inertia. Explicit and theta: Sulsky "
                        "& Kaul (2004), section 2.3.1 and eq. 2.4.1. Newmark: "
                        "Guilkey & Weiss (2003).");
      const auto integrator = chosen("Time/Integrator", "quasi-static");
      if (may_be(integrator, "Newmark"))
        {
          prm.declare_entry("Beta",
                            "0.25",
                            Patterns::Double(0.01, 0.5),
                            "Weight of the acceleration at the end in the "
                            "displacement; 0.25: trapezoidal.");
          prm.declare_entry("Gamma",
                            "0.5",
                            Patterns::Double(0.5, 1),
                            "The same in the velocity; above 0.5 it damps.");
          prm.declare_entry("Acceleration from",
                            "grid",
                            Patterns::Selection("grid|points"),
                            "At the start of a step: from the forces on the "
                            "grid as it is, or as the points carry it (Guilkey "
                            "& Weiss 2003), which loses energy in long steps.");
        }
      if (may_be(integrator, "theta"))
        prm.declare_entry("Theta",
                          "1",
                          Patterns::Double(0, 1),
                          "Weight of the forces at the end of the step (mu in "
                          "the paper); 1: backward Euler, 0.5: trapezoidal, 0: "
                          "explicit. Below 0.5, long steps are unstable.");
      if (integrator != "quasi-static" &&
          chosen("Grid/Method", "MPM") != "Lagrangian")
        prm.declare_entry("Formulation",
                          "velocity",
                          Patterns::Selection("velocity|momentum"),
                          "Strain from the grid's velocity, or from one that "
                          "has been mapped to the points and back (Sulsky & "
                          "Kaul 2004, section 3.2.1), which spares nodes with "
                          "little mass and makes the tangent unsymmetric.");
      if (integrator != "quasi-static" &&
          chosen("Grid/Method", "MPM") != "Lagrangian")
        prm.declare_entry("Transfer",
                          "FLIP",
                          Patterns::Selection("FLIP|PIC|APIC"),
                          "Velocities of points: they take the change of the "
                          "grid's (FLIP), its value (PIC, which damps), or its "
                          "value and gradient (APIC).");
      prm.declare_entry("End time",
                        "1",
                        Patterns::Double(tiny),
                        "When the run ends (s).");
      if (integrator != "quasi-static")
        prm.declare_entry("CFL number",
                          "0",
                          Patterns::Double(0),
                          "Time step in units of the smallest cell over the "
                          "largest speed of elastic waves and points; 0: given "
                          "in seconds.");
      const auto cfl_number = chosen("Time/CFL number", "0");
      if (cfl_number == "any" || Patterns::Double(0, 0).match(cfl_number))
        prm.declare_entry("Time step",
                          "0.01",
                          Patterns::Double(tiny),
                          "Of the first step (s).");
      prm.declare_entry("Growth",
                        "1",
                        Patterns::Double(1, 2),
                        "Factor from one time step to the next.");
      prm.declare_entry("Largest time step",
                        "",
                        Patterns::Anything(),
                        "Where growth ends (s, or CFL number); empty: the "
                        "first step's.");
      prm.declare_entry("Smallest time step",
                        "0.001",
                        Patterns::Double(tiny, 1),
                        "How small a step may be cut before the run gives up, "
                        "as a fraction of the first step.");
      prm.declare_entry("Largest number of steps",
                        "10000000",
                        Patterns::Integer(1),
                        "The run ends there at the latest.");
      prm.leave_subsection();
    }

    void
    declare_solver(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Solver");
      if (chosen("Time/Integrator", "quasi-static") == "explicit")
        {
          prm.leave_subsection();
          return;
        }
      prm.declare_entry("Residual scale",
                        "body",
                        Patterns::Selection("body|cell|momentum"),
                        "Unit of the norm of residuals. Body: that of the "
                        "forces of all material at a strain of one. Cell: "
                        "largest Young's modulus times dx dy (dz) of the "
                        "smallest cell, of a radian if axisymmetric (Sulsky & "
                        "Kaul 2004, section 3.2.2). "
                        "Momentum: force times time step in N s (their section "
                        "3.1).");
      prm.declare_entry("Newton tolerance",
                        "1e-7",
                        Patterns::Double(tiny, 1),
                        "Norm of the residual in units of the residual scale; "
                        "with that of the body of the order of an error in "
                        "strain.");
      prm.declare_entry("Newton reduction",
                        "1e-3",
                        Patterns::Double(tiny, 1),
                        "And over that at the start of the step: where little "
                        "happens in a step, it must be solved, too. 1: the "
                        "tolerance alone, so that the first guess may do.");
      prm.declare_entry("Newton iterations",
                        "50",
                        Patterns::Integer(1),
                        "Largest number before the time step is cut.");
      prm.declare_entry("Line search",
                        "true",
                        Patterns::Bool(),
                        "Backtrack where a Newton step does not descend.");
      prm.declare_entry("Linear solver",
                        "CG",
                        Patterns::Selection("CG|GMRES|direct"),
                        "For the Newton steps.");
      const auto solver = chosen("Solver/Linear solver", "CG");
      if (solver != "direct")
        {
          prm.declare_entry("Linear tolerance",
                            "1e-4",
                            Patterns::Double(tiny, 1),
                            "Residual of a linear solve over its right-hand "
                            "side.");
          prm.declare_entry("Linear iterations",
                            "1000",
                            Patterns::Integer(1),
                            "Largest number in a linear solve.");
          prm.declare_entry("Unfinished solves",
                            "automatic",
                            Patterns::Selection(
                              "automatic|direct solver|next Newton step"),
                            "Who takes over after the largest number. "
                            "Automatic: the direct solver in the velocity "
                            "formulation, Newton's method in the momentum "
                            "formulation, whose matrix is never built.");
          prm.declare_entry("Preconditioner",
                            "AMG",
                            Patterns::Selection("AMG|Jacobi|none"),
                            "AMG: smoothed aggregation of Trilinos ML with "
                            "the rigid-body modes.");
          prm.declare_entry("Operator",
                            "matrix",
                            Patterns::Selection(
                              "matrix|matrix-free|difference quotient"),
                            "How the tangent is applied; AMG needs the matrix "
                            "in any case. Difference quotient: of residuals "
                            "(Sulsky & Kaul 2004, eq. 2.4.18), one evaluation "
                            "of all laws each time.");
          if (may_be(chosen("Solver/Operator", "matrix"),
                     "difference quotient"))
            prm.declare_entry("Difference step",
                              "1e-5",
                              Patterns::Double(1e-12, 0.1),
                              "h of the difference quotient, relative to the "
                              "norm of the increment.");
        }
      if (may_be(solver, "GMRES"))
        prm.declare_entry("GMRES directions",
                          "50",
                          Patterns::Integer(2),
                          "Before a restart.");
      prm.leave_subsection();
    }

    void
    declare_stabilization(ParameterHandler            &prm,
                          const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Stabilization");
      // Cells of a Lagrangian grid are full; explicit forces need no solve.
      if (chosen("Grid/Method", "MPM") == "Lagrangian" ||
          chosen("Time/Integrator", "quasi-static") == "explicit")
        {
          prm.leave_subsection();
          return;
        }
      prm.declare_entry("Ghost penalty",
                        "0.033",
                        Patterns::Double(0, 10),
                        "On jumps of the gradient of the increment between "
                        "cells at the edge of a body, in units of Young's "
                        "modulus; 0: none.");
      if (may_be(chosen("Time/Integrator", "quasi-static"), "quasi-static"))
        prm.declare_entry("Isolated stiffness",
                          "1e-3",
                          Patterns::Double(0, 1),
                          "Stiffness that holds cells which touch no other "
                          "material when there is no inertia, in units of "
                          "Young's modulus; 0: none.");
      prm.leave_subsection();
    }

    void
    declare_probe(ParameterHandler            &prm,
                  const ParameterFile::Chosen &chosen,
                  const std::string           &name)
    {
      prm.enter_subsection(name);
      prm.declare_entry(
        "Kind",
        "point",
        Patterns::Selection("point|largest|smallest|spread|mean|extent|motion"),
        "point: at the point nearest to a place at the start, from which a "
        "displacement is carried on to the place by F. Largest, "
        "smallest, spread (their difference), mean: over bodies. Extent: largest coordinate, the points' "
        "domains included. Motion: of a moving face or a rigid body.");
      const auto kind = chosen("Output/" + name + "/Kind", "point");
      if (kind == "point")
        prm.declare_entry("Position",
                          "",
                          Patterns::Anything(),
                          "Place at the start (m).");
      else if (kind == "motion")
        prm.declare_entry("Of",
                          "",
                          Patterns::Anything(),
                          "A face of the domain or a rigid body.");
      if (kind != "motion" && kind != "point")
        prm.declare_entry("Bodies",
                          "",
                          Patterns::Anything(),
                          "Names of bodies; empty: all deformable ones.");
      if (kind != "motion" && kind != "point")
        prm.declare_entry("Where",
                          "",
                          Patterns::Anything(),
                          "Expression in x, y, z at the start: only points "
                          "that make it positive count; empty: all.");
      if (kind != "motion" && kind != "extent")
        prm.declare_entry("Field",
                          "displacement",
                          Patterns::Anything(),
                          "A field of the points, as in the pictures.");
      prm.declare_entry("Component",
                        "0",
                        Patterns::Integer(0, 8),
                        "Of the vector or, by rows, of the 3 x 3 tensor.");
      prm.declare_entry("Factor",
                        "1",
                        Patterns::Double(),
                        "Multiplies the figure.");
      prm.leave_subsection();
    }

    void
    declare_output(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
    {
      prm.enter_subsection("Output");
      prm.declare_entry("Directory",
                        "",
                        Patterns::Anything(),
                        "Where results go; empty: output/<name of the file>.");
      prm.declare_entry("Pictures",
                        "true",
                        Patterns::Bool(),
                        "Whether VTU files of points and grid are written.");
      // Also where pictures are off, so that a study can switch them off.
      prm.declare_entry("Time between pictures",
                        "0",
                        Patterns::Double(0),
                        "(s); 0: by the number of steps.");
      if (dealii::Patterns::Double(0, 0).match(
            chosen("Output/Time between pictures", "0")))
        prm.declare_entry("Steps between pictures",
                          "10",
                          Patterns::Integer(1),
                          "Number of steps.");
      prm.declare_entry("Steps between rows",
                        "1",
                        Patterns::Integer(1),
                        "Number of steps from a row of the history, with a "
                        "line on the screen, to the next; the last step of a "
                        "run has one in any case. Newton and linear "
                        "iterations, line searches, step cuts, tangent "
                        "projections, solver fallbacks and noise stops are "
                        "sums over the steps since the row before.");
      prm.declare_entry("Point fields",
                        "velocity, cauchy_stress, von_mises_stress, "
                        "equivalent_plastic_strain, deformation_gradient, "
                        "volume, body",
                        Patterns::Anything(),
                        "Fields of the points; those that this scene does "
                        "not have are left out.");
      prm.declare_entry("Probes",
                        "",
                        Patterns::Anything(),
                        "Names of columns of the history, each with a "
                        "subsection.");
      prm.declare_entry("Reactions",
                        "",
                        Patterns::Anything(),
                        "Names of columns of the history, each with a "
                        "subsection.");
      for (const auto &name : split_names(chosen("Output/Probes", "")))
        declare_probe(prm, chosen, name);
      for (const auto &name : split_names(chosen("Output/Reactions", "")))
        {
          prm.enter_subsection(name);
          prm.declare_entry("On",
                            "",
                            Patterns::Anything(),
                            "A face of the domain or a rigid body.");
          prm.declare_entry("Direction",
                            "",
                            Patterns::Anything(),
                            "The force of the material on it is projected on "
                            "this vector.");
          prm.declare_entry("Factor",
                            "1",
                            Patterns::Double(),
                            "Multiplies the figure.");
          prm.leave_subsection();
        }
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
