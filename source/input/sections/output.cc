#include <deal.II/base/config.h>

#include <impm/input/sections/geometry.h>
#include <impm/input/sections/output.h>
#include <impm/points/point_fields.h>

#include <algorithm>

namespace impm
{
  namespace
  {
    /** Whether a picture, a probe or a reference has photoelastic fringes. */
    bool
    shows_fringes(const Chosen &chosen)
    {
      auto fields = split_names(chosen("Output/Point fields", ""));
      for (const std::string list : {"Output/Probes", "Reference/Names"})
        for (const auto &name : names_in(chosen, list))
          fields.push_back(
            chosen(list.substr(0, list.find('/') + 1) + name + "/Field", ""));
      return std::count(fields.begin(), fields.end(), "photoelastic_fringe") >
             0;
    }

    void
    add_pictures(const Section &section, OutputSpec &output)
    {
      section.add("Pictures",
                  output.pictures,
                  true,
                  "Whether VTU files of points and grid are written.");
      // Also where pictures are off, so that a study can switch them off.
      section.add("Format",
                  output.format,
                  {{"vtu", PictureFormat::vtu}, {"hdf5", PictureFormat::hdf5}},
                  "vtu: PVD files that name VTU files, one a rank. hdf5: XDMF "
                  "files that name HDF5 files, one for all ranks: for large "
                  "runs.");
#ifndef DEAL_II_WITH_HDF5
      if (output.format == PictureFormat::hdf5)
        section.refuse("Format",
                       "allowed is vtu, since deal.II was built without HDF5");
#endif
      section.add("Time between pictures",
                  output.picture_interval,
                  {"0", 0},
                  "(s); 0: by the number of steps.");
      if (output.picture_interval == 0)
        section.add("Steps between pictures",
                    output.picture_steps,
                    {"10", 1},
                    "Number of steps.");
    }

    void
    add_checkpoints(const Section &section, OutputSpec &output)
    {
      section.add(
        "Interval in steps",
        output.checkpoint_steps,
        {"0", 0},
        "Number of steps from a checkpoint to the next; 0: not by steps.");
      section.add("Interval in wall time",
                  output.checkpoint_seconds,
                  {"600", 0},
                  "(s); 0: not by time. Where either interval is given, the "
                  "end of the run is a checkpoint, too. A signal to stop, or "
                  "a computation that cannot go on, makes one always.");
    }

    void
    add_point_fields(const Section &section, OutputSpec &output, const int dim)
    {
      section.add("Point fields",
                  output.point_fields,
                  "Fields of the points; those that this scene does not have "
                  "are left out. Pictures of points always have displacement "
                  "and id.",
                  "velocity, displacement, cauchy_stress, von_mises_stress, "
                  "equivalent_plastic_strain, damage, deformation_gradient, "
                  "initial_domain, volume, body, id");
      if (!output.pictures)
        output.point_fields.clear();
      for (const auto &field : output.point_fields)
        check_field(section, "Point fields", field, dim);
      if (shows_fringes(section.chosen))
        section.add("Fringe number",
                    output.fringe_number,
                    {"7", above_zero},
                    "Of the field photoelastic_fringe: how many fringes there "
                    "are from no stress to the largest difference of "
                    "principal stresses.");
    }

    using ProbeKind = ProbeSpec::Kind;

    /** Over which points of which bodies. */
    template <int dim>
    void
    add_region(const Section     &section,
               ProbeSpec         &probe,
               const Bodies<dim> &bodies)
    {
      section.add("Bodies",
                  probe.bodies,
                  "Names of bodies; empty: all deformable ones.");
      for (const auto &body : probe.bodies)
        section.require_name("Bodies", body, names_of_bodies(bodies, false));
      std::shared_ptr<dealii::FunctionParser<dim>> where;
      section.add("Where",
                  where,
                  {1, steady},
                  "Expression in x, y, z at the start: only points that make "
                  "it positive count; empty: all.");
      if (where)
        probe.where = [where](const double *initial_position) {
          dealii::Point<dim> place;
          std::copy_n(initial_position, dim, place.begin_raw());
          return where->value(place);
        };
    }

