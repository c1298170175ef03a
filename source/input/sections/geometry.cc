#include <impm/input/choice.h>
#include <impm/input/sections/geometry.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    const Choice<GeometryKind>
      kinds("Kind",
            {{"plane strain", GeometryKind::plane_strain},
             {"plane stress", GeometryKind::plane_stress},
             {"axisymmetric", GeometryKind::axisymmetric},
             {"3D", GeometryKind::three_d}});

    template <int dim>
    void
    declare_shape(ParameterHandler            &prm,
                  const ParameterFile::Chosen &chosen,
                  const std::string           &name)
    {
      prm.enter_subsection(name);
      prm.declare_entry("Kind",
                        "box",
                        Patterns::Selection(
                          join(names_of(shape_list<dim>()), "|")),
                        "What the shape is.");
      const auto kind = chosen("Geometry/" + name + "/Kind", "box");
      for (const auto &entry : shape_list<dim>())
        if (entry.name == kind)
          entry.declare(prm);
      prm.leave_subsection();
    }
  } // namespace

  bool
  is_three_d(const ParameterFile::Chosen &chosen)
  {
    return kinds.is(chosen, "Geometry", GeometryKind::three_d);
  }

  void
  declare_geometry(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Geometry");
    kinds.declare(prm,
                  "Plane strain: x, y, forces per metre of thickness. "
                  "Plane stress: the same of a sheet, per metre of its "
                  "initial thickness, which is free to change. "
                  "Axisymmetric: r, z, forces of the whole circle.");
    declare_text(prm, "Shapes", "Names of the shapes, each with a subsection.");
    for (const auto &name : split_names(chosen("Geometry/Shapes", "")))
      if (is_three_d(chosen))
        declare_shape<3>(prm, chosen, name);
      else
        declare_shape<2>(prm, chosen, name);
    prm.leave_subsection();
  }

  GeometryKind
  read_geometry(ParameterHandler &prm)
  {
    GeometryKind kind{};
    in_section(prm, "Geometry", [&]() { kind = kinds.read(prm); });
    return kind;
  }

  template <int dim>
  NamedShapes<dim>
  read_shapes(ParameterHandler &prm, const Constants &constants)
  {
    NamedShapes<dim> shapes;
    in_section(prm, "Geometry", [&]() {
      for (const auto &name : split_names(prm.get("Shapes")))
        in_section(prm, name, [&]() {
          for (const auto &entry : shape_list<dim>())
            if (entry.name == prm.get("Kind"))
              shapes[name] = std::make_shared<const Shape<dim>>(
                entry.create(prm, constants, shapes));
        });
    });
    return shapes;
  }

  template NamedShapes<2>
  read_shapes(ParameterHandler &, const Constants &);
  template NamedShapes<3>
  read_shapes(ParameterHandler &, const Constants &);
} // namespace impm
