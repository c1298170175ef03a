#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/input/sections/geometry.h>
#include <impm/input/sections/grid.h>

#include <algorithm>
#include <sstream>

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

    /**
     * What holds one component holds the normal only where the map leaves the
     * face a plane across its axis: looks at all vertices of the face.
     */
    template <int dim>
    void
    check_mapped_face(const GridSpec<dim> &grid,
                      const FaceSpec<dim> &face,
                      const unsigned int   number)
    {
      const unsigned int     normal = number / 2;
      dealii::Vector<double> image(dim);
      dealii::Point<dim>     lower, upper;
      unsigned int           n = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n *= d == normal ? 1 : grid.cells[d] + 1;
      for (unsigned int k = 0; k < n; ++k)
        {
          dealii::Point<dim> place;
          unsigned int       index = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              double share = number % 2;
              if (d != normal)
                {
                  share = 1. * (index % (grid.cells[d] + 1)) / grid.cells[d];
                  index /= grid.cells[d] + 1;
                }
              place[d] = (1 - share) * grid.lower_corner[d] +
                         share * grid.upper_corner[d];
            }
          grid.map->vector_value(place, image);
          for (unsigned int d = 0; d < dim; ++d)
            {
              lower[d] = k == 0 ? image[d] : std::min(lower[d], image[d]);
              upper[d] = k == 0 ? image[d] : std::max(upper[d], image[d]);
            }
        }
      if (!(upper[normal] - lower[normal] > 1e-10 * upper.distance(lower)))
        return;
      const std::string  type = !face.value      ? "slip" :
                                face.is_velocity ? "normal velocity" :
                                                   "normal displacement";
      std::ostringstream text;
      text << "found '" << type << "', which holds "
           << "xyz"[normal] << ", but Map makes this face reach from "
           << "xyz"[normal] << " = " << lower[normal] << " to " << upper[normal]
           << " m; allowed on a face that is no plane across its axis are "
              "free, fixed, displacement, velocity, traction";
      throw InputError("Boundary conditions/" + face.name + "/Type",
                       text.str());
    }

    /**
     * Whether a face is to move along its normal: looks at some instants of
     * the run, on a coarse lattice of the face.
     */
    template <int dim>
    bool
    moves_along_normal(const FaceSpec<dim> &face,
                       const GridSpec<dim> &grid,
                       const double         end,
                       const unsigned int   number)
    {
      const unsigned int normal = number / 2;
      if (!face.value || !face.constrained[normal])
        return false;
      const unsigned int component = face.value->n_components == 1 ? 0 : normal;
      const unsigned int n_times = 16, n_places = dim == 2 ? 3 : 9;
      for (unsigned int k = 0; k < n_places; ++k)
        {
          dealii::Point<dim> place;
          unsigned int       index = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double share = d == normal ? number % 2 : 0.5 * (index % 3);
              if (d != normal)
                index /= 3;
              place[d] = (1 - share) * grid.lower_corner[d] +
                         share * grid.upper_corner[d];
            }
          face.value->set_time(0);
          const double start =
            face.is_velocity ? 0. : face.value->value(place, component);
          for (unsigned int i = 1; i <= n_times; ++i)
            {
              face.value->set_time(end * i / n_times);
              if (face.value->value(place, component) != start)
                return true;
            }
        }
      return false;
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
  check_faces(const Faces<dim> &faces, const GridSpec<dim> &grid)
  {
    unsigned int movers = 0;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        const auto &held = faces[f].constrained;
        if (grid.map && std::count(held.begin(), held.end(), true) == 1)
          check_mapped_face(grid, faces[f], f);
        if (faces[f].moves_grid && ++movers > 1)
          throw InputError("Boundary conditions/" + faces[f].name +
                             "/Moves the grid",
                           "found a second face that moves the grid, allowed "
                           "is one");
      }
  }

  template <int dim>
  void
  warn_of_faces(const Faces<dim>         &faces,
                const GridSpec<dim>      &grid,
                const TimeSpec           &time,
                std::vector<std::string> &warnings)
  {
    if (grid.is_lagrangian())
      return;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (!faces[f].moves_grid &&
          moves_along_normal(faces[f], grid, time.end, f))
        warnings.push_back(
          "face '" + faces[f].name +
          "' is to move, but not the grid with it: the face holds the nodes of "
          "the cells at it as long as material is there, and nothing once the "
          "material has left them; see 'Moves the grid'");
  }

  template Faces<2>
  read_boundary_conditions(ParameterHandler &, bool, const Constants &);
  template Faces<3>
  read_boundary_conditions(ParameterHandler &, bool, const Constants &);
  template void
  check_faces(const Faces<2> &, const GridSpec<2> &);
  template void
  check_faces(const Faces<3> &, const GridSpec<3> &);
  template void
  warn_of_faces(const Faces<2> &,
                const GridSpec<2> &,
                const TimeSpec &,
                std::vector<std::string> &);
  template void
  warn_of_faces(const Faces<3> &,
                const GridSpec<3> &,
                const TimeSpec &,
                std::vector<std::string> &);
} // namespace impm