    template <int dim>
    void
    add_mover(const Section     &section,
              ProbeSpec         &probe,
              const Faces<dim>  &faces,
              const Bodies<dim> &bodies)
    {
      section.add("Of", probe.of, "A face of the domain or a rigid body.");
      auto movable = names_of_bodies(bodies, true);
      for (const auto &face : faces)
        if (face.moves_grid)
          movable.insert(movable.begin(), face.name);
      section.require_name("Of", probe.of, movable);
      using Quantity = ProbeSpec::Quantity;
      section.add("Quantity",
                  probe.quantity,
                  {{"displacement", Quantity::displacement},
                   {"velocity", Quantity::velocity},
                   {"rotation", Quantity::rotation},
                   {"angular velocity", Quantity::angular_velocity}},
                  "Displacement: of a face, or of the centre of a rigid body "
                  "(m). Rotation: of a rigid body (rad; in space of a free "
                  "one, the vector, up to half a turn). Velocity (m/s), "
                  "angular velocity (rad/s): of a free rigid body.");
      const auto body =
        std::find_if(bodies.begin(), bodies.end(), [&](const auto &one) {
          return one.name == probe.of;
        });
      if (probe.quantity != Quantity::displacement && body == bodies.end())
        section.refuse("Quantity", "allowed for a face is displacement");
      if ((probe.quantity == Quantity::velocity ||
           probe.quantity == Quantity::angular_velocity) &&
          body != bodies.end() && !body->is_free)
        section.refuse("Quantity",
                       "allowed for a body whose motion is prescribed are "
                       "displacement, rotation");
    }

    /** Of a vector. */
    template <int dim>
    void
    add_component(const Section &section,
                  const bool     has_field,
                  ProbeSpec     &probe)
    {
      const bool is_rotation =
        probe.quantity == ProbeSpec::Quantity::rotation ||
        probe.quantity == ProbeSpec::Quantity::angular_velocity;
      if (dim == 2 && is_rotation)
        {
          probe.component = 2; // about z
          return;
        }
      section.add("Component",
                  probe.component,
                  {"0", 0, 8},
                  "Of the vector or, by rows, of the 3 x 3 tensor.");
      if (!has_field && probe.component >= dim)
        section.refuse("Component",
                       "allowed is less than " + std::to_string(dim));
    }

    template <int dim>
    void
    add_probe(const Section     &section,
              ProbeSpec         &probe,
              const Faces<dim>  &faces,
              const Bodies<dim> &bodies)
    {
      probe.name = section.name;
      section.add(
        "Kind",
        probe.kind,
        {{"point", ProbeKind::point},
         {"largest", ProbeKind::largest},
         {"smallest", ProbeKind::smallest},
         {"spread", ProbeKind::spread},
         {"mean", ProbeKind::mean},
         {"extent", ProbeKind::extent},
         {"lower extent", ProbeKind::lower_extent},
         {"motion", ProbeKind::motion}},
        "point: at the point nearest to a place at the start, from which a "
        "displacement is carried on to the place by F. Largest, smallest, "
        "spread (their difference), mean: over bodies. Extent: largest "
        "coordinate, the points' domains included, and lower extent the "
        "smallest. Motion: of a moving face or a rigid body.");
      if (probe.kind == ProbeKind::point)
        probe.position =
          section.numbers("Position", dim, "Place at the start (m).");
      else if (probe.kind == ProbeKind::motion)
        add_mover(section, probe, faces, bodies);
      else
        add_region(section, probe, bodies);
      const bool has_field = probe.kind != ProbeKind::motion &&
                             probe.kind != ProbeKind::extent &&
                             probe.kind != ProbeKind::lower_extent;
      if (has_field)
        {
          section.add("Field",
                      probe.field,
                      "A field of the points, as in the pictures.",
                      "displacement");
          check_field(section, "Field", probe.field, dim);
        }
      add_component<dim>(section, has_field, probe);
      section.add("Factor",
                  probe.factor,
                  {"1"},
                  "Multiplies the figure: any number.");
    }

