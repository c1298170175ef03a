#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/input/sections/output.h>
#include <impm/input/sections/reference.h>
#include <impm/points/point_fields.h>

#include <cmath>
#include <sstream>

namespace impm
{
  using dealii::Utilities::split_string_list;

  namespace
  {
    const Choice<Norm>
      norms("Norm", {{"L1", Norm::L1}, {"L2", Norm::L2}, {"max", Norm::max}});

    template <int dim>
    void
    add_field(const Section &section, ReferenceSpec<dim> &spec)
    {
      section.add("Field",
                  spec.field,
                  "A field of the points, as in the pictures.",
                  "displacement");
      if (is_plane_field(spec.field))
        check_field(section, "Field", spec.field, dim);
      const auto components =
        section.text("Components",
                     "",
                     Patterns::List(Patterns::Integer(0, 8)),
                     "Of the vector or, by rows, of the 3 x 3 tensor; empty: "
                     "all, of a vector those of the grid.");
      for (const auto &component : split_names(components))
        spec.components.push_back(dealii::Utilities::string_to_int(component));
      section.require("Expression", "are expressions between semicolons");
      const unsigned int n_components =
        spec.components.empty() ?
          split_string_list(section.get("Expression"), ';').size() :
          spec.components.size();
      section.add("Expression",
                  spec.expressions,
                  {n_components, in_time},
                  "What the components should be: expressions in t and the "
                  "initial x, y, z of a point, between semicolons.");
      section.add("Bodies",
                  spec.bodies,
                  "Names of bodies; empty: all deformable ones.");
      section.add("When",
                  spec.largest,
                  {{"end", false}, {"largest", true}},
                  "At the end of the run, or the largest in any row of the "
                  "history.");
    }

    template <int dim>
    void
    add_probe(const Section &section, ReferenceSpec<dim> &spec)
    {
      section.add("Of",
                  spec.columns.emplace_back(),
                  "A probe, a reaction, or any other column of the history.");
      section.add("Value",
                  spec.value,
                  {1, in_time},
                  "What it should be: an expression in t.");
      section.require("Value", "is an expression in t");
      section.add("Time",
                  spec.time,
                  "When (s), linear between steps; empty: at the end of the "
                  "run.");
    }

    Curve
    read_points(const std::string &text)
    {
      Curve curve;
      for (const auto &pair : split_string_list(text, ';'))
        {
          std::istringstream numbers(pair);
          double             x, y;
          if (!(numbers >> x >> y) || !(numbers >> std::ws).eof())
            throw InputError("Points",
                             "found '" + pair +
                               "', allowed are pairs of numbers 'x y' "
                               "between semicolons");
          curve.x.push_back(x);
          curve.y.push_back(y);
        }
      return curve;
    }

