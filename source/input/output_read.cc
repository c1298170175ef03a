#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>
#include <impm/input/scene_sections.h>

#include <algorithm>

namespace impm
{
  using dealii::FunctionParser;
  using dealii::ParameterHandler;

  namespace
  {
    template <int dim>
    ProbeSpec
    read_probe(const ParameterHandler &prm,
               const std::string      &name,
               const Constants        &constants)
    {
      const std::vector<std::string> kinds = {
        "point", "largest", "smallest", "spread", "mean", "extent", "motion"};
      const std::string kind = prm.get("Kind");

      ProbeSpec probe;
      probe.name = name;
      probe.kind = static_cast<ProbeSpec::Kind>(
        std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
      if (kind == "point")
        probe.position = get_numbers(prm, "Position", dim);
      else if (kind == "motion")
        probe.of = prm.get("Of");
      else
        {
          probe.bodies = split_names(prm.get("Bodies"));
          const std::shared_ptr<FunctionParser<dim>> where =
            read_expressions<dim>(prm, "Where", 1, false, constants);
          if (where)
            probe.where = [where](const double *initial_position) {
              dealii::Point<dim> place;
              std::copy_n(initial_position, dim, place.begin_raw());
              return where->value(place);
            };
        }
      if (kind != "motion" && kind != "extent")
        probe.field = prm.get("Field");
      probe.component = prm.get_integer("Component");
      probe.factor    = prm.get_double("Factor");
      return probe;
    }
  } // namespace

  template <int dim>
  OutputSpec
  read_output(ParameterHandler &prm, const Constants &constants)
  {
    OutputSpec output;
    output.directory        = prm.get("Directory");
    output.pictures         = prm.get_bool("Pictures");
    output.picture_interval = 0;
    output.picture_steps    = 1;
    output.row_steps        = prm.get_integer("Steps between rows");
    if (output.pictures)
      {
        output.picture_interval = prm.get_double("Time between pictures");
        if (output.picture_interval == 0)
          output.picture_steps = prm.get_integer("Steps between pictures");
        output.point_fields = split_names(prm.get("Point fields"));
      }
    for (const auto &name : split_names(prm.get("Probes")))
      in_section(prm, name, [&]() {
        output.probes.push_back(read_probe<dim>(prm, name, constants));
      });
    for (const auto &name : split_names(prm.get("Reactions")))
      in_section(prm, name, [&]() {
        output.reactions.push_back({name,
                                    prm.get("On"),
                                    get_numbers(prm, "Direction", dim),
                                    prm.get_double("Factor")});
      });
    return output;
  }

  template OutputSpec
  read_output<2>(ParameterHandler &, const Constants &);
  template OutputSpec
  read_output<3>(ParameterHandler &, const Constants &);
} // namespace impm
