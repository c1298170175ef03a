#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/output_probes.h>

#include <algorithm>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    using Kind = ProbeSpec::Kind;

    const Choice<Kind> kinds("Kind",
                             {{"point", Kind::point},
                              {"largest", Kind::largest},
                              {"smallest", Kind::smallest},
                              {"spread", Kind::spread},
                              {"mean", Kind::mean},
                              {"extent", Kind::extent},
                              {"motion", Kind::motion}});
  } // namespace

  void
  declare_probe(ParameterHandler            &prm,
                const ParameterFile::Chosen &chosen,
                const std::string           &name)
  {
    prm.enter_subsection(name);
    kinds.declare(
      prm,
      "point: at the point nearest to a place at the start, from which a "
      "displacement is carried on to the place by F. Largest, "
      "smallest, spread (their difference), mean: over bodies. Extent: "
      "largest coordinate, the points' "
      "domains included. Motion: of a moving face or a rigid body.");
    const auto is = [&](const Kind kind) {
      return kinds.is(chosen, "Output/" + name, kind);
    };
    if (is(Kind::point))
      declare_text(prm, "Position", "Place at the start (m).");
    else if (is(Kind::motion))
      declare_text(prm, "Of", "A face of the domain or a rigid body.");
    else
      {
        declare_text(prm,
                     "Bodies",
                     "Names of bodies; empty: all deformable ones.");
        declare_text(prm,
                     "Where",
                     "Expression in x, y, z at the start: only points "
                     "that make it positive count; empty: all.");
      }
    if (!is(Kind::motion) && !is(Kind::extent))
      prm.declare_entry("Field",
                        "displacement",
                        Patterns::Anything(),
                        "A field of the points, as in the pictures.");
    prm.declare_entry("Component",
                      "0",
                      Patterns::Integer(0, 8),
                      "Of the vector or, by rows, of the 3 x 3 tensor.");
    prm.declare_entry("Factor",
                      "1",
                      Patterns::Double(),
                      "Multiplies the figure.");
    prm.leave_subsection();
  }

  template <int dim>
  ProbeSpec
  read_probe(ParameterHandler  &prm,
             const std::string &name,
             const Constants   &constants)
  {
    ProbeSpec probe;
    in_section(prm, name, [&]() {
      probe.name = name;
      probe.kind = kinds.read(prm);
      if (probe.kind == Kind::point)
        probe.position = get_numbers(prm, "Position", dim);
      else if (probe.kind == Kind::motion)
        probe.of = prm.get("Of");
      else
        {
          probe.bodies = split_names(prm.get("Bodies"));
          const auto where =
            read_expressions<dim>(prm, "Where", 1, false, constants);
          if (where)
            probe.where = [where](const double *initial_position) {
              dealii::Point<dim> place;
              std::copy_n(initial_position, dim, place.begin_raw());
              return where->value(place);
            };
        }
      if (probe.kind != Kind::motion && probe.kind != Kind::extent)
        probe.field = prm.get("Field");
      probe.component = prm.get_integer("Component");
      probe.factor    = prm.get_double("Factor");
    });
    return probe;
  }

  template <int dim>
  void
  check_probe(const ProbeSpec   &probe,
              const Faces<dim>  &faces,
              const Bodies<dim> &bodies)
  {
    const std::string section = "Output/" + probe.name;
    if (probe.kind == Kind::motion)
      {
        auto movable = names_of_bodies(bodies, true);
        for (const auto &face : faces)
          if (face.moves_grid)
            movable.insert(movable.begin(), face.name);
        require_name(movable, probe.of, section + "/Of");
      }
    for (const auto &body : probe.bodies)
      require_name(names_of_bodies(bodies, false), body, section + "/Bodies");
    if (probe.component >= dim &&
        (probe.kind == Kind::extent || probe.kind == Kind::motion))
      throw InputError(section + "/Component",
                       "found " + std::to_string(probe.component) +
                         ", allowed is less than " + std::to_string(dim));
  }

  void
  declare_reaction(ParameterHandler &prm, const std::string &name)
  {
    prm.enter_subsection(name);
    declare_text(prm, "On", "A face of the domain or a rigid body.");
    declare_text(prm,
                 "Direction",
                 "The force of the material on it is projected on "
                 "this vector.");
    prm.declare_entry("Factor",
                      "1",
                      Patterns::Double(),
                      "Multiplies the figure.");
    prm.leave_subsection();
  }

  template <int dim>
  ReactionSpec
  read_reaction(ParameterHandler &prm, const std::string &name)
  {
    ReactionSpec reaction;
    in_section(prm, name, [&]() {
      reaction = {name,
                  prm.get("On"),
                  get_numbers(prm, "Direction", dim),
                  prm.get_double("Factor")};
    });
    return reaction;
  }

  template <int dim>
  void
  check_reaction(const ReactionSpec &reaction,
                 const Faces<dim>   &faces,
                 const Bodies<dim>  &bodies)
  {
    std::vector<std::string> carriers;
    for (const auto &face : faces)
      if (std::count(face.constrained.begin(), face.constrained.end(), true))
        carriers.push_back(face.name);
    for (const auto &body : names_of_bodies(bodies, true))
      carriers.push_back(body);
    require_name(carriers, reaction.on, "Output/" + reaction.name + "/On");
  }

  template ProbeSpec
  read_probe<2>(ParameterHandler &, const std::string &, const Constants &);
  template ProbeSpec
  read_probe<3>(ParameterHandler &, const std::string &, const Constants &);
  template void
  check_probe(const ProbeSpec &, const Faces<2> &, const Bodies<2> &);
  template void
  check_probe(const ProbeSpec &, const Faces<3> &, const Bodies<3> &);
  template ReactionSpec
  read_reaction<2>(ParameterHandler &, const std::string &);
  template ReactionSpec
  read_reaction<3>(ParameterHandler &, const std::string &);
  template void
  check_reaction(const ReactionSpec &, const Faces<2> &, const Bodies<2> &);
  template void
  check_reaction(const ReactionSpec &, const Faces<3> &, const Bodies<3> &);
} // namespace impm
