#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/study/reference.h>

#include <algorithm>

namespace impm
{
  template <int dim>
  Reference<dim>::Reference(const std::vector<ReferenceSpec<dim>> &references,
                            const Bodies<dim>                     &bodies,
                            const OutputSpec                      &output,
                            const TimeSpec                        &time,
                            const MaterialPoints<dim>             &points,
                            History<dim>                          &history)
    : references(references)
    , points(points)
    , history(history)
    , followers(references.size())
  {
    for (unsigned int i = 0; i < references.size(); ++i)
      try
        {
          const auto &spec = references[i];
          if (spec.kind == Spec::Kind::field)
            {
              prepare_field(spec, bodies, output.fringe_number, followers[i]);
              continue;
            }
          check_columns(spec, time.end);
          history.remember_rows();
        }
      catch (const InputError &error)
        {
          throw InputError("Reference/" + references[i].name + "/" +
                             error.entry,
                           error.what());
        }
  }

  template <int dim>
  void
  Reference<dim>::check_columns(const Spec &spec, const double end_time) const
  {
    const auto &allowed = history.columns;
    const auto  check   = [&](const std::string &entry,
                           const std::string &column) {
      if (std::count(allowed.begin(), allowed.end(), column) == 0)
        throw InputError(entry,
                         "found '" + column +
                           "', allowed are the columns of the history: " +
                           join(allowed, ", "));
    };
    for (const auto &column : spec.columns)
      check(spec.kind == Spec::Kind::probe ? "Of" :
            spec.kind == Spec::Kind::curve ? "Column" :
                                             "Columns",
            column);
    check("Against", spec.against);
    if (spec.time && !(*spec.time > 0 && *spec.time <= end_time))
      throw InputError("Time",
                       "found " + std::to_string(*spec.time) +
                         ", allowed is more than 0 and at most the end time " +
                         std::to_string(end_time));
  }

  template <int dim>
  void
  Reference<dim>::prepare_field(const Spec        &spec,
                                const Bodies<dim> &bodies,
                                const double       fringe_number,
                                Follower          &follower) const
  {
    follower.field = make_point_field(spec.field, points, fringe_number);
    if (!follower.field)
      {
        std::vector<std::string> allowed;
        for (const auto &name : point_field_names())
          if (make_point_field(name, points))
            allowed.push_back(name);
        throw InputError("Field",
                         "found '" + spec.field +
                           "', allowed in this scene are: " +
                           join(allowed, ", "));
      }
    const unsigned int n = follower.field->n_components;
    follower.components  = spec.components;
    if (spec.components.empty())
      for (unsigned int c = 0; c < (n == 3 ? dim : n); ++c)
        follower.components.push_back(c);
    for (const auto component : follower.components)
      if (component >= n)
        throw InputError("Components",
                         "found " + std::to_string(component) +
                           ", allowed is less than " + std::to_string(n));
    if (spec.expressions->n_components != follower.components.size())
      throw InputError("Expression",
                       "found " +
                         std::to_string(spec.expressions->n_components) +
                         " expressions, allowed are " +
                         std::to_string(follower.components.size()) +
                         " between semicolons, one for each component");

    for (const auto &body : bodies)
      follower.takes_body.push_back(
        spec.bodies.empty() ||
        std::count(spec.bodies.begin(), spec.bodies.end(), body.name) > 0);
    for (const auto &body : spec.bodies)
      require_name(names_of_bodies(bodies, false), body, "Bodies");
  }

  template Reference<2>::Reference(const std::vector<ReferenceSpec<2>> &,
                                   const Bodies<2> &,
                                   const OutputSpec &,
                                   const TimeSpec &,
                                   const MaterialPoints<2> &,
                                   History<2> &);
  template Reference<3>::Reference(const std::vector<ReferenceSpec<3>> &,
                                   const Bodies<3> &,
                                   const OutputSpec &,
                                   const TimeSpec &,
                                   const MaterialPoints<3> &,
                                   History<3> &);
} // namespace impm
