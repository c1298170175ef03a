#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/input/sections/geometry.h>
#include <impm/input/sections/grid.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    enum class FaceType
    {
      free,
      fixed,
      slip,
      displacement,
      velocity,
      normal_displacement,
      normal_velocity,
      traction
    };

    const Choice<FaceType>
      types("Type",
            {{"free", FaceType::free},
             {"fixed", FaceType::fixed},
             {"slip", FaceType::slip},
             {"displacement", FaceType::displacement},
             {"velocity", FaceType::velocity},
             {"normal displacement", FaceType::normal_displacement},
             {"normal velocity", FaceType::normal_velocity},
             {"traction", FaceType::traction}});

    void
    declare_face(ParameterHandler            &prm,
                 const ParameterFile::Chosen &chosen,
                 const std::string           &section)
    {
      types.declare(
        prm,
        "Of the face of the domain. Slip: no motion through it. Traction: "
        "only on a Lagrangian grid, which fits the body.");
      for (const auto type : {FaceType::free, FaceType::fixed, FaceType::slip})
        if (types.is(chosen, section, type))
          return;
      declare_text(prm,
                   "Value",
                   "Displacement since the start (m), velocity "
                   "(m/s) or force per initial area (Pa): "
                   "expressions in x, y, z, t, one for "
                   "each direction, between semicolons; a normal "
                   "one has one, along the axis.");
      if (!types.is(chosen, section, FaceType::traction) &&
          !is_lagrangian(chosen))
        prm.declare_entry("Moves the grid",
                          "false",
                          Patterns::Bool(),
                          "The grid is stretched with this face, which "
                          "moves as a plane.");
    }

    template <int dim>
    FaceSpec<dim>
    read_face(const ParameterHandler &prm,
              const unsigned int      face,
              const bool              lagrangian,
              const Constants        &constants)
    {
      FaceSpec<dim> spec;
      spec.name       = face_names()[face];
      const auto type = types.read(prm);
      if (type == FaceType::traction)
        {
          if (!lagrangian)
            throw InputError("Type",
                             "found 'traction', which is for a Lagrangian "
                             "grid: only there is the face of the domain one "
                             "of the body");
          spec.traction =
            read_expressions<dim>(prm, "Value", dim, true, constants);
        }
      if (type == FaceType::free || type == FaceType::traction)
        return spec;
      const bool only_normal = type == FaceType::slip ||
                               type == FaceType::normal_displacement ||
                               type == FaceType::normal_velocity;
      for (unsigned int d = 0; d < dim; ++d)
        spec.constrained[d] = !only_normal || d == face / 2;
      if (type == FaceType::fixed || type == FaceType::slip)
        return spec;
      spec.is_velocity =
        type == FaceType::velocity || type == FaceType::normal_velocity;
      spec.value = read_expressions<dim>(
        prm, "Value", only_normal ? 1 : dim, true, constants);
      if (!spec.value)
        throw InputError("Value", "found '', allowed are expressions");
      spec.moves_grid = !lagrangian && prm.get_bool("Moves the grid");
      return spec;
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
  declare_boundary_conditions(ParameterHandler            &prm,
                              const ParameterFile::Chosen &chosen)
  {
    const unsigned int n_faces = is_three_d(chosen) ? 6 : 4;
    for (unsigned int f = 0; f < n_faces; ++f)
      {
        const auto section = "Boundary conditions/" + face_names()[f];
        in_section(prm, section, [&]() { declare_face(prm, chosen, section); });
      }
  }

  template <int dim>
  Faces<dim>
  read_boundary_conditions(ParameterHandler &prm,
                           const bool        lagrangian,
                           const Constants  &constants)
  {
    Faces<dim> faces;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      in_section(prm, "Boundary conditions/" + face_names()[f], [&]() {
        faces[f] = read_face<dim>(prm, f, lagrangian, constants);
      });
    return faces;
  }

  template <int dim>
  void
  check_faces(const Faces<dim> &faces)
  {
    unsigned int movers = 0;
    for (const auto &face : faces)
      if (face.moves_grid && ++movers > 1)
        throw InputError("Boundary conditions/" + face.name + "/Moves the grid",
                         "found a second face that moves the grid, allowed "
                         "is one");
  }

  template Faces<2>
  read_boundary_conditions(ParameterHandler &, bool, const Constants &);
  template Faces<3>
  read_boundary_conditions(ParameterHandler &, bool, const Constants &);
  template void
  check_faces<2>(const Faces<2> &);
  template void
  check_faces<3>(const Faces<3> &);
} // namespace impm
