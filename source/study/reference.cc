#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/study/reference.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    void
    check_columns(const ReferenceSpec<dim>       &spec,
                  const std::vector<std::string> &allowed,
                  const double                    end_time)
    {
      const std::string section = "Reference/" + spec.name + "/";
      const auto        check   = [&](const std::string &entry,
                             const std::string &column) {
        if (std::count(allowed.begin(), allowed.end(), column) == 0)
          throw InputError(section + entry,
                           "found '" + column +
                             "', allowed are the columns of the history: " +
                             join(allowed, ", "));
      };
      for (const auto &column : spec.columns)
        check(spec.kind == ReferenceKind::probe ? "Of" :
              spec.kind == ReferenceKind::curve ? "Column" :
                                                  "Columns",
              column);
      check("Against", spec.against);
      if (spec.time && !(*spec.time > 0 && *spec.time <= end_time))
        throw InputError(
          section + "Time",
          "found " + std::to_string(*spec.time) +
            ", allowed is more than 0 and at most the end time " +
            std::to_string(end_time));
    }

    /**
     * How a field compares at a time: collective. Throws InputError for what
     * this scene does not have.
     */
    template <int dim>
    std::function<Comparison(double time)>
    make_field_comparison(const ReferenceSpec<dim>  &spec,
                          const Scene<dim>          &scene,
                          const MaterialPoints<dim> &points)
    {
      const std::string section = "Reference/" + spec.name + "/";
      const auto        field =
        make_point_field(spec.field, points, scene.output.fringe_number);
      if (!field)
        {
          std::vector<std::string> allowed;
          for (const auto &name : point_field_names())
            if (make_point_field(name, points))
              allowed.push_back(name);
          throw InputError(section + "Field",
                           "found '" + spec.field +
                             "', allowed in this scene are: " +
                             join(allowed, ", "));
        }
      const unsigned int n          = field->n_components;
      auto               components = spec.components;
      if (spec.components.empty())
        for (unsigned int c = 0; c < (n == 3 ? dim : n); ++c)
          components.push_back(c);
      for (const auto component : components)
        if (component >= n)
          throw InputError(section + "Components",
                           "found " + std::to_string(component) +
                             ", allowed is less than " + std::to_string(n));
      if (spec.expressions->n_components != components.size())
        throw InputError(section + "Expression",
                         "found " +
                           std::to_string(spec.expressions->n_components) +
                           " expressions, allowed are " +
                           std::to_string(components.size()) +
                           " between semicolons, one for each component");

      std::vector<bool> takes_body;
      for (const auto &body : scene.bodies)
        takes_body.push_back(
          spec.bodies.empty() ||
          std::count(spec.bodies.begin(), spec.bodies.end(), body.name) > 0);
      for (const auto &body : spec.bodies)
        require_name(names_of_bodies(scene.bodies, false),
                     body,
                     section + "Bodies");

      return [&spec, &points, field, components, takes_body](
               const double time) -> Comparison {
        WeightedNorm values{spec.norm}, references{spec.norm},
          errors{spec.norm};
        dealii::Vector<double> expected(components.size());
        spec.expressions->set_time(time);
        field->prepare();
        unsigned int p = 0;
        for (const auto &particle : points.sorted.particles)
          {
            const unsigned int point = p++;
            if (!takes_body[static_cast<unsigned int>(points.fields(point)[0])])
              continue;
            double computed[9] = {};
            field->evaluate(point, particle.get_location(), computed);
            spec.expressions->vector_value(points.initial_position(point),
                                           expected);
            double value = 0, reference = 0, error = 0;
            for (unsigned int i = 0; i < components.size(); ++i)
              {
                const double c = computed[components[i]];
                value += c * c;
                reference += expected[i] * expected[i];
                error += (c - expected[i]) * (c - expected[i]);
              }
            const double volume = points.initial_volume(point);
            values.add(volume, std::sqrt(value));
            references.add(volume, std::sqrt(reference));
            errors.add(volume, std::sqrt(error));
          }
        const auto   comm      = points.communicator;
        const double reference = references.value(comm);
        return {values.value(comm), reference, errors.value(comm), reference};
      };
    }

    /** Divides the error by its scale, and says what is wrong with it. */
    template <int dim>
    ReferenceError
    make_record(const ReferenceSpec<dim> &spec,
                const std::string        &kind,
                const Comparison         &comparison,
                const std::string        &flaw = "")
    {
      ReferenceError record{spec.name,
                            kind,
                            name_of(spec.norm),
                            comparison.value,
                            comparison.reference,
                            comparison.error /
                              spec.scale.value_or(comparison.reference_norm),
                            flaw,
                            {}};
      if (flaw.empty() && !std::isfinite(record.error))
        record.flaw = !std::isfinite(record.value) ?
                        "the computed value is not finite" :
                      !std::isfinite(record.reference) ?
                        "the reference is not finite" :
                      comparison.reference_norm == 0 ?
                        "the reference, which is the scale, is zero" :
                        "value or reference is somewhere not finite";
      return record;
    }

    template <int dim>
    ReferenceError
    compare_column(const ReferenceSpec<dim> &spec,
                   const std::string        &column,
                   const CsvTable           &rows,
                   const FinerRuns          &finer_runs)
    {
      const bool is_probe = spec.kind == ReferenceKind::probe;
      const bool is_finer = spec.kind == ReferenceKind::finer_run;
      const auto finer    = finer_runs.find(spec.name);
      const auto computed = make_curve(rows[spec.against], rows[column]);
      std::optional<Curve> expected = spec.curve;
      if (finer != finer_runs.end())
        expected = make_curve(finer->second.history[spec.against],
                              finer->second.history[column]);

      Comparison  comparison;
      std::string flaw;
      if (is_finer && finer == finer_runs.end())
        flaw = "there is no finer run";
      else if (!computed || !expected)
        flaw = "'" + spec.against + "' rises and falls";
      else
        {
          const auto reference = [&](const double x) {
            return spec.value ? spec.value->value(Point<1>(x)) :
                                expected->value(x);
          };
          // A curve is known at its abscissas alone; the rows of this run are
          // its own best, and the finer run is the smoother to interpolate.
          auto at = is_finer || spec.value ? computed->x : expected->x;
          if (is_probe)
            at = {spec.time.value_or(at.back())};
          const auto is_missing = [&](const double x) {
            return !computed->contains(x) ||
                   (!spec.value && !expected->contains(x));
          };
          if (is_probe && is_missing(at[0]))
            flaw = "the history does not reach t = " + std::to_string(at[0]);
          else
            at.erase(std::remove_if(at.begin(), at.end(), is_missing),
                     at.end());
          if (at.empty())
            flaw = "run and reference have no '" + spec.against + "' in common";
          else
            comparison = compare_curves(*computed, reference, at, spec.norm);
        }
      auto record = make_record(spec,
                                is_probe ? "probe" :
                                is_finer ? "finer run" :
                                           "curve",
                                comparison,
                                flaw);
      if (is_finer)
        record.name += "_" + column;
      if (finer != finer_runs.end())
        record.reference_wall_seconds = finer->second.wall_seconds;
      return record;
    }
  } // namespace

  template <int dim>
  Reference<dim>::Reference(const Scene<dim>          &scene,
                            const MaterialPoints<dim> &points,
                            const History<dim>        &history)
    : references(scene.references)
    , points(points)
    , history(history)
    , compare_field(references.size())
    , largest(references.size(), {0, 0, 0, 0})
  {
    for (unsigned int i = 0; i < references.size(); ++i)
      if (references[i].kind == ReferenceKind::field)
        compare_field[i] = make_field_comparison(references[i], scene, points);
      else
        check_columns(references[i],
                      History<dim>::column_names(scene),
                      scene.time.end);
  }

  template <int dim>
  bool
  Reference<dim>::follows_steps() const
  {
    return std::any_of(references.begin(),
                       references.end(),
                       [](const auto &spec) { return spec.largest; });
  }

  template <int dim>
  void
  Reference<dim>::follow_step(const double time)
  {
    for (unsigned int i = 0; i < references.size(); ++i)
      if (references[i].largest)
        {
          const auto now = compare_field[i](time);
          for (const auto norm : {&Comparison::value,
                                  &Comparison::reference,
                                  &Comparison::error,
                                  &Comparison::reference_norm})
            // What is not a number once stays so.
            if (!(now.*norm <= largest[i].*norm) &&
                !std::isnan(largest[i].*norm))
              largest[i].*norm = now.*norm;
        }
  }

  template <int dim>
  std::vector<ReferenceError>
  Reference<dim>::errors(const double time, const FinerRuns &finer_runs) const
  {
    const bool first =
      Utilities::MPI::this_mpi_process(points.communicator) == 0;
    std::vector<ReferenceError> records;
    std::optional<CsvTable>     rows;
    for (unsigned int i = 0; i < references.size(); ++i)
      {
        const auto &spec = references[i];
        if (spec.kind == ReferenceKind::field)
          records.push_back(make_record(
            spec, "field", spec.largest ? largest[i] : compare_field[i](time)));
        else if (first)
          {
            if (!rows)
              rows = history.table();
            for (const auto &column : spec.columns)
              records.push_back(
                compare_column(spec, column, *rows, finer_runs));
          }
      }
    return records;
  }

  template class Reference<2>;
  template class Reference<3>;
} // namespace impm
