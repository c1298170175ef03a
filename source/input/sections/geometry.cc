#include <impm/base/files.h>
#include <impm/input/sections/geometry.h>

#include <filesystem>

namespace impm
{
  namespace
  {
    const Choice<GeometryKind>
      kinds("Kind",
            {{"plane strain", GeometryKind::plane_strain},
             {"plane stress", GeometryKind::plane_stress},
             {"axisymmetric", GeometryKind::axisymmetric},
             {"3D", GeometryKind::three_d}});
  }

  bool
  is_three_d(const ParameterFile::Chosen &chosen)
  {
    return kinds.read(chosen, "Geometry") == GeometryKind::three_d;
  }

  bool
  is_axisymmetric(const ParameterFile::Chosen &chosen)
  {
    return kinds.read(chosen, "Geometry") == GeometryKind::axisymmetric;
  }

  template <int dim>
  void
  add_geometry(const Section     &top,
               GeometryKind      &kind,
               NamedShapes<dim>  &shapes,
               const std::string &parameter_file)
  {
    const auto section = top.subsection("Geometry");
    section.add(kinds,
                kind,
                "Plane strain: x, y, forces per metre of thickness. "
                "Plane stress: the same of a sheet, per metre of its "
                "initial thickness, which is free to change. "
                "Axisymmetric: r, z, forces of the whole circle.");
    for (const auto &name :
         section.names("Shapes",
                       "Names of the shapes, each with a subsection."))
      {
        const auto  shape = section.subsection(name);
        const auto &entry =
          shape.pick("Kind", shape_list<dim>(), "What the shape is.");
        // An absolute path, so that the resolved parameters find it, and a
        // restart compares it, from anywhere.
        std::string file = shape.get("File");
        if (!file.empty())
          file =
            std::filesystem::absolute(
              find_file(file, parameter_file, shape.chosen("Study/Scene", "")))
              .lexically_normal()
              .string();
        shape.inside([&](auto &prm) {
          if (shape.is_read && !file.empty())
            prm.set("File", file);
          if (shape.is_read)
            shapes[name] = std::make_shared<const Shape<dim>>(
              entry.create(prm, shape.constants, shapes));
          else
            entry.declare(prm);
        });
      }
  }

  template void
  add_geometry(const Section &,
               GeometryKind &,
               NamedShapes<2> &,
               const std::string &);
  template void
  add_geometry(const Section &,
               GeometryKind &,
               NamedShapes<3> &,
               const std::string &);
} // namespace impm
