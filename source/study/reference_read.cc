#include <deal.II/base/utilities.h>

#include <impm/base/csv.h>
#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>
#include <impm/study/reference_spec.h>

#include <filesystem>
#include <set>
#include <sstream>

namespace impm
{
  using dealii::ParameterHandler;

  namespace
  {
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
    read_curve(ParameterHandler                    &prm,
               const std::map<std::string, double> &constants,
               const std::string                   &parameter_file,
               ReferenceSpec<dim>                  &spec)
    {
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

    std::optional<double>
    read_scale(const ParameterHandler              &prm,
               const std::map<std::string, double> &constants)
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

    template <int dim>
    ReferenceSpec<dim>
    read_reference(ParameterHandler                    &prm,
                   const std::string                   &name,
                   const std::map<std::string, double> &constants,
                   const std::string                   &parameter_file)
    {
      using Kind = typename ReferenceSpec<dim>::Kind;
      const std::map<std::string, Kind> kinds = {{"field", Kind::field},
                                                 {"probe", Kind::probe},
                                                 {"curve", Kind::curve},
                                                 {"finer run",
                                                  Kind::finer_run}};
      ReferenceSpec<dim>                spec;
      spec.name  = name;
      spec.kind  = kinds.at(prm.get("Kind"));
      spec.scale = read_scale(prm, constants);
      if (spec.kind != Kind::probe)
        spec.norm = prm.get("Norm") == "L1" ? Norm::L1 :
                    prm.get("Norm") == "L2" ? Norm::L2 :
                                              Norm::max;
      spec.against = "time";
      if (spec.kind == Kind::curve || spec.kind == Kind::finer_run)
        spec.against = prm.get("Against");

      const auto require = [&](const std::string &entry,
                               const std::string &allowed) {
        if (prm.get(entry).empty())
          throw InputError(entry, "found '', allowed " + allowed);
      };
      if (spec.kind == Kind::field)
        {
          require("Expression", "are expressions between semicolons");
          spec.field = prm.get("Field");
          for (const auto &component : split_names(prm.get("Components")))
            spec.components.push_back(
              dealii::Utilities::string_to_int(component));
          const unsigned int n_expressions =
            dealii::Utilities::split_string_list(prm.get("Expression"), ';')
              .size();
          spec.expressions = read_expressions<dim>(prm,
                                                   "Expression",
                                                   spec.components.empty() ?
                                                     n_expressions :
                                                     spec.components.size(),
                                                   true,
                                                   constants);
          spec.bodies      = split_names(prm.get("Bodies"));
          spec.largest     = prm.get("When") == "largest";
        }
      else if (spec.kind == Kind::probe)
        {
          require("Value", "is an expression in t");
          spec.columns = {prm.get("Of")};
          spec.value   = read_expressions<1>(prm, "Value", 1, true, constants);
          if (!prm.get("Time").empty())
            spec.time = get_numbers(prm, "Time", 1)[0];
        }
      else if (spec.kind == Kind::curve)
        {
          spec.columns = {prm.get("Column")};
          read_curve(prm, constants, parameter_file, spec);
        }
      else
        {
          require("Overrides", "are 'Section/Name=value' between bars");
          require("Columns", "are names of columns of the history");
          for (const auto &override :
               dealii::Utilities::split_string_list(prm.get("Overrides"), '|'))
            spec.overrides.push_back(override);
          spec.columns   = split_names(prm.get("Columns"));
          spec.directory = prm.get("Directory");
        }
      return spec;
    }
  } // namespace

  template <int dim>
  std::vector<ReferenceSpec<dim>>
  read_references(ParameterHandler                    &prm,
                  const std::map<std::string, double> &constants,
                  const std::string                   &parameter_file)
  {
    std::vector<ReferenceSpec<dim>> references;
    std::set<std::string>           taken;
    for (const auto &name : split_names(prm.get("Names")))
      {
        if (!taken.insert(name).second)
          throw InputError("Names", "found '" + name + "' twice");
        in_section(prm, name, [&]() {
          references.push_back(
            read_reference<dim>(prm, name, constants, parameter_file));
        });
      }
    return references;
  }

  template std::vector<ReferenceSpec<2>>
  read_references(ParameterHandler &,
                  const std::map<std::string, double> &,
                  const std::string &);
  template std::vector<ReferenceSpec<3>>
  read_references(ParameterHandler &,
                  const std::map<std::string, double> &,
                  const std::string &);
} // namespace impm
