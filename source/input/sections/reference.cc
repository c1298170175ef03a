#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/output.h>
#include <impm/input/sections/reference.h>

#include <filesystem>
#include <set>
#include <sstream>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    const Choice<ReferenceKind>
      kinds("Kind",
            {{"field", ReferenceKind::field},
             {"probe", ReferenceKind::probe},
             {"curve", ReferenceKind::curve},
             {"finer run", ReferenceKind::finer_run}});

    const Choice<Norm>
      norms("Norm", {{"L1", Norm::L1}, {"L2", Norm::L2}, {"max", Norm::max}});

    const Choice<bool> takes_largest("When",
                                     {{"end", false}, {"largest", true}});

    void
    require(const ParameterHandler &prm,
            const std::string      &entry,
            const std::string      &allowed)
    {
      if (prm.get(entry).empty())
        throw InputError(entry, "found '', allowed " + allowed);
    }

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
      declare_text(prm,
                   "Expression",
                   "What the components should be: expressions in t and "
                   "the initial x, y, z of a point, between semicolons.");
      declare_text(prm,
                   "Bodies",
                   "Names of bodies; empty: all deformable ones.");
      takes_largest.declare(
        prm,
        "At the end of the run, or the largest in any row of "
        "the history.");
    }

    template <int dim>
    void
    read_field(const ParameterHandler &prm,
               const Constants        &constants,
               ReferenceSpec<dim>     &spec)
    {
      require(prm, "Expression", "are expressions between semicolons");
      spec.field = prm.get("Field");
      for (const auto &component : split_names(prm.get("Components")))
        spec.components.push_back(dealii::Utilities::string_to_int(component));
      const unsigned int n_expressions =
        dealii::Utilities::split_string_list(prm.get("Expression"), ';').size();
      spec.expressions =
        read_expressions<dim>(prm,
                              "Expression",
                              spec.components.empty() ? n_expressions :
                                                        spec.components.size(),
                              true,
                              constants);
      spec.bodies  = split_names(prm.get("Bodies"));
      spec.largest = takes_largest.read(prm);
    }

    void
    declare_probe(ParameterHandler &prm)
    {
      declare_text(prm,
                   "Of",
                   "A probe, a reaction, or any other column of the "
                   "history.");
      declare_text(prm, "Value", "What it should be: an expression in t.");
      declare_text(prm,
                   "Time",
                   "When (s), linear between steps; empty: at the end "
                   "of the run.");
    }

    template <int dim>
    void
    read_probe(const ParameterHandler &prm,
               const Constants        &constants,
               ReferenceSpec<dim>     &spec)
    {
      require(prm, "Value", "is an expression in t");
      spec.columns = {prm.get("Of")};
      spec.value   = read_expressions<1>(prm, "Value", 1, true, constants);
      if (!prm.get("Time").empty())
        spec.time = get_numbers(prm, "Time", 1)[0];
    }

    void
    declare_curve(ParameterHandler &prm)
    {
      declare_text(prm, "Column", "Of the history.");
      declare_text(prm,
                   "File",
                   "CSV file of the curve with a header line: columns "
                   "called as 'Against' and 'Column', or just two.");
      declare_text(prm,
                   "Points",
                   "The curve in place of a file: 'x1 y1; x2 y2'.");
      declare_text(prm,
                   "Expression",
                   "The curve in place of a file: an expression in t, "
                   "which here stands for the abscissa.");
    }

    std::string
    existing_file(const std::string &file, const std::string &parameter_file)
    {
      const auto beside =
        std::filesystem::path(parameter_file).parent_path() / file;
      return std::filesystem::exists(beside) ? beside.string() : file;
    }

    Curve
    read_points(const std::string &text)
    {
      Curve curve;
      for (const auto &pair : dealii::Utilities::split_string_list(text, ';'))
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
          if (table.has(against) && table.has(column))
            return {table[against], table[column]};
          if (table.names.size() == 2)
            return {table.columns[0], table.columns[1]};
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
    read_curve(ParameterHandler   &prm,
               const Constants    &constants,
               const std::string  &parameter_file,
               ReferenceSpec<dim> &spec)
    {
      spec.columns = {prm.get("Column")};
      std::vector<std::string> given;
      for (const std::string entry : {"File", "Points", "Expression"})
        if (!prm.get(entry).empty())
          given.push_back(entry);
      if (given.size() != 1)
        throw InputError(given.empty() ? "File" : given.back(),
                         std::string("found ") +
                           (given.empty() ? "none" : "more than one") +
                           " of File, Points, Expression, allowed is exactly "
                           "one");
      if (given[0] == "Expression")
        {
          spec.value =
            read_expressions<1>(prm, "Expression", 1, true, constants);
          return;
        }
      if (given[0] == "File")
        {
          // So that the resolved parameters find it from here, too.
          prm.set("File", existing_file(prm.get("File"), parameter_file));
          spec.curve =
            read_file(prm.get("File"), spec.against, spec.columns.front());
        }
      else
        spec.curve = read_points(prm.get("Points"));
      const auto curve = make_curve(spec.curve.x, spec.curve.y);
      if (!curve || curve->x.empty())
        throw InputError(given[0],
                         "found " +
                           std::string(curve ? "no points" :
                                               "an abscissa that rises and "
                                               "falls") +
                           ", allowed is a curve along its abscissa");
      spec.curve = *curve;
    }

    void
    declare_finer_run(ParameterHandler &prm)
    {
      declare_text(prm,
                   "Overrides",
                   "What is different in the finer run: "
                   "'Section/Name=value | Section/Name=value'.");
      declare_text(prm, "Columns", "Of the history.");
      declare_text(prm,
                   "Directory",
                   "Of the finer run, which is not made again if it is "
                   "there; empty: reference_<name> in that of this run.");
    }

    template <int dim>
    void
    read_finer_run(const ParameterHandler &prm, ReferenceSpec<dim> &spec)
    {
      require(prm, "Overrides", "are 'Section/Name=value' between bars");
      require(prm, "Columns", "are names of columns of the history");
      for (const auto &override :
           dealii::Utilities::split_string_list(prm.get("Overrides"), '|'))
        spec.overrides.push_back(override);
      spec.columns   = split_names(prm.get("Columns"));
      spec.directory = prm.get("Directory");
    }

    std::optional<double>
    read_scale(const ParameterHandler &prm, const Constants &constants)
    {
      if (prm.get("Scale") == "reference")
        return std::nullopt;
      const auto scale = read_expressions<1>(prm, "Scale", 1, true, constants);
      const auto at    = [&](const double t) {
        return scale ? scale->value(dealii::Point<1>(t)) : 0.;
      };
      if (!(at(0) > 0) || at(0) != at(1))
        throw InputError("Scale",
                         "found '" + prm.get("Scale") +
                           "', allowed is 'reference' or a number greater "
                           "than 0, also as an expression of constants");
      return at(0);
    }

    void
    declare_reference(ParameterHandler            &prm,
                      const ParameterFile::Chosen &chosen,
                      const std::string           &section)
    {
      kinds.declare(prm,
                    "A field at the points, a figure of the history at "
                    "one time, a column of the history, or columns of a "
                    "finer run of the same scene.");
      const auto is = [&](const ReferenceKind kind) {
        return kinds.is(chosen, section, kind);
      };
      if (is(ReferenceKind::field))
        declare_field(prm);
      else if (is(ReferenceKind::probe))
        declare_probe(prm);
      else if (is(ReferenceKind::curve))
        declare_curve(prm);
      else
        declare_finer_run(prm);
      if (is(ReferenceKind::curve) || is(ReferenceKind::finer_run))
        prm.declare_entry("Against",
                          "time",
                          Patterns::Anything(),
                          "The column of the history that is the abscissa.");
      if (!is(ReferenceKind::probe))
        norms.declare(prm,
                      "Of the error: mean, root mean square, largest; "
                      "weighted by initial volume or along the "
                      "abscissa.");
      prm.declare_entry("Scale",
                        "1",
                        Patterns::Anything(),
                        "The error is divided by this number, or by the "
                        "norm of the reference if this is 'reference'.");
    }

    template <int dim>
    ReferenceSpec<dim>
    read_reference(ParameterHandler  &prm,
                   const std::string &name,
                   const Constants   &constants,
                   const std::string &parameter_file)
    {
      ReferenceSpec<dim> spec;
      spec.name  = name;
      spec.kind  = kinds.read(prm);
      spec.scale = read_scale(prm, constants);
      if (spec.kind != ReferenceKind::probe)
        spec.norm = norms.read(prm);
      spec.against = "time";
      if (spec.kind == ReferenceKind::curve ||
          spec.kind == ReferenceKind::finer_run)
        spec.against = prm.get("Against");
      if (spec.kind == ReferenceKind::field)
        read_field(prm, constants, spec);
      else if (spec.kind == ReferenceKind::probe)
        read_probe(prm, constants, spec);
      else if (spec.kind == ReferenceKind::curve)
        read_curve(prm, constants, parameter_file, spec);
      else
        read_finer_run(prm, spec);
      return spec;
    }
  } // namespace

  const std::string &
  name_of(const Norm norm)
  {
    return norms.name_of(norm);
  }

  void
  declare_references(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Reference");
    declare_text(prm,
                 "Names",
                 "Names of what the scene should give, each with a "
                 "subsection; the errors stand in summary.json.");
    for (const auto &name : split_names(chosen("Reference/Names", "")))
      in_section(prm, name, [&]() {
        declare_reference(prm, chosen, "Reference/" + name);
      });
    prm.leave_subsection();
  }

  template <int dim>
  std::vector<ReferenceSpec<dim>>
  read_references(ParameterHandler  &prm,
                  const Constants   &constants,
                  const std::string &parameter_file)
  {
    std::vector<ReferenceSpec<dim>> references;
    in_section(prm, "Reference", [&]() {
      std::set<std::string> taken;
      for (const auto &name : split_names(prm.get("Names")))
        {
          if (!taken.insert(name).second)
            throw InputError("Names", "found '" + name + "' twice");
          in_section(prm, name, [&]() {
            references.push_back(
              read_reference<dim>(prm, name, constants, parameter_file));
          });
        }
    });
    return references;
  }

  template <int dim>
  void
  check_references(const std::vector<ReferenceSpec<dim>> &references)
  {
    for (const auto &reference : references)
      require_dimension<dim>(reference.field,
                             "Reference/" + reference.name + "/Field");
  }

  template std::vector<ReferenceSpec<2>>
  read_references(ParameterHandler &, const Constants &, const std::string &);
  template std::vector<ReferenceSpec<3>>
  read_references(ParameterHandler &, const Constants &, const std::string &);
  template void
  check_references(const std::vector<ReferenceSpec<2>> &);
  template void
  check_references(const std::vector<ReferenceSpec<3>> &);
} // namespace impm
