#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/input/sections/geometry.h>
#include <impm/input/sections/time.h>

#include <boost/range/adaptor/map.hpp>

#include <algorithm>

namespace impm
{
  namespace
  {
    const Choice<bool> from_file("Points from",
                                 {{"shape", false}, {"file", true}});

    const unsigned int no_slip = 3, by_surface = 4;

    /** What an entry names. */
    template <typename Item>
    Item
    add_name(const Section                     &section,
             const std::string                 &entry,
             const std::map<std::string, Item> &items,
             const std::string                 &documentation)
    {
      std::string name;
      section.add(entry, name, documentation);
      const auto it = items.find(name);
      if (it != items.end())
        return it->second;
      section.refuse(entry,
                     "allowed are: " +
                       (items.empty() ?
                          "none, since none is named" :
                          join(items | boost::adaptors::map_keys, ", ")));
      return nullptr;
    }

    /** One number for all directions, or one for each. */
    template <int dim>
    void
    add_points_per_cell(const Section &section, BodySpec<dim> &body)
    {
      const std::string entry = "Points per cell";
      const bool        one   = split_names(section.get(entry)).size() == 1;
      const auto        values =
        section.numbers(entry,
                        one ? 1 : dim,
                        "In each direction of a cell, one number for all or "
                        "one for each; Gauss points if the grid is Lagrangian.",
                        "2",
                        Patterns::List(Patterns::Integer(1, 20), 1, 3));
      for (unsigned int d = 0; d < dim; ++d)
        body.points_per_cell[d] = values[one ? 0 : d];
    }

    template <int dim>
    void
    add_surface(const Section &section, BodySpec<dim> &body)
    {
      std::vector<typename Choice<SurfaceSeeding>::Option> options = {
        {"cut cells", SurfaceSeeding::cut_boxes},
        {"points", SurfaceSeeding::whole_boxes},
        {"whole cells", SurfaceSeeding::whole_cells}};
      if (!is_quasi_static(section.chosen))
        std::swap(options[0], options[1]);
      section.add("Surface",
                  body.surface,
                  options,
                  "What points stand for in cells that the surface of the "
                  "shape cuts. Cut cells: for what of their part of the cell "
                  "lies inside. Points: for all of their part, if its middle "
                  "lies inside. Whole cells: the same, if the middle of the "
                  "cell lies inside, so that no cell serves two materials. "
                  "The default is cut cells for quasi-static runs, else "
                  "points, since little points come off where bodies meet.");
    }

    template <int dim>
    void
    check_place(const Section       &section,
                const Shape<dim>    &shape,
                const GridSpec<dim> &grid,
                const bool           is_rigid)
    {
      const auto box = shape.bounding_box;
      if (!box || grid.is_lagrangian())
        return;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double lower = box->lower_bound(d), upper = box->upper_bound(d);
          const double slack = 1e-10 * (upper - lower);
          if (lower < grid.lower_corner[d] - slack ||
              upper > grid.upper_corner[d] + slack)
            section.fail("Shape",
                         "body '" + section.name + "' reaches from " +
                           std::to_string(lower) + " to " +
                           std::to_string(upper) + " m in direction " +
                           "xyz"[d] + ", allowed is the grid's " +
                           std::to_string(grid.lower_corner[d]) + " to " +
                           std::to_string(grid.upper_corner[d]) + " m" +
                           (is_rigid ?
                              ", or 'Contact = surface', which needs no nodes" :
                              ""));
        }
    }

