#include <deal.II/base/bounding_box.h>
#include <deal.II/base/utilities.h>

#include <impm/input/sections/boundary_conditions.h>

#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace impm
{
  namespace
  {
    using boost::algorithm::ends_with;
    using boost::algorithm::starts_with;

    template <int dim>
    void
    add_face(const Section     &section,
             FaceSpec<dim>     &face,
             const unsigned int normal,
             const bool         lagrangian)
    {
      face.name       = section.name;
      const auto type = section.text(
        "Type",
        "free",
        Patterns::Selection("free|fixed|slip|displacement|velocity|"
                            "normal displacement|normal velocity|traction|"
                            "pressure"),
        "Of the face of the domain. Slip: no motion through it. "
        "Traction, pressure: only on a Lagrangian grid, which fits the body; "
        "elsewhere bodies have them on their surfaces (section Loads).");
      const bool pressure = type == "pressure";
      const bool loaded   = type == "traction" || pressure;
      face.is_pressed     = pressure;
      if (loaded && !lagrangian)
        section.refuse("Type",
                       "which is for a Lagrangian grid: only there is the face "
                       "of the domain one of the body");
      const bool only_normal = type == "slip" || starts_with(type, "normal ");
      if (type != "free" && !loaded)
        for (unsigned int d = 0; d < dim; ++d)
          face.constrained[d] = !only_normal || d == normal;
      if (type == "free" || type == "fixed" || type == "slip")
        return;
      const std::string value =
        "Displacement since the start (m), velocity (m/s) or force per initial "
        "area (Pa): expressions in x, y, z, t, one for each direction, between "
        "semicolons; 'free' instead of one leaves that component of a motion "
        "free. A normal one has one, along the axis. A pressure (Pa), which "
        "follows the face and points into the body, has one, too, in places as "
        "they are.";
      if (loaded || only_normal)
        section.add("Value",
                    pressure ? face.pressure :
                    loaded   ? face.traction :
                               face.value,
                    {only_normal || pressure ? 1U : dim, in_time},
                    value);
      else
        section.add("Value", face.value, face.constrained, value);
      section.require("Value", "are expressions");
      if (loaded)
        return;
      face.is_velocity = ends_with(type, "velocity");
      if (!lagrangian)
        section.add("Moves the grid",
                    face.moves_grid,
                    false,
                    "The grid is stretched with this face, which moves as a "
                    "plane.");
      if (face.moves_grid && !face.constrained[normal])
        section.refuse("Moves the grid",
                       "which takes a face whose normal component is not free");
    }

    template <int dim>
    void
    add_grip(const Section     &section,
             GripSpec<dim>     &grip,
             const Bodies<dim> &bodies)
    {
      grip.name = section.name;
      section.add("Body", grip.body_name, "Name of a deformable body.");
      section.require_name("Body",
                           grip.body_name,
                           names_of_bodies(bodies, false));
      grip.body =
        std::find_if(bodies.begin(),
                     bodies.end(),
                     [&](const auto &b) { return b.name == grip.body_name; }) -
        bodies.begin();
      section.add(
        "Where",
        grip.where,
        {1, steady},
        "Expression in x, y, z: the grip holds the nodes of all cells "
        "with points of the body whose places at the start make it "
        "positive.");
      section.require("Where", "is an expression");
      section.add("Type",
                  grip.is_velocity,
                  {{"displacement", false}, {"velocity", true}},
                  "What is prescribed.");
      grip.constrained.fill(true);
      section.add(
        "Value",
        grip.value,
        grip.constrained,
        "Displacement since the start (m), in x, y, z at the start and "
        "t, or velocity (m/s), in x, y, z as they are and t: "
        "expressions, one for each direction, between semicolons; "
        "'free' instead of one leaves that component free.");
      section.require("Value", "are expressions");
      grip.varies = grip.value && !is_uniform(*grip.value);
      if (grip.varies && !grip.is_velocity &&
          std::count(grip.constrained.begin(), grip.constrained.end(), false))
        section.refuse("Value",
                       "allowed for a displacement, where a component is free, "
                       "are expressions in t: where points have been at the "
                       "start is not known");
    }

    /**
     * A lattice of places on a face of the grid, between its edges and with
     * them, that has so many steps in each direction along the face.
     */
    template <int dim>
    std::vector<dealii::Point<dim>>
    places_on_face(const GridSpec<dim>                 &grid,
                   const unsigned int                   face,
                   const std::array<unsigned int, dim> &n_steps)
    {
      const unsigned int normal = face / 2;
      unsigned int       n      = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n *= d == normal ? 1 : n_steps[d] + 1;
      std::vector<dealii::Point<dim>> places(n);
      for (unsigned int k = 0; k < n; ++k)
        {
          unsigned int index = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              double share = face % 2;
              if (d != normal)
                {
                  share = 1. * (index % (n_steps[d] + 1)) / n_steps[d];
                  index /= n_steps[d] + 1;
                }
              places[k][d] = (1 - share) * grid.lower_corner[d] +
                             share * grid.upper_corner[d];
            }
        }
      return places;
    }

    /**
     * What holds one component holds the normal only where the map leaves the
     * face a plane across its axis: looks at the vertices of the face.
     */
    template <int dim>
    void
    check_mapped_face(const Section       &section,
                      const GridSpec<dim> &grid,
                      const unsigned int   number)
    {
      const unsigned int     normal = number / 2;
      dealii::Vector<double> image(dim);
      auto                   n_steps = grid.cells;
      for (auto &n : n_steps)
        n = std::min(n, 1000U); // more would take long, and show no more
      auto places = places_on_face<dim>(grid, number, n_steps);
      for (auto &place : places)
        {
          grid.map->vector_value(place, image);
          std::copy(image.begin(), image.end(), place.begin_raw());
        }
      const dealii::BoundingBox<dim> box(places);
      const auto &[lower, upper] = box.get_boundary_points();
      if (!(upper[normal] - lower[normal] > 1e-10 * upper.distance(lower)))
        return;
      std::ostringstream text;
      text << "which holds "
           << "xyz"[normal] << ", but Map makes this face reach from "
           << "xyz"[normal] << " = " << lower[normal] << " to " << upper[normal]
           << " m; allowed on a face that is no plane across its axis are "
              "free, fixed, displacement, velocity, traction";
      section.refuse("Type", text.str());
    }

    /**
     * Whether a face is to move along its normal by more than half a cell, as
     * small as one may get: looks at some instants of the run, on a coarse
     * lattice of the face.
     */
    template <int dim>
    bool
    moves_out_of_cells(const Section       &section,
                       const FaceSpec<dim> &face,
                       const GridSpec<dim> &grid,
                       const unsigned int   number)
    {
      const unsigned int normal = number / 2;
      if (!face.value || !face.constrained[normal])
        return false;
      const double end = dealii::Utilities::string_to_double(
        section.chosen("Time/End time", ""));
      const double cell =
        (grid.upper_corner[normal] - grid.lower_corner[normal]) /
        std::ldexp(grid.cells[normal],
                   std::max(grid.refinement_levels, grid.finest_level));
      const ExpressionTrial trial; // where material need not be
      const unsigned int component = face.value->n_components == 1 ? 0 : normal;
      const unsigned int n_times   = 16;
      std::array<unsigned int, dim> n_steps;
      n_steps.fill(2);
      for (const auto &place : places_on_face<dim>(grid, number, n_steps))
        {
          face.value->set_time(0);
          const double start = face.value->value(place, component);
          double       way = 0, last = start;
          for (unsigned int i = 1; i <= n_times; ++i)
            {
              face.value->set_time(end * i / n_times);
              const double now = face.value->value(place, component);
              way  = face.is_velocity ? way + (last + now) / 2 * end / n_times :
                                        now - start;
              last = now;
              if (std::abs(way) > 0.5 * cell)
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

  template <int dim>
  void
  add_boundary_conditions(const Section              &top,
                          Faces<dim>                 &faces,
                          std::vector<GripSpec<dim>> &grips,
                          const Bodies<dim>          &bodies,
                          const GridSpec<dim>        &grid,
                          std::vector<std::string>   &warnings)
  {
    const auto section    = top.subsection("Boundary conditions");
    bool       moves_grid = false;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        const auto subsection = section.subsection(face_names()[f]);
        const auto type       = section.subsection(face_names()[f]).get("Type");
        add_face(subsection, faces[f], f / 2, grid.is_lagrangian());
        if (grid.map && (type == "slip" || starts_with(type, "normal ")))
          check_mapped_face(subsection, grid, f);
        if (faces[f].moves_grid && moves_grid)
          subsection.fail("Moves the grid",
                          "found a second face that moves the grid, allowed "
                          "is one");
        moves_grid = moves_grid || faces[f].moves_grid;
        if (!grid.is_lagrangian() && !faces[f].moves_grid &&
            moves_out_of_cells(subsection, faces[f], grid, f))
          warnings.push_back(
            "face '" + subsection.name +
            "' is to move, but not the grid with it: the face holds the nodes "
            "of the cells at it as long as material is there, and nothing "
            "once the material has left them; see 'Moves the grid'");
      }
    for (const auto &name : section.names(
           "Grips",
           "Names of parts of bodies whose motion is prescribed, each with a "
           "subsection."))
      {
        if (std::count(face_names().begin(), face_names().end(), name) > 0)
          {
            section.fail("Grips",
                         "found '" + name + "', which is taken by a face");
            continue; // when declaring, which the face does
          }
        for (const auto &body : bodies)
          if (body.name == name)
            section.fail("Grips",
                         "found '" + name + "', which is taken by a body");
        add_grip(section.subsection(name), grips.emplace_back(), bodies);
      }
  }

  template void
  add_boundary_conditions(const Section &,
                          Faces<2> &,
                          std::vector<GripSpec<2>> &,
                          const Bodies<2> &,
                          const GridSpec<2> &,
                          std::vector<std::string> &);
  template void
  add_boundary_conditions(const Section &,
                          Faces<3> &,
                          std::vector<GripSpec<3>> &,
                          const Bodies<3> &,
                          const GridSpec<3> &,
                          std::vector<std::string> &);
} // namespace impm
