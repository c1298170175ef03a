#include <deal.II/base/patterns.h>

#include <impm/study/reference_spec.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    void
    declare_field(ParameterHandler &prm)
    {
      prm.declare_entry("Field",
                        "displacement",
                        Patterns::Anything(),
                        "A field of the points, as in the pictures.");
      prm.declare_entry("Components",
                        "",
                        Patterns::List(Patterns::Integer(0, 8)),
                        "Of the vector or, by rows, of the 3 x 3 tensor; "
                        "empty: all, of a vector those of the grid.");
      prm.declare_entry("Expression",
                        "",
                        Patterns::Anything(),
                        "What the components should be: expressions in t and "
                        "the initial x, y, z of a point, between semicolons.");
      prm.declare_entry("Bodies",
                        "",
                        Patterns::Anything(),
                        "Names of bodies; empty: all deformable ones.");
      prm.declare_entry("When",
                        "end",
                        Patterns::Selection("end|largest"),
                        "At the end of the run, or the largest in any row of "
                        "the history.");
    }

    void
    declare_probe(ParameterHandler &prm)
    {
      prm.declare_entry("Of",
                        "",
                        Patterns::Anything(),
                        "A probe, a reaction, or any other column of the "
                        "history.");
      prm.declare_entry("Value",
                        "",
                        Patterns::Anything(),
                        "What it should be: an expression in t.");
      prm.declare_entry("Time",
                        "",
                        Patterns::Anything(),
                        "When (s), linear between steps; empty: at the end "
                        "of the run.");
    }

    void
    declare_curve(ParameterHandler &prm)
    {
      prm.declare_entry("Column", "", Patterns::Anything(), "Of the history.");
      prm.declare_entry("File",
                        "",
                        Patterns::Anything(),
                        "CSV file of the curve with a header line: columns "
                        "called as 'Against' and 'Column', or just two.");
      prm.declare_entry("Points",
                        "",
                        Patterns::Anything(),
                        "The curve in place of a file: 'x1 y1; x2 y2'.");
      prm.declare_entry("Expression",
                        "",
                        Patterns::Anything(),
                        "The curve in place of a file: an expression in t, "
                        "which here stands for the abscissa.");
    }

    void
    declare_finer_run(ParameterHandler &prm)
    {
      prm.declare_entry("Overrides",
                        "",
                        Patterns::Anything(),
                        "What is different in the finer run: "
                        "'Section/Name=value | Section/Name=value'.");
      prm.declare_entry("Columns", "", Patterns::Anything(), "Of the history.");
      prm.declare_entry("Directory",
                        "",
                        Patterns::Anything(),
                        "Of the finer run, which is not made again if it is "
                        "there; empty: reference_<name> in that of this run.");
    }
  } // namespace

  void
  declare_references(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Reference");
    prm.declare_entry("Names",
                      "",
                      Patterns::Anything(),
                      "Names of what the scene should give, each with a "
                      "subsection; the errors stand in summary.json.");
    for (const auto &name : split_names(chosen("Reference/Names", "")))
      {
        prm.enter_subsection(name);
        prm.declare_entry("Kind",
                          "field",
                          Patterns::Selection("field|probe|curve|finer run"),
                          "A field at the points, a figure of the history at "
                          "one time, a column of the history, or columns of a "
                          "finer run of the same scene.");
        const auto kind = chosen("Reference/" + name + "/Kind", "field");
        if (kind == "field")
          declare_field(prm);
        else if (kind == "probe")
          declare_probe(prm);
        else if (kind == "curve")
          declare_curve(prm);
        else
          declare_finer_run(prm);
        if (kind == "curve" || kind == "finer run")
          prm.declare_entry("Against",
                            "time",
                            Patterns::Anything(),
                            "The column of the history that is the abscissa.");
        if (kind != "probe")
          prm.declare_entry("Norm",
                            "L1",
                            Patterns::Selection("L1|L2|max"),
                            "Of the error: mean, root mean square, largest; "
                            "weighted by initial volume or along the "
                            "abscissa.");
        prm.declare_entry("Scale",
                          "1",
                          Patterns::Anything(),
                          "The error is divided by this number, or by the "
                          "norm of the reference if this is 'reference'.");
        prm.leave_subsection();
      }
    prm.leave_subsection();
  }
} // namespace impm
