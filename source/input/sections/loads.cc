#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/loads.h>

#include <set>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    const Choice<bool> is_initial("Coordinates",
                                  {{"current", false}, {"initial", true}});

    const Choice<unsigned int> normals("Normal",
                                       {{"x", 0}, {"y", 1}, {"z", 2}});

    void
    declare_coordinates(ParameterHandler &prm)
    {
      is_initial.declare(prm,
                         "Whether x, y, z in the expressions of this load are "
                         "where a point is or where it was at the start.");
    }

    void
    declare_traction(ParameterHandler &prm)
    {
      declare_text(prm, "Body", "Name of a deformable body.");
      declare_text(prm,
                   "Where",
                   "Expression in x, y, z: the traction acts on points of "
                   "the body whose places at the start make it positive. "
                   "They should form one layer at its surface.");
      normals.declare(prm,
                      "Direction across the layer. The area of a point is "
                      "its initial volume over its initial extent in this "
                      "direction (that of a cube for points from files).");
      declare_text(prm,
                   "Value",
                   "Force per initial area (Pa), a dead load: expressions "
                   "in x, y, z, t, one for each direction, between "
                   "semicolons.");
      declare_coordinates(prm);
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
      traction.normal = normals.read(prm);
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
      traction.is_initial = is_initial.read(prm);
      return traction;
    }
  } // namespace

  void
  declare_loads(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Loads");
    declare_text(prm,
                 "Body force",
                 "Force per mass (m/s^2): expressions in x, y, z, t, "
                 "one for each direction, between semicolons; empty: "
                 "none.");
    if (!chosen("Loads/Body force", "").empty())
      declare_coordinates(prm);
    declare_text(prm,
                 "Tractions",
                 "Names of forces on points at the surface of bodies, "
                 "each with a subsection. On a Lagrangian grid "
                 "tractions act on faces of the domain instead.");
    for (const auto &name : split_names(chosen("Loads/Tractions", "")))
      in_section(prm, name, [&]() { declare_traction(prm); });
    prm.leave_subsection();
  }

  template <int dim>
  LoadsSpec<dim>
  read_loads(ParameterHandler &prm,
             const bool        lagrangian,
             const Constants  &constants)
  {
    LoadsSpec<dim> loads;
    in_section(prm, "Loads", [&]() {
      loads.body_force =
        read_expressions<dim>(prm, "Body force", dim, true, constants);
      loads.body_force_is_initial = loads.body_force && is_initial.read(prm);
      const std::string names     = prm.get("Tractions");
      if (!names.empty() && lagrangian)
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
            loads.tractions.push_back(read_traction<dim>(prm, name, constants));
          });
        }
    });
    return loads;
  }

  template <int dim>
  void
  check_loads(const LoadsSpec<dim> &loads, const Bodies<dim> &bodies)
  {
    for (const auto &traction : loads.tractions)
      require_name(names_of_bodies(bodies, false),
                   traction.body,
                   "Loads/" + traction.name + "/Body");
  }

  template LoadsSpec<2>
  read_loads(ParameterHandler &, bool, const Constants &);
  template LoadsSpec<3>
  read_loads(ParameterHandler &, bool, const Constants &);
  template void
  check_loads(const LoadsSpec<2> &, const Bodies<2> &);
  template void
  check_loads(const LoadsSpec<3> &, const Bodies<3> &);
} // namespace impm