    template <int dim>
    void
    add_points(const Section          &section,
               BodySpec<dim>          &body,
               const NamedShapes<dim> &shapes,
               const GridSpec<dim>    &grid)
    {
      const bool lagrangian   = grid.is_lagrangian();
      bool       is_from_file = false;
      section.add(from_file, is_from_file, "Where the points come from.");
      if (lagrangian && is_from_file)
        section.refuse("Points from",
                       "allowed on a Lagrangian grid, where points are Gauss "
                       "points, is 'shape'");
      if (body.meets_surfaces && is_from_file)
        section.refuse("Points from",
                       "allowed with 'Contact = surface' is 'shape'");
      if (section.chooses(from_file, false))
        {
          body.shape = add_name(section,
                                "Shape",
                                shapes,
                                "Name of a shape of the section Geometry.");
          if (body.meets_surfaces)
            return;
          if (!lagrangian || !body.rigid)
            add_points_per_cell(section, body);
          else if (body.shape && !body.shape->is_box)
            section.refuse("Shape",
                           "allowed for a rigid body on a Lagrangian grid, "
                           "whose nodes stick to it, are boxes");
          if (!lagrangian && !body.rigid)
            add_surface(section, body);
          if (body.shape)
            check_place(section, *body.shape, grid, body.rigid);
        }
      if (section.chooses(from_file, true))
        section.add("File",
                    body.point_file,
                    "CSV (x, y, z, volume) or VTU file of the points; a path "
                    "from the file that sets it.");
    }

    /** Whether points split where they thin out. The papers' method does not.
     */
    template <int dim>
    void
    add_adaptation(const Section       &section,
                   BodySpec<dim>       &body,
                   const GridSpec<dim> &grid)
    {
      if (grid.is_lagrangian())
        return;
      using Option                = typename Choice<PointAdaptation>::Option;
      std::vector<Option> options = {{"off", PointAdaptation::off},
                                     {"split", PointAdaptation::split},
                                     {"split and merge",
                                      PointAdaptation::split_and_merge}};
      if (grid.method == GridMethod::gimp)
        std::swap(options[0], options[1]);
      section.add("Point adaptation",
                  body.adaptation,
                  options,
                  "Whether points are halved where they have become too long "
                  "for their cells, and merged where too many of them share a "
                  "cell. The default is split for GIMP, off for MPM.");
      if (body.adaptation >= PointAdaptation::split)
        section.add("Points across a cell",
                    body.points_across,
                    {"2", 0.5, 20},
                    "A point is halved across an edge of which fewer fit "
                    "across the cell, by a tenth.");
      if (body.adaptation == PointAdaptation::split_and_merge)
        section.add(
          "Merge tolerance",
          body.merge_tolerance,
          {"0.05", 0, 1},
          "Points are merged whose F, or J for laws that read no more "
          "of it, and whose history, in parts of the most that any "
          "point has gathered, differ by no more.");
    }

    template <int dim>
    void
    add_grip(const Section       &section,
             BodySpec<dim>       &body,
             const GridSpec<dim> &grid)
    {
      section.add(
        "Contact",
        body.slip_normal,
        {{"no slip", no_slip},
         {"slip x", 0},
         {"slip y", 1},
         {"slip z", 2},
         {"surface", by_surface}},
        "Whether material at its surface is held in all directions, "
        "or only in the normal one that is named (slip y: free "
        "along x and z). Surface: it has no points, may reach beyond "
        "the grid, and meets the surfaces of those bodies with which it makes "
        "a pair in the section Contact.");
      body.meets_surfaces = body.slip_normal == by_surface;
      if (body.meets_surfaces && grid.is_lagrangian())
        section.refuse("Contact",
                       "allowed on a Lagrangian grid are no slip, slip x, slip "
                       "y, slip z");
      if (body.slip_normal >= no_slip)
        body.slip_normal = dim;
      else if (body.slip_normal >= dim)
        section.refuse("Contact",
                       "allowed in 2D are no slip, slip x, slip y, "
                       "surface");
    }

