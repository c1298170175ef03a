#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <boost/range/adaptor/map.hpp>

#include <algorithm>
#include <set>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    const Choice<bool> is_rigid("Kind",
                                {{"deformable", false}, {"rigid", true}});

    const Choice<bool> from_file("Points from",
                                 {{"shape", false}, {"file", true}});

    const unsigned int         no_slip = 3;
    const Choice<unsigned int> slip_normals(
      "Contact",
      {{"no slip", no_slip}, {"slip x", 0}, {"slip y", 1}, {"slip z", 2}});

    void
    declare_body(ParameterHandler            &prm,
                 const ParameterFile::Chosen &chosen,
                 const std::string           &section)
    {
      is_rigid.declare(prm,
                       "Rigid bodies move as prescribed. Nodes of a "
                       "Lagrangian grid that reach one stick to it.");
      const bool deformable = is_rigid.is(chosen, section, false);
      from_file.declare(prm, "Where the points come from.");
      if (from_file.may_be(chosen, section, false))
        {
          declare_text(prm,
                       "Shape",
                       "Name of a shape of the section Geometry.");
          if (deformable || !is_lagrangian(chosen))
            prm.declare_entry("Points per cell",
                              "2",
                              Patterns::List(Patterns::Integer(1, 20), 1, 3),
                              "In each direction of a cell, one number for "
                              "all or one for each; Gauss points if the grid "
                              "is Lagrangian.");
        }
      if (from_file.may_be(chosen, section, true))
        declare_text(prm,
                     "File",
                     "CSV (x, y, z, volume) or VTU file of the points.");

      if (deformable)
        {
          declare_text(prm, "Material", "Name of a material.");
          if (!is_quasi_static(chosen))
            declare_text(prm,
                         "Velocity",
                         "At the start (m/s): expressions in x, y, z, one "
                         "for each direction, between semicolons; empty: "
                         "at rest.");
        }
      else
        {
          declare_text(prm,
                       "Displacement",
                       "Since the start (m): expressions in t, one for "
                       "each direction, between semicolons.");
          slip_normals.declare(prm,
                               "Whether material at its surface is held in all "
                               "directions, or only in the normal one that is "
                               "named (slip y: free along x and z).");
        }
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

    /** What an entry names. */
    template <typename Item>
    Item
    pick(const ParameterHandler            &prm,
         const std::string                 &entry,
         const std::map<std::string, Item> &items)
    {
      const auto it = items.find(prm.get(entry));
      if (it == items.end())
        throw InputError(entry,
                         "found '" + prm.get(entry) + "', allowed are: " +
                           (items.empty() ?
                              "none, since none is named" :
                              join(items | boost::adaptors::map_keys, ", ")));
      return it->second;
    }

    template <int dim>
    BodySpec<dim>
    read_body(const ParameterHandler &prm,
              const std::string      &name,
              const NamedShapes<dim> &shapes,
              const NamedMaterials   &materials,
              const bool              lagrangian,
              const bool              inertia,
              const Constants        &constants)
    {
      BodySpec<dim> body;
      body.name  = name;
      body.rigid = is_rigid.read(prm);
      if (lagrangian && from_file.read(prm))
        throw InputError("Points from",
                         "found 'file', allowed on a Lagrangian grid, where "
                         "points are Gauss points, is 'shape'");
      if (from_file.read(prm))
        body.point_file = prm.get("File");
      else
        {
          body.shape = pick(prm, "Shape", shapes);
          if (!lagrangian || !body.rigid)
            body.points_per_cell = read_points_per_cell<dim>(prm);
          else if (!body.shape->is_box)
            throw InputError("Shape",
                             "found '" + prm.get("Shape") +
                               "', allowed for a rigid body on a "
                               "Lagrangian grid, whose nodes stick to it, "
                               "are boxes");
        }
      if (!body.rigid)
        {
          body.material = pick(prm, "Material", materials);
          if (inertia)
            body.velocity =
              read_expressions<dim>(prm, "Velocity", dim, false, constants);
          return body;
        }
      body.displacement =
        read_expressions<1>(prm, "Displacement", dim, true, constants);
      const unsigned int normal = slip_normals.read(prm);
      if (normal == no_slip)
        return body;
      if (normal >= dim)
        throw InputError("Contact",
                         "found '" + prm.get("Contact") +
                           "', allowed in 2D are no slip, slip x, slip y");
      body.slip_normal = normal;
      return body;
    }
  } // namespace

  void
  declare_bodies(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Bodies");
    declare_text(prm, "Names", "Names of the bodies, each with a subsection.");
    for (const auto &name : split_names(chosen("Bodies/Names", "")))
      in_section(prm, name, [&]() {
        declare_body(prm, chosen, "Bodies/" + name);
      });
    prm.leave_subsection();
  }

  std::set<std::string>
  used_materials(ParameterHandler &prm)
  {
    std::set<std::string> used;
    in_section(prm, "Bodies", [&]() {
      for (const auto &name : split_names(prm.get("Names")))
        in_section(prm, name, [&]() {
          if (prm.get("Kind") != "rigid")
            used.insert(prm.get("Material"));
        });
    });
    return used;
  }

  template <int dim>
  Bodies<dim>
  read_bodies(ParameterHandler       &prm,
              const NamedShapes<dim> &shapes,
              const NamedMaterials   &materials,
              const GridSpec<dim>    &grid,
              const TimeSpec         &time,
              const Constants        &constants)
  {
    Bodies<dim> bodies;
    in_section(prm, "Bodies", [&]() {
      std::set<std::string> taken(face_names().begin(), face_names().end());
      for (const auto &name : split_names(prm.get("Names")))
        {
          if (!taken.insert(name).second)
            throw InputError("Names",
                             "found '" + name +
                               "', which is taken by a face or another body");
          in_section(prm, name, [&]() {
            bodies.push_back(read_body(prm,
                                       name,
                                       shapes,
                                       materials,
                                       grid.is_lagrangian(),
                                       time.has_inertia(),
                                       constants));
          });
        }
    });
    return bodies;
  }

  template <int dim>
  void
  check_bodies(const Bodies<dim> &bodies, const GridSpec<dim> &grid)
  {
    for (const auto &body : bodies)
      {
        const auto box = body.shape ? body.shape->bounding_box : std::nullopt;
        if (!box || grid.is_lagrangian())
          continue;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double lower = box->lower_bound(d),
                         upper = box->upper_bound(d);
            const double slack = 1e-10 * (upper - lower);
            if (lower < grid.lower_corner[d] - slack ||
                upper > grid.upper_corner[d] + slack)
              throw InputError("Bodies/" + body.name + "/Shape",
                               "body '" + body.name + "' reaches from " +
                                 std::to_string(lower) + " to " +
                                 std::to_string(upper) + " m in direction " +
                                 "xyz"[d] + ", allowed is the grid's " +
                                 std::to_string(grid.lower_corner[d]) + " to " +
                                 std::to_string(grid.upper_corner[d]) + " m");
          }
      }
    if (names_of_bodies(bodies, false).empty())
      throw InputError("Bodies/Names",
                       "found no deformable body, allowed is at least one");
  }

  template <int dim>
  std::vector<std::string>
  names_of_bodies(const Bodies<dim> &bodies, const bool rigid)
  {
    std::vector<std::string> names;
    for (const auto &body : bodies)
      if (body.rigid == rigid)
        names.push_back(body.name);
    return names;
  }

  template Bodies<2>
  read_bodies(ParameterHandler &,
              const NamedShapes<2> &,
              const NamedMaterials &,
              const GridSpec<2> &,
              const TimeSpec &,
              const Constants &);
  template Bodies<3>
  read_bodies(ParameterHandler &,
              const NamedShapes<3> &,
              const NamedMaterials &,
              const GridSpec<3> &,
              const TimeSpec &,
              const Constants &);
  template void
  check_bodies(const Bodies<2> &, const GridSpec<2> &);
  template void
  check_bodies(const Bodies<3> &, const GridSpec<3> &);
  template std::vector<std::string>
  names_of_bodies(const Bodies<2> &, bool);
  template std::vector<std::string>
  names_of_bodies(const Bodies<3> &, bool);
} // namespace impm
