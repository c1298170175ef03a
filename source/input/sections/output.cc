#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/input/sections/output.h>
#include <impm/points/point_fields.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    /** Whether a picture, a probe or a reference has photoelastic fringes. */
    bool
    shows_fringes(const ParameterFile::Chosen &chosen)
    {
      auto fields = split_names(chosen("Output/Point fields", ""));
      for (const std::string list : {"Output/Probes", "Reference/Names"})
        for (const auto &name : split_names(chosen(list, "")))
          fields.push_back(
            chosen(list.substr(0, list.find('/') + 1) + name + "/Field", ""));
      return std::count(fields.begin(), fields.end(), "photoelastic_fringe") >
             0;
    }

    template <int dim>
    void
    check_field(const std::string &field, const std::string &entry)
    {
      const auto &known = point_field_names();
      if (std::count(known.begin(), known.end(), field) == 0)
        throw InputError(entry,
                         "found '" + field +
                           "', allowed are: " + join(known, ", "));
      require_dimension<dim>(field, entry);
    }
  } // namespace

  void
  declare_output(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Output");
    declare_text(prm,
                 "Directory",
                 "Where results go; empty: output/<name of the file>.");
    prm.declare_entry("Pictures",
                      "true",
                      Patterns::Bool(),
                      "Whether VTU files of points and grid are written.");
    // Also where pictures are off, so that a study can switch them off.
    prm.declare_entry("Time between pictures",
                      "0",
                      Patterns::Double(0),
                      "(s); 0: by the number of steps.");
    if (Patterns::Double(0, 0).match(
          chosen("Output/Time between pictures", "0")))
      prm.declare_entry("Steps between pictures",
                        "10",
                        Patterns::Integer(1),
                        "Number of steps.");
    prm.declare_entry("Steps between rows",
                      "1",
                      Patterns::Integer(1),
                      "Number of steps from a row of the history, with a "
                      "line on the screen, to the next; the last step of a "
                      "run has one in any case. Newton and linear "
                      "iterations, line searches, step cuts, tangent "
                      "projections, solver fallbacks and noise stops are "
                      "sums over the steps since the row before.");
    prm.declare_entry("Point fields",
                      "velocity, cauchy_stress, von_mises_stress, "
                      "equivalent_plastic_strain, deformation_gradient, "
                      "volume, body",
                      Patterns::Anything(),
                      "Fields of the points; those that this scene does "
                      "not have are left out.");
    if (shows_fringes(chosen))
      prm.declare_entry("Fringe number",
                        "7",
                        Patterns::Double(std::numeric_limits<double>::min()),
                        "Of the field photoelastic_fringe: how many fringes "
                        "there are from no stress to the largest difference "
                        "of principal stresses.");
    declare_text(prm,
                 "Probes",
                 "Names of columns of the history, each with a "
                 "subsection.");
    declare_text(prm,
                 "Reactions",
                 "Names of columns of the history, each with a "
                 "subsection.");
    for (const auto &name : split_names(chosen("Output/Probes", "")))
      declare_probe(prm, chosen, name);
    for (const auto &name : split_names(chosen("Output/Reactions", "")))
      declare_reaction(prm, name);
    prm.leave_subsection();
  }

  template <int dim>
  OutputSpec
  read_output(ParameterHandler &prm, const Constants &constants)
  {
    OutputSpec output;
    const bool fringes = shows_fringes(chosen_in(prm));
    in_section(prm, "Output", [&]() {
      output.directory = prm.get("Directory");
      output.pictures  = prm.get_bool("Pictures");
      if (output.pictures)
        {
          output.picture_interval = prm.get_double("Time between pictures");
          if (output.picture_interval == 0)
            output.picture_steps = prm.get_integer("Steps between pictures");
          output.point_fields = split_names(prm.get("Point fields"));
        }
      output.row_steps = prm.get_integer("Steps between rows");
      if (fringes)
        output.fringe_number = prm.get_double("Fringe number");
      for (const auto &name : split_names(prm.get("Probes")))
        output.probes.push_back(read_probe<dim>(prm, name, constants));
      for (const auto &name : split_names(prm.get("Reactions")))
        output.reactions.push_back(read_reaction<dim>(prm, name));
    });
    return output;
  }

  template <int dim>
  void
  check_output(const OutputSpec  &output,
               const Faces<dim>  &faces,
               const Bodies<dim> &bodies)
  {
    for (const auto &reaction : output.reactions)
      check_reaction(reaction, faces, bodies);
    for (const auto &field : output.point_fields)
      check_field<dim>(field, "Output/Point fields");
    for (const auto &probe : output.probes)
      {
        if (!probe.field.empty())
          check_field<dim>(probe.field, "Output/" + probe.name + "/Field");
        check_probe(probe, faces, bodies);
      }
  }

  template <int dim>
  void
  require_dimension(const std::string &field, const std::string &entry)
  {
    if (dim == 3 && is_plane_field(field))
      throw InputError(entry,
                       "found '" + field +
                         "', a field of the plane, which 3D does not have");
  }

  template OutputSpec
  read_output<2>(ParameterHandler &, const Constants &);
  template OutputSpec
  read_output<3>(ParameterHandler &, const Constants &);
  template void
  check_output(const OutputSpec &, const Faces<2> &, const Bodies<2> &);
  template void
  check_output(const OutputSpec &, const Faces<3> &, const Bodies<3> &);
  template void
  require_dimension<2>(const std::string &, const std::string &);
  template void
  require_dimension<3>(const std::string &, const std::string &);
} // namespace impm
