#include <deal.II/base/patterns.h>

#include <impm/input/scene_sections.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    void
    declare_probe(ParameterHandler            &prm,
                  const ParameterFile::Chosen &chosen,
                  const std::string           &name)
    {
      prm.enter_subsection(name);
      prm.declare_entry(
        "Kind",
        "point",
        Patterns::Selection("point|largest|smallest|spread|mean|extent|motion"),
        "point: at the point nearest to a place at the start, from which a "
        "displacement is carried on to the place by F. Largest, "
        "smallest, spread (their difference), mean: over bodies. Extent: largest coordinate, the points' "
        "domains included. Motion: of a moving face or a rigid body.");
      const auto kind = chosen("Output/" + name + "/Kind", "point");
      if (kind == "point")
        prm.declare_entry("Position",
                          "",
                          Patterns::Anything(),
                          "Place at the start (m).");
      else if (kind == "motion")
        prm.declare_entry("Of",
                          "",
                          Patterns::Anything(),
                          "A face of the domain or a rigid body.");
      if (kind != "motion" && kind != "point")
        prm.declare_entry("Bodies",
                          "",
                          Patterns::Anything(),
                          "Names of bodies; empty: all deformable ones.");
      if (kind != "motion" && kind != "point")
        prm.declare_entry("Where",
                          "",
                          Patterns::Anything(),
                          "Expression in x, y, z at the start: only points "
                          "that make it positive count; empty: all.");
      if (kind != "motion" && kind != "extent")
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
  } // namespace

  void
  declare_output(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Output");
    prm.declare_entry("Directory",
                      "",
                      Patterns::Anything(),
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
    if (dealii::Patterns::Double(0, 0).match(
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
    prm.declare_entry("Probes",
                      "",
                      Patterns::Anything(),
                      "Names of columns of the history, each with a "
                      "subsection.");
    prm.declare_entry("Reactions",
                      "",
                      Patterns::Anything(),
                      "Names of columns of the history, each with a "
                      "subsection.");
    for (const auto &name : split_names(chosen("Output/Probes", "")))
      declare_probe(prm, chosen, name);
    for (const auto &name : split_names(chosen("Output/Reactions", "")))
      {
        prm.enter_subsection(name);
        prm.declare_entry("On",
                          "",
                          Patterns::Anything(),
                          "A face of the domain or a rigid body.");
        prm.declare_entry("Direction",
                          "",
                          Patterns::Anything(),
                          "The force of the material on it is projected on "
                          "this vector.");
        prm.declare_entry("Factor",
                          "1",
                          Patterns::Double(),
                          "Multiplies the figure.");
        prm.leave_subsection();
      }
    prm.leave_subsection();
  }
} // namespace impm
