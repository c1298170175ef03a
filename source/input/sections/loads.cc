#include <impm/input/sections/loads.h>

#include <algorithm>

namespace impm
{
  namespace
  {
    void
    add_coordinates(const Section &section, bool &initial)
    {
      section.add("Coordinates",
                  initial,
                  {{"current", false}, {"initial", true}},
                  "Whether x, y, z in the expressions of this load are where "
                  "a point is or where it was at the start.");
    }

    /** Of a layer of points at the surface. */
    template <int dim>
    void
    add_traction(const Section     &section,
                 TractionSpec<dim> &traction,
                 const std::string &body)
    {
      traction.name = section.name;
      traction.body = body;
      section.add("Where",
                  traction.where,
                  {1, steady},
                  "Expression in x, y, z: the traction acts on points of the "
                  "body whose places at the start make it positive. They "
                  "should form one layer at its surface.");
      section.require("Where", "is an expression");
      section.add("Normal",
                  traction.normal,
                  {{"x", 0}, {"y", 1}, {"z", 2}},
                  "Direction across the layer. The area of a point is its "
                  "initial volume over its initial extent in this direction "
                  "(that of a cube for points from files).");
      if (traction.normal >= dim)
        section.refuse("Normal", "allowed in 2D are x, y");
      section.add("Value",
                  traction.value,
                  {dim, in_time},
                  "Force per initial area (Pa), a dead load: expressions in "
                  "x, y, z, t, one for each direction, between semicolons.");
      section.require("Value", "are expressions");
      add_coordinates(section, traction.is_initial);
    }

    template <int dim>
    void
    add_axis(const Section        &section,
             SurfaceLoadSpec<dim> &load,
             const GeometryKind    geometry)
    {
      if (geometry == GeometryKind::axisymmetric)
        section.refuse("Kind",
                       "allowed in axisymmetry, where nothing turns, are "
                       "traction, pressure");
      const auto about = section.numbers("About",
                                         dim,
                                         "A point of the axis (m), which stays "
                                         "where it is.",
                                         dim == 2 ? "0, 0" : "0, 0, 0");
      std::copy(about.begin(), about.end(), load.about.begin_raw());
      load.axis[2] = 1;
      if (dim == 2)
        return;
      const auto axis = section.numbers("Axis",
                                        3,
                                        "Direction of the axis: the torque is "
                                        "counterclockwise about it.",
                                        "0, 0, 1");
      std::copy(axis.begin(), axis.end(), load.axis.begin_raw());
      if (section.is_read && !(load.axis.norm() > 0))
        section.refuse("Axis", "allowed is a direction");
      if (section.is_read)
        load.axis /= load.axis.norm();
    }

    /** Of a surface that is found at the start. */
    template <int dim>
    void
    add_surface_load(const Section        &section,
                     SurfaceLoadSpec<dim> &load,
                     const Bodies<dim>    &bodies,
                     const std::string    &body,
                     const GeometryKind    geometry)
    {
      load.name = section.name;
      load.body =
        std::find_if(bodies.begin(),
                     bodies.end(),
                     [&](const auto &other) { return other.name == body; }) -
        bodies.begin();
      if (section.is_read && !bodies[load.body].shape)
        section.refuse("Acts on",
                       "allowed for body '" + body +
                         "', which comes from a file and has no surface, is "
                         "points");
      section.add("Kind",
                  load.kind,
                  {{"traction", SurfaceLoadKind::dead},
                   {"pressure", SurfaceLoadKind::pressure},
                   {"torque", SurfaceLoadKind::torque}},
                  "Traction: a force for each initial area that keeps its "
                  "direction. Pressure: into the body, across its surface as "
                  "that is by then. Torque: a moment about an axis, from "
                  "forces around it that grow with the distance.");
      section.add(
        "Where",
        load.where,
        {1, steady},
        "Expression in x, y, z: the load acts on that part of the "
        "surface whose places at the start make it positive; empty: "
        "on all of it. What lies on a face of the domain does not count where that holds its normal.");
      const bool is_dead = load.kind == SurfaceLoadKind::dead;
      section.add("Value",
                  load.value,
                  {is_dead ? dim : 1u, in_time},
                  "Traction: force per initial area (Pa), expressions in x, y, "
                  "z, t, one for each direction, between semicolons. "
                  "Pressure (Pa): one. Torque (N m; for each metre of "
                  "thickness in the plane): one in t.");
      section.require("Value",
                      is_dead ? "are expressions" : "is an expression");
      if (load.kind != SurfaceLoadKind::torque)
        {
          add_coordinates(section, load.is_initial);
          return;
        }
      if (load.value && !is_uniform(*load.value))
        section.refuse("Value", "allowed for a torque is a function of t");
      add_axis(section, load, geometry);
    }

    template <int dim>
    void
    add_load(const Section       &section,
             LoadsSpec<dim>      &loads,
             const Bodies<dim>   &bodies,
             const GridSpec<dim> &grid,
             const GeometryKind   geometry)
    {
      std::string body;
      section.add("Body", body, "Name of a deformable body.");
      section.require_name("Body", body, names_of_bodies(bodies, false));
      const Choice<bool> on_points("Acts on",
                                   {{"surface", false}, {"points", true}});
      bool               acts_on_points = false;
      section.add(on_points,
                  acts_on_points,
                  "Surface: of the body, which is found by itself and moves "
                  "with it. Points: of a layer that is named, which carry "
                  "the load of the surface half their extent outside of them "
                  "(Sulsky & Kaul 2004, eq. 2.2.7).");
      if (!acts_on_points && grid.keeps_motion())
        section.refuse("Acts on",
                       "allowed on a grid that keeps its motion "
                       "('Grid/Reset') is points");
      if (section.chooses(on_points, true))
        {
          TractionSpec<dim> traction;
          add_traction(section, traction, body);
          if (acts_on_points)
            loads.tractions.push_back(traction);
        }
      if (section.chooses(on_points, false))
        {
          SurfaceLoadSpec<dim> load;
          add_surface_load(section, load, bodies, body, geometry);
          if (!acts_on_points)
            loads.on_surfaces.push_back(load);
        }
    }
  } // namespace

  template <int dim>
  void
  add_loads(const Section       &top,
            LoadsSpec<dim>      &loads,
            const Bodies<dim>   &bodies,
            const GridSpec<dim> &grid,
            const GeometryKind   geometry)
  {
    const auto section = top.subsection("Loads");
    section.add("Body force",
                loads.body_force,
                {dim, in_time},
                "Force per mass (m/s^2): expressions in x, y, z, t, "
                "one for each direction, between semicolons; empty: "
                "none.");
    if (!section.get("Body force").empty())
      add_coordinates(section, loads.body_force_is_initial);
    const auto names =
      section.names("Tractions",
                    "Names of forces on the surfaces of bodies, each with a "
                    "subsection. On a Lagrangian grid they act on faces of the "
                    "domain instead.");
    if (!names.empty() && grid.is_lagrangian())
      section.refuse("Tractions",
                     "allowed on a Lagrangian grid, which fits the bodies, are "
                     "faces of the domain with Type = traction or pressure");
    for (const auto &name : names)
      add_load(section.subsection(name), loads, bodies, grid, geometry);
  }

  template void
  add_loads(const Section &,
            LoadsSpec<2> &,
            const Bodies<2> &,
            const GridSpec<2> &,
            GeometryKind);
  template void
  add_loads(const Section &,
            LoadsSpec<3> &,
            const Bodies<3> &,
            const GridSpec<3> &,
            GeometryKind);
} // namespace impm