    /** A turn that is prescribed beside the displacement. */
    template <int dim>
    void
    add_rotation(const Section       &section,
                 BodySpec<dim>       &body,
                 const GridSpec<dim> &grid)
    {
      section.add("Rotation",
                  body.rotation,
                  {1, in_time},
                  "Turn since the start (rad), an expression in t: in the "
                  "plane from x to y, in space about an axis; empty: none.");
      if (section.get("Rotation").empty())
        return;
      if (is_axisymmetric(section.chosen))
        section.refuse("Rotation",
                       "allowed in axisymmetry, where nothing turns in the "
                       "half plane, is none");
      if (grid.is_lagrangian())
        section.refuse("Rotation",
                       "allowed on a Lagrangian grid, whose nodes stick to "
                       "boxes, is none");
      if (body.slip_normal < dim)
        section.refuse("Rotation",
                       "allowed with 'Contact = slip', which holds nodes in a "
                       "direction of the grid, is none");
      const auto centre =
        section.numbers("Centre",
                        dim,
                        "About which it turns, at the start (m). It moves with "
                        "the displacement.");
      std::copy(centre.begin(), centre.end(), body.centre.begin_raw());
      body.axis = dealii::Tensor<1, 3>({0, 0, 1});
      if (dim == 2)
        return;
      const auto axis = section.numbers("Axis",
                                        3,
                                        "Direction about which it turns, "
                                        "right-handed, of any length.",
                                        "0, 0, 1");
      std::copy(axis.begin(), axis.end(), body.axis.begin_raw());
      if (body.axis.norm() == 0)
        section.refuse("Axis", "allowed is a vector that is not zero");
      else
        body.axis /= body.axis.norm();
    }

    /** Mass, centre and inertia as they are given, of a body whose density is
     * not. */
    template <int dim>
    void
    add_inertia(const Section &section, RigidInertia<dim> &inertia)
    {
      const bool is_axisymmetric = impm::is_axisymmetric(section.chosen);
      std::optional<double> mass;
      section.add("Mass",
                  mass,
                  "(kg; in the plane for each metre of thickness).");
      section.require("Mass", "without 'Density' is a number greater than 0");
      if (mass && !(*mass > 0))
        section.refuse("Mass", "allowed is a number greater than 0");
      inertia.mass      = mass.value_or(0);
      const auto centre = section.numbers("Centre", dim, "Of mass (m).");
      std::copy(centre.begin(), centre.end(), inertia.centre.begin_raw());
      if (is_axisymmetric)
        return;
      const auto values = section.numbers(
        "Inertia",
        dim == 2 ? 1 : 6,
        "About the centre (kg m^2): in the plane one number, in space those of "
        "the tensor for xx, yy, zz, xy, xz, yz.");
      if (dim == 2)
        inertia.tensor[2][2] = values[0];
      else
        {
          inertia.tensor[0][1] = inertia.tensor[1][0] = values[3];
          inertia.tensor[0][2] = inertia.tensor[2][0] = values[4];
          inertia.tensor[1][2] = inertia.tensor[2][1] = values[5];
          for (unsigned int d = 0; d < 3; ++d)
            inertia.tensor[d][d] = values[d];
        }
      const auto &J = inertia.tensor;
      if (!(J[2][2] > 0 &&
            (dim == 2 ||
             (J[0][0] > 0 && J[0][0] * J[1][1] > J[0][1] * J[0][1] &&
              determinant(J) > 0))))
        section.refuse("Inertia",
                       dim == 2 ? "allowed is a number greater than 0" :
                                  "allowed is a tensor that is positive");
    }

