#include <impm/input/sections/loads.h>

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

    template <int dim>
    void
    add_traction(const Section     &section,
                 TractionSpec<dim> &traction,
                 const Bodies<dim> &bodies)
    {
      traction.name = section.name;
      section.add("Body", traction.body, "Name of a deformable body.");
      section.require_name("Body",
                           traction.body,
                           names_of_bodies(bodies, false));
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
  } // namespace

  template <int dim>
  void
  add_loads(const Section     &top,
            LoadsSpec<dim>    &loads,
            const Bodies<dim> &bodies,
            const bool         lagrangian)
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
                    "Names of forces on points at the surface of bodies, each "
                    "with a subsection. On a Lagrangian grid tractions act on "
                    "faces of the domain instead.");
    if (!names.empty() && lagrangian)
      section.refuse("Tractions",
                     "allowed on a Lagrangian grid, which fits the bodies, are "
                     "faces of the domain with Type = traction");
    for (const auto &name : names)
      add_traction(section.subsection(name),
                   loads.tractions.emplace_back(),
                   bodies);
  }

  template void
  add_loads(const Section &, LoadsSpec<2> &, const Bodies<2> &, bool);
  template void
  add_loads(const Section &, LoadsSpec<3> &, const Bodies<3> &, bool);
} // namespace impm
