#include <impm/base/exceptions.h>
#include <impm/study/reference.h>

#include <algorithm>

namespace impm
{
  namespace
  {
    std::string
    join(const std::vector<std::string> &names)
    {
      std::string all;
      for (const auto &name : names)
        all += (all.empty() ? "" : ", ") + name;
      return all;
    }
  } // namespace

  template <int dim>
  Reference<dim>::Reference(const Scene<dim>          &scene,
                            const MaterialPoints<dim> &points,
                            History<dim>              &history)
    : scene(scene)
    , points(points)
    , history(history)
    , followers(scene.references.size())
  {
    for (unsigned int i = 0; i < scene.references.size(); ++i)
      try
        {
          const auto &spec = scene.references[i];
          if (spec.kind == Spec::Kind::field)
            {
              prepare_field(spec, followers[i]);
              continue;
            }
          check_columns(spec);
          history.remember_rows();
        }
      catch (const InputError &error)
        {
          throw InputError("Reference/" + scene.references[i].name + "/" +
                             error.entry,
                           error.what());
        }
  }

  template <int dim>
  void
  Reference<dim>::check_columns(const Spec &spec) const
  {
    const auto allowed = history_columns(scene);
    const auto check   = [&](const std::string &entry,
                           const std::string &column) {
      if (std::count(allowed.begin(), allowed.end(), column) == 0)
        throw InputError(entry,
                         "found '" + column +
                           "', allowed are the columns of the history: " +
                           join(allowed));
    };
    for (const auto &column : spec.columns)
      check(spec.kind == Spec::Kind::probe ? "Of" :
            spec.kind == Spec::Kind::curve ? "Column" :
                                             "Columns",
            column);
    check("Against", spec.against);
    if (spec.time && !(*spec.time > 0 && *spec.time <= scene.time.end))
      throw InputError("Time",
                       "found " + std::to_string(*spec.time) +
                         ", allowed is more than 0 and at most the end time " +
                         std::to_string(scene.time.end));
  }

  template <int dim>
  void
  Reference<dim>::prepare_field(const Spec &spec, Follower &follower) const
  {
    follower.field =
      make_point_field(spec.field, points, scene.output.fringe_number);
    if (!follower.field)
      {
        std::vector<std::string> allowed;
        for (const auto &name : point_field_names())
          if (make_point_field(name, points))
            allowed.push_back(name);
        throw InputError("Field",
                         "found '" + spec.field +
                           "', allowed in this scene are: " + join(allowed));
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

    std::vector<std::string> deformable;
    for (const auto &body : scene.bodies)
      {
        if (!body.rigid)
          deformable.push_back(body.name);
        follower.takes_body.push_back(
          spec.bodies.empty() ||
          std::count(spec.bodies.begin(), spec.bodies.end(), body.name) > 0);
      }
    for (const auto &body : spec.bodies)
      if (std::count(deformable.begin(), deformable.end(), body) == 0)
        throw InputError("Bodies",
                         "found '" + body +
                           "', allowed are: " + join(deformable));
  }

  template Reference<2>::Reference(const Scene<2> &,
                                   const MaterialPoints<2> &,
                                   History<2> &);
  template Reference<3>::Reference(const Scene<3> &,
                                   const MaterialPoints<3> &,
                                   History<3> &);
} // namespace impm