    Curve
    read_file(const std::string &file,
              const std::string &against,
              const std::string &column)
    {
      try
        {
          const auto table = read_csv_table(file);
          const bool named = table.has(against) && table.has(column);
          if (named || table.names.size() == 2)
            {
              Curve curve;
              curve.x = named ? table[against] : table.columns[0];
              curve.y = named ? table[column] : table.columns[1];
              for (unsigned int i = 0; i < curve.x.size(); ++i)
                if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i]))
                  throw InputError("",
                                   file + ", line " +
                                     std::to_string(table.lines[i]) +
                                     ": found a value that is not finite, "
                                     "allowed on a curve are numbers");
              return curve;
            }
        }
      catch (const InputError &error)
        {
          throw InputError("File", error.what());
        }
      throw InputError("File",
                       file + ": found no columns '" + against + "' and '" +
                         column + "', which are needed unless there are two");
    }

    template <int dim>
    void
    add_curve(const Section &section, ReferenceSpec<dim> &spec)
    {
      std::string text;
      section.add("Column", spec.columns.emplace_back(), "Of the history.");
      section.add("File",
                  text,
                  "CSV file of the curve with a header line: columns called "
                  "as 'Against' and 'Column', or just two; a path from the "
                  "file that sets it.");
      section.add("Points",
                  text,
                  "The curve in place of a file: 'x1 y1; x2 y2'.");
      section.add("Expression",
                  spec.value,
                  {1, in_time},
                  "The curve in place of a file: an expression in t, which "
                  "here stands for the abscissa.");
      std::vector<std::string> given;
      for (const std::string entry : {"File", "Points", "Expression"})
        if (!section.get(entry).empty())
          given.push_back(entry);
      if (given.size() != 1)
        section.fail(given.empty() ? "File" : given.back(),
                     std::string("found ") +
                       (given.empty() ? "none" : "more than one") +
                       " of File, Points, Expression, allowed is exactly one");
    }

    /** Unless it is an expression. */
    template <int dim>
    void
    read_curve(const dealii::ParameterHandler &prm, ReferenceSpec<dim> &spec)
    {
      const bool from_file = !prm.get("File").empty();
      const auto points =
        from_file ?
          read_file(prm.get("File"), spec.against, spec.columns.front()) :
          read_points(prm.get("Points"));
      const auto curve = make_curve(points.x, points.y);
      if (!curve || curve->x.size() < 2)
        throw InputError(from_file ? "File" : "Points",
                         std::string("found ") +
                           (!curve ? "an abscissa that rises and falls" :
                            curve->x.empty() ? "no points" :
                                               "one point") +
                           ", allowed is a curve of two points or more along "
                           "its abscissa");
      spec.curve = *curve;
    }

    template <int dim>
    void
    add_finer_run(const Section &section, ReferenceSpec<dim> &spec)
    {
      std::string overrides;
      section.add("Overrides",
                  overrides,
                  "What is different in the finer run: "
                  "'Section/Name=value | Section/Name=value'.");
      section.require("Overrides", "are 'Section/Name=value' between bars");
      spec.overrides = split_string_list(overrides, '|');
      section.add("Columns", spec.columns, "Of the history.");
      section.require("Columns", "are names of columns of the history");
      section.add("Directory",
                  spec.directory,
                  "Of the finer run, which is not made again if it is there; "
                  "empty: reference_<name> in that of this run.");
    }

    void
    add_scale(const Section &section, std::optional<double> &scale)
    {
      const auto text = section.text(
        "Scale",
        "1",
        Patterns::Anything(),
        "The error is divided by this number, or by the norm of the "
        "reference if this is 'reference'.");
      if (text == "reference" || !section.is_read)
        return;
      std::shared_ptr<dealii::FunctionParser<1>> function;
      section.inside([&](const auto &prm) {
        function =
          read_expressions<1>(prm, "Scale", 1, true, section.constants);
      });
      const auto at = [&](const double t) {
        return function ? function->value(dealii::Point<1>(t)) : 0.;
      };
      if (!(at(0) > 0) || at(0) != at(1))
        section.refuse("Scale",
                       "allowed is 'reference' or a number greater than 0, "
                       "also as an expression of constants");
      scale = at(0);
    }

    template <int dim>
    void
    add_reference(const Section &section, ReferenceSpec<dim> &spec)
    {
      spec.name = section.name;
      section.add("Kind",
                  spec.kind,
                  {{"field", ReferenceKind::field},
                   {"probe", ReferenceKind::probe},
                   {"curve", ReferenceKind::curve},
                   {"finer run", ReferenceKind::finer_run}},
                  "A field at the points, a figure of the history at one time, "
                  "a column of the history, or columns of a finer run of the "
                  "same scene.");
      if (spec.kind == ReferenceKind::field)
        add_field(section, spec);
      else if (spec.kind == ReferenceKind::probe)
        add_probe(section, spec);
      else if (spec.kind == ReferenceKind::curve)
        add_curve(section, spec);
      else
        add_finer_run(section, spec);
      if (spec.kind == ReferenceKind::curve ||
          spec.kind == ReferenceKind::finer_run)
        section.add("Against",
                    spec.against,
                    "The column of the history that is the abscissa.",
                    "time");
      if (section.is_read && spec.kind == ReferenceKind::curve && !spec.value)
        section.inside([&](auto &prm) { read_curve(prm, spec); });
      if (spec.kind != ReferenceKind::probe)
        section.add(norms,
                    spec.norm,
                    "Of the error: mean, root mean square, largest; weighted "
                    "by initial volume or along the abscissa.");
      add_scale(section, spec.scale);
    }
  } // namespace

  const std::string &
  name_of(const Norm norm)
  {
    return norms.name_of(norm);
  }

  template <int dim>
  void
  add_references(const Section                   &top,
                 std::vector<ReferenceSpec<dim>> &references)
  {
    const auto section = top.subsection("Reference");
    for (const auto &name :
         section.names("Names",
                       "Names of what the scene should give, each with a "
                       "subsection; the errors stand in summary.json."))
      add_reference(section.subsection(name), references.emplace_back());
  }

  template void
  add_references(const Section &, std::vector<ReferenceSpec<2>> &);
  template void
  add_references(const Section &, std::vector<ReferenceSpec<3>> &);
} // namespace impm