    template <int dim>
    void
    add_reaction(const Section                    &section,
                 ReactionSpec                     &reaction,
                 const Faces<dim>                 &faces,
                 const std::vector<GripSpec<dim>> &grips,
                 const Bodies<dim>                &bodies)
    {
      reaction.name = section.name;
      section.add("On",
                  reaction.on,
                  "A face of the domain, a rigid body or a grip.");
      std::vector<std::string> carriers;
      for (const auto &face : faces)
        if (std::count(face.constrained.begin(),
                       face.constrained.end(),
                       true) ||
            !face.released_layers.empty())
          carriers.push_back(face.name);
      for (const auto &body : names_of_bodies(bodies, true))
        carriers.push_back(body);
      for (const auto &grip : grips)
        carriers.push_back(grip.name);
      for (const auto &face : faces)
        if (face.name == reaction.on &&
            std::count(carriers.begin(), carriers.end(), face.name) == 0)
          section.fail("On",
                       "found '" + reaction.on +
                         "', a free face, which bears nothing; allowed are: " +
                         (carriers.empty() ? "none" : join(carriers, ", ")));
      section.require_name("On", reaction.on, carriers);
      section.add("Kind",
                  reaction.is_moment,
                  {{"force", false}, {"moment", true}},
                  "Force: of the material on it. Moment: of these forces, at "
                  "their places at the end of a step, about a point; in the "
                  "plane about z, for each metre of thickness.");
      if (reaction.is_moment)
        {
          if (is_axisymmetric(section.chosen))
            section.refuse("Kind",
                           "allowed in axisymmetry, where moments are none, is "
                           "force");
          reaction.about =
            section.numbers("About", dim, "The point (m), which is at rest.");
          if (dim == 2)
            {
              reaction.direction = {0, 0, 1};
              section.add("Factor",
                          reaction.factor,
                          {"1"},
                          "Multiplies the figure: any number.");
              return;
            }
        }
      reaction.direction =
        section.numbers("Direction",
                        dim,
                        "The force of the material on it, or the moment, is "
                        "projected on this vector.");
      if (std::all_of(reaction.direction.begin(),
                      reaction.direction.end(),
                      [](const double value) { return value == 0; }))
        section.refuse("Direction", "allowed is a vector that is not zero");
      section.add("Factor",
                  reaction.factor,
                  {"1"},
                  "Multiplies the figure: any number.");
    }
  } // namespace

  template <int dim>
  void
  add_output(const Section                    &top,
             OutputSpec                       &output,
             const Faces<dim>                 &faces,
             const std::vector<GripSpec<dim>> &grips,
             const Bodies<dim>                &bodies)
  {
    const auto section = top.subsection("Output");
    section.add("Directory",
                output.directory,
                "Where results go; empty: output/<name of the file>.");
    add_pictures(section, output);
    section.add("Steps between rows",
                output.row_steps,
                {"1", 1},
                "Number of steps from a row of the history, with a line on "
                "the screen, to the next; the last step of a run has one in "
                "any case. Newton and linear iterations, line searches, step "
                "cuts, tangent projections, solver fallbacks and noise stops "
                "are sums over the steps since the row before.");
    add_checkpoints(section.subsection("Checkpoints"), output);
    add_point_fields(section, output, dim);
    const std::string what =
      "Names of columns of the history, each with a subsection.";
    const auto probes    = section.names("Probes", what);
    const auto reactions = section.names("Reactions", what);
    for (const auto &name : probes)
      add_probe(section.subsection(name),
                output.probes.emplace_back(),
                faces,
                bodies);
    for (const auto &name : reactions)
      add_reaction(section.subsection(name),
                   output.reactions.emplace_back(),
                   faces,
                   grips,
                   bodies);
  }

  void
  check_field(const Section     &section,
              const std::string &entry,
              const std::string &field,
              const int          dim)
  {
    section.require_name(entry, field, point_field_names());
    if (dim == 3 && is_plane_field(field))
      section.fail(entry,
                   "found '" + field +
                     "', a field of the plane, which 3D does not have");
  }

  template void
  add_output(const Section &,
             OutputSpec &,
             const Faces<2> &,
             const std::vector<GripSpec<2>> &,
             const Bodies<2> &);
  template void
  add_output(const Section &,
             OutputSpec &,
             const Faces<3> &,
             const std::vector<GripSpec<3>> &,
             const Bodies<3> &);
} // namespace impm
