#include <impm/input/sections/geometry.h>

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
  is_three_d(const Chosen &chosen)
  {
    return kinds.read(chosen, "Geometry") == GeometryKind::three_d;
  }

  bool
  is_axisymmetric(const Chosen &chosen)
  {
    return kinds.read(chosen, "Geometry") == GeometryKind::axisymmetric;
  }

  template <int dim>
  void
  add_geometry(const Section &top, GeometryKind &kind, NamedShapes<dim> &shapes)
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
        shape.inside([&](auto &prm) {
          if (shape.is_read)
            shapes[name] = std::make_shared<const Shape<dim>>(
              entry.create(prm, shape.constants, shapes));
          else
            entry.declare(prm);
        });
      }
  }

  template void
  add_geometry(const Section &, GeometryKind &, NamedShapes<2> &);
  template void
  add_geometry(const Section &, GeometryKind &, NamedShapes<3> &);
} // namespace impm