    /** A rigid body that forces move. */
    template <int dim>
    void
    add_free_motion(const Section &section, BodySpec<dim> &body)
    {
      const bool is_axisymmetric = impm::is_axisymmetric(section.chosen);
      if (!body.meets_surfaces)
        section.refuse("Motion",
                       "allowed without 'Contact = surface' is "
                       "prescribed");
      if (is_quasi_static(section.chosen))
        section.refuse("Motion",
                       "allowed in quasi-static runs, which have no inertia, "
                       "is prescribed");
      std::optional<double> density;
      section.add("Density",
                  density,
                  "(kg/m^3) from which its shape gives mass, centre and "
                  "inertia; empty: these are given.");
      if (section.get("Density").empty() || !section.is_read)
        add_inertia(section, body.inertia);
      else
        {
          for (const std::string entry : {"Mass", "Centre", "Inertia"})
            if (!section.get(entry).empty())
              section.refuse(entry,
                             "allowed with 'Density', which gives it, is none");
          if (!(*density > 0))
            section.refuse("Density", "allowed is a number greater than 0");
          if (!body.shape->bounding_box)
            section.refuse("Density",
                           "allowed for a shape that does not tell how far it "
                           "reaches is none, with 'Mass', 'Centre' and "
                           "'Inertia'");
          body.inertia =
            inertia_of_shape(*body.shape, *density, is_axisymmetric);
          if (!(body.inertia.mass > 0))
            section.refuse("Density", "while the shape has no volume");
        }
      body.centre         = body.inertia.centre;
      const auto velocity = section.numbers("Velocity",
                                            dim,
                                            "Of the centre at the start (m/s).",
                                            dim == 2 ? "0, 0" : "0, 0, 0");
      std::copy(velocity.begin(),
                velocity.end(),
                body.free_velocity.begin_raw());
      if (is_axisymmetric)
        {
          if (velocity[0] != 0)
            section.refuse("Velocity",
                           "allowed in axisymmetry is one along the axis");
          return;
        }
      const auto spin =
        section.numbers("Angular velocity",
                        dim == 2 ? 1 : 3,
                        "At the start (rad/s): in the plane from x to y.",
                        dim == 2 ? "0" : "0, 0, 0");
      std::copy(spin.begin(),
                spin.end(),
                body.free_spin.begin_raw() + (dim == 2 ? 2 : 0));
    }

    template <int dim>
    void
    add_body(const Section          &section,
             BodySpec<dim>          &body,
             const NamedShapes<dim> &shapes,
             const NamedMaterials   &materials,
             const GridSpec<dim>    &grid)
    {
      body.name = section.name;
      section.add("Kind",
                  body.rigid,
                  {{"deformable", false}, {"rigid", true}},
                  "Rigid bodies move as prescribed. Nodes of a Lagrangian "
                  "grid that reach one stick to it.");
      if (body.rigid)
        add_grip(section, body, grid);
      add_points(section, body, shapes, grid);
      if (!body.rigid)
        {
          body.material =
            add_name(section, "Material", materials, "Name of a material.");
          add_adaptation(section, body, grid);
          if (!is_quasi_static(section.chosen))
            section.add("Velocity",
                        body.velocity,
                        {dim, steady},
                        "At the start (m/s): expressions in x, y, z, one for "
                        "each direction, between semicolons; empty: at rest.");
          return;
        }
      section.add("Motion",
                  body.is_free,
                  {{"prescribed", false}, {"free", true}},
                  "Of a rigid body with 'Contact = surface': free, forces of "
                  "contact and the body force move it; it passes through "
                  "rigid bodies and faces.");
      if (body.is_free)
        {
          add_free_motion(section, body);
          return;
        }
      section.add("Displacement",
                  body.displacement,
                  {dim, in_time},
                  "Since the start (m): expressions in t, one for each "
                  "direction, between semicolons.");
      add_rotation(section, body, grid);
    }
  } // namespace

  template <int dim>
  void
  add_bodies(const Section          &top,
             Bodies<dim>            &bodies,
             const NamedShapes<dim> &shapes,
             const NamedMaterials   &materials,
             const GridSpec<dim>    &grid)
  {
    const auto section = top.subsection("Bodies");
    for (const auto &name :
         section.names("Names", "Names of the bodies, each with a subsection."))
      {
        if (std::count(face_names().begin(), face_names().end(), name) > 0)
          section.fail("Names",
                       "found '" + name + "', which is taken by a face");
        add_body(section.subsection(name),
                 bodies.emplace_back(),
                 shapes,
                 materials,
                 grid);
      }
    if (names_of_bodies(bodies, false).empty())
      section.fail("Names",
                   "found no deformable body, allowed is at least one");
  }

  template void
  add_bodies(const Section &,
             Bodies<2> &,
             const NamedShapes<2> &,
             const NamedMaterials &,
             const GridSpec<2> &);
  template void
  add_bodies(const Section &,
             Bodies<3> &,
             const NamedShapes<3> &,
             const NamedMaterials &,
             const GridSpec<3> &);
} // namespace impm
