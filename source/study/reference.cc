#include <impm/study/reference.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();

    /** Divides the error, and says what is wrong with it. */
    void
    finish(ReferenceError              &record,
           const std::optional<double> &scale,
           const double                 reference_norm)
    {
      record.error /= scale ? *scale : reference_norm;
      if (std::isfinite(record.error) || !record.flaw.empty())
        return;
      record.flaw =
        !std::isfinite(record.value)     ? "the computed value is not finite" :
        !std::isfinite(record.reference) ? "the reference is not finite" :
        reference_norm == 0 ? "the reference, which is the scale, is zero" :
                              "value or reference is somewhere not finite";
    }
  } // namespace

  template <int dim>
  typename Reference<dim>::FieldNorms
  Reference<dim>::compare_field(const Spec     &spec,
                                const Follower &follower,
                                const double    time) const
  {
    const auto  &components = follower.components;
    WeightedNorm values(spec.norm), references(spec.norm), errors(spec.norm);
    dealii::Vector<double> expected(components.size());
    spec.expressions->set_time(time);
    follower.field->prepare();
    const unsigned int start = points.layout.offset("initial_position");
    unsigned int       p     = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const unsigned int point  = p++;
        const double      *fields = points.fields(point);
        if (!follower.takes_body[static_cast<unsigned int>(fields[0])])
          continue;
        double computed[9] = {};
        follower.field->evaluate(point, particle.get_location(), computed);
        Point<dim> place;
        std::copy_n(fields + start, dim, place.begin_raw());
        spec.expressions->vector_value(place, expected);
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
    const auto comm = points.communicator;
    return {values.value(comm), references.value(comm), errors.value(comm)};
  }

  template <int dim>
  bool
  Reference<dim>::follows_steps() const
  {
    return std::any_of(references.begin(),
                       references.end(),
                       [](const Spec &spec) { return spec.largest; });
  }

  template <int dim>
  void
  Reference<dim>::follow_step(const double time)
  {
    for (unsigned int i = 0; i < followers.size(); ++i)
      if (references[i].largest)
        {
          const auto now = compare_field(references[i], followers[i], time);
          // What is not a number once stays so.
          const auto rise = [](double &largest, const double value) {
            if (!(value <= largest) && !std::isnan(largest))
              largest = value;
          };
          rise(followers[i].largest.value, now.value);
          rise(followers[i].largest.reference, now.reference);
          rise(followers[i].largest.error, now.error);
        }
  }

  template <int dim>
  ReferenceError
  Reference<dim>::compare_probe(const Spec &spec) const
  {
    // The norm of one number is its size.
    ReferenceError record{spec.name,
                          "probe",
                          "max",
                          not_a_number,
                          not_a_number,
                          not_a_number,
                          {},
                          {}};
    const Curve    curve{history.column("time"),
                      history.column(spec.columns.front())};
    const double   time = spec.time ? *spec.time : curve.x.back();
    record.value        = curve.value(time);
    record.reference    = spec.value->value(Point<1>(time));
    record.error        = std::abs(record.value - record.reference);
    if (!curve.contains(time))
      record.flaw = "the history does not reach t = " + std::to_string(time);
    finish(record, spec.scale, std::abs(record.reference));
    return record;
  }

  template <int dim>
  ReferenceError
  Reference<dim>::compare_column(const Spec        &spec,
                                 const std::string &column,
                                 const FinerRun    *finer) const
  {
    const bool     is_finer = spec.kind == Spec::Kind::finer_run;
    ReferenceError record{is_finer ? spec.name + "_" + column : spec.name,
                          is_finer ? "finer run" : "curve",
                          name_of(spec.norm),
                          not_a_number,
                          not_a_number,
                          not_a_number,
                          {},
                          {}};
    const auto computed =
      make_curve(history.column(spec.against), history.column(column));
    std::optional<Curve> expected = spec.curve;
    if (is_finer && finer != nullptr)
      {
        record.reference_wall_seconds = finer->wall_seconds;
        expected =
          make_curve(finer->history[spec.against], finer->history[column]);
      }

    std::optional<CurveNorms> norms;
    if (is_finer && finer == nullptr)
      record.flaw = "there is no finer run";
    else if (!computed || !expected)
      record.flaw = "'" + spec.against + "' rises and falls";
    else if (spec.value)
      norms = compare_curves(
        *computed,
        [&](const double x) { return spec.value->value(Point<1>(x)); },
        computed->x,
        spec.norm);
    else
      {
        // A curve is known at its abscissas alone; the rows of this run are
        // its own best, and the finer run is the smoother to interpolate.
        auto at = is_finer ? computed->x : expected->x;
        at.erase(std::remove_if(at.begin(),
                                at.end(),
                                [&](const double x) {
                                  return !expected->contains(x);
                                }),
                 at.end());
        norms = compare_curves(
          *computed,
          [&](const double x) { return expected->value(x); },
          at,
          spec.norm);
      }
    if (norms)
      {
        record.value     = norms->last_value;
        record.reference = norms->last_reference;
        record.error     = norms->error;
      }
    else if (record.flaw.empty())
      record.flaw =
        "run and reference have no '" + spec.against + "' in common";
    finish(record, spec.scale, norms ? norms->reference : not_a_number);
    return record;
  }

  template <int dim>
  std::vector<ReferenceError>
  Reference<dim>::errors(const double time, const FinerRuns &finer_runs) const
  {
    const bool first =
      Utilities::MPI::this_mpi_process(points.communicator) == 0;
    std::vector<ReferenceError> records;
    for (unsigned int i = 0; i < followers.size(); ++i)
      {
        const auto &spec = references[i];
        if (spec.kind == Spec::Kind::field)
          {
            const auto norms = spec.largest ?
                                 followers[i].largest :
                                 compare_field(spec, followers[i], time);
            records.push_back({spec.name,
                               "field",
                               name_of(spec.norm),
                               norms.value,
                               norms.reference,
                               norms.error,
                               {},
                               {}});
            finish(records.back(), spec.scale, norms.reference);
          }
        else if (first && spec.kind == Spec::Kind::probe)
          records.push_back(compare_probe(spec));
        else if (first)
          {
            const auto finer = finer_runs.find(spec.name);
            for (const auto &column : spec.columns)
              records.push_back(compare_column(spec,
                                               column,
                                               finer == finer_runs.end() ?
                                                 nullptr :
                                                 &finer->second));
          }
      }
    return records;
  }

  template class Reference<2>;
  template class Reference<3>;
} // namespace impm
