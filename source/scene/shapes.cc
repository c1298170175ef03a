#include <deal.II/base/function_parser.h>
#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/input/expressions.h>
#include <impm/input/parameter_file.h>
#include <impm/scene/mesh_file.h>
#include <impm/scene/shapes.h>
#include <impm/scene/surface_mesh.h>

#include <boost/algorithm/cxx11/any_of.hpp>
#include <boost/range/adaptor/map.hpp>

#include <algorithm>
#include <cmath>

namespace impm
{
  namespace
  {
    namespace Patterns = dealii::Patterns;
    using boost::algorithm::any_of;
    using dealii::BoundingBox;
    using dealii::FunctionParser;
    using dealii::Point;
    using Constants = std::map<std::string, double>;
    using Handler   = dealii::ParameterHandler;

    /** How far outside of a surface a point still counts as on it, relative to
     * the size of the shape: round-off must not decide. */
    constexpr double tolerance = 1e-12;

    /** What may stand in an entry. Most have to be set: their defaults match
     * the patterns, but create() refuses them. */
    struct Value
    {
      std::shared_ptr<const Patterns::PatternBase> pattern;
      std::string                                  documentation, fallback = "";
      bool                                         has_to_be_set = true;
    };

    auto
    declares(const std::map<std::string, Value> &entries)
    {
      return [entries](Handler &prm) {
        for (const auto &[name, value] : entries)
          prm.declare_entry(name,
                            value.fallback,
                            *value.pattern,
                            value.documentation,
                            value.has_to_be_set);
      };
    }

    template <int dim>
    Point<dim>
    get_point(const Handler &prm, const std::string &entry)
    {
      const auto list = get_numbers(prm, entry, dim);
      return Point<dim>(dealii::Tensor<1, dim>(dealii::make_array_view(list)));
    }

    double
    get_radius(const Handler &prm)
    {
      if (const double radius = prm.get_double("Radius"); radius > 0)
        return radius;
      throw InputError("Radius",
                       "found '" + prm.get("Radius") +
                         "', allowed are numbers > 0");
    }

    template <int dim>
    std::vector<std::shared_ptr<const Shape<dim>>>
    get_shapes(const Handler          &prm,
               const NamedShapes<dim> &others,
               const unsigned int      n_at_least)
    {
      const std::string allowed =
        "the shapes named before it: " +
        join(others | boost::adaptors::map_keys, ", ") +
        (others.empty() ? "none" : "");

      std::vector<std::shared_ptr<const Shape<dim>>> shapes;
      for (const auto &name : split_names(prm.get("Of")))
        if (const auto other = others.find(name); other != others.end())
          shapes.push_back(other->second);
        else
          throw InputError("Of",
                           "found '" + name + "', allowed are " + allowed);
      if (shapes.size() < n_at_least)
        throw InputError("Of",
                         "found '" + prm.get("Of") + "', allowed are " +
                           std::to_string(n_at_least) + " or more of " +
                           allowed);
      return shapes;
    }

    template <int dim>
    Shape<dim>
    create_box(Handler &prm, const Constants &, const NamedShapes<dim> &)
    {
      const auto lower = get_point<dim>(prm, "Lower corner");
      const auto upper = get_point<dim>(prm, "Upper corner");
      for (unsigned int d = 0; d < dim; ++d)
        if (!(lower[d] < upper[d]))
          throw InputError("Upper corner",
                           "found '" + prm.get("Upper corner") +
                             "', allowed are coordinates greater than '" +
                             prm.get("Lower corner") + "' in each direction");

      const BoundingBox<dim> box({lower, upper});
      // One per face: a box that is to reach "to infinity" stays sharp at its
      // other ends.
      const auto margin = [box](const unsigned int d, const double face) {
        const double length = box.side_length(d);
        return tolerance * (length > 1e30 ? std::abs(face) : length);
      };
      Point<dim> first, last;
      for (unsigned int d = 0; d < dim; ++d)
        {
          first[d] = lower[d] - margin(d, lower[d]);
          last[d]  = upper[d] + margin(d, upper[d]);
        }
      return {[first, last](const Point<dim> &point) {
                for (unsigned int d = 0; d < dim; ++d)
                  if (point[d] < first[d] || point[d] > last[d])
                    return false;
                return true;
              },
              [lower, upper](const Point<dim> &point) {
                return proximity_to_box(point, lower, upper);
              },
              box,
              true};
    }

    template <int dim>
    Shape<dim>
    create_ball(Handler &prm, const Constants &, const NamedShapes<dim> &)
    {
      const auto       centre = get_point<dim>(prm, "Centre");
      const double     radius = get_radius(prm);
      BoundingBox<dim> box({centre, centre});
      box.extend(radius);
      return {[centre, radius](const Point<dim> &point) {
                return centre.distance(point) <= radius * (1 + tolerance);
              },
              [centre, radius](const Point<dim> &point) {
                return proximity_to_ball(point, centre, radius);
              },
              box};
    }

    Shape<3>
    create_cylinder(Handler &prm, const Constants &, const NamedShapes<3> &)
    {
      const auto   from   = get_point<3>(prm, "Axis from");
      const auto   to     = get_point<3>(prm, "Axis to");
      const double radius = get_radius(prm);
      const double length = from.distance(to);
      if (!(length > 0))
        throw InputError("Axis to",
                         "found '" + prm.get("Axis to") +
                           "', allowed are points other than 'Axis from'");
      const auto   axis      = (to - from) / length;
      const double margin    = tolerance * std::max(length, 2 * radius);
      const auto   is_inside = [=](const Point<3> &point) {
        const auto   offset = point - from;
        const double along  = offset * axis;
        return along >= -margin && along <= length + margin &&
               (offset - along * axis).norm() <= radius + margin;
      };
      const auto proximity = [=](const Point<3> &point) {
        return proximity_to_cylinder(point, from, axis, length, radius);
      };

      // The ends are discs, which reach the farther in a direction the less
      // the axis points there.
      dealii::Tensor<1, 3> reach;
      for (unsigned int d = 0; d < 3; ++d)
        reach[d] = radius * std::sqrt(std::max(0., 1 - axis[d] * axis[d]));
      BoundingBox<3> box({from - reach, from + reach});
      box.merge_with(BoundingBox<3>({to - reach, to + reach}));
      return {is_inside, proximity, box};
    }

    template <int dim>
    Shape<dim>
    unite(const std::vector<std::shared_ptr<const Shape<dim>>> &shapes)
    {
      auto box = shapes.front()->bounding_box;
      for (const auto &shape : shapes)
        if (const auto &next = shape->bounding_box; box && next)
          box->merge_with(*next);
        else
          box.reset();
      return {[shapes](const Point<dim> &point) {
                return any_of(shapes, [&](const auto &shape) {
                  return shape->contains(point);
                });
              },
              [shapes](const Point<dim> &point) {
                auto nearest = shapes.front()->proximity(point);
                for (unsigned int i = 1; i < shapes.size(); ++i)
                  if (const auto next = shapes[i]->proximity(point);
                      next.distance < nearest.distance)
                    nearest = next;
                return nearest;
              },
              box};
    }

    template <int dim>
    Shape<dim>
    create_union(Handler &prm,
                 const Constants &,
                 const NamedShapes<dim> &others)
    {
      return unite(get_shapes(prm, others, 1));
    }

    template <int dim>
    Shape<dim>
    create_intersection(Handler &prm,
                        const Constants &,
                        const NamedShapes<dim> &others)
    {
      const auto                      shapes = get_shapes(prm, others, 2);
      std::optional<BoundingBox<dim>> box;
      for (const auto &shape : shapes)
        if (const auto &next = shape->bounding_box; box && next)
          {
            auto corners = box->get_boundary_points();
            for (unsigned int d = 0; d < dim; ++d)
              {
                corners.first[d] =
                  std::max(corners.first[d], next->lower_bound(d));
                corners.second[d] =
                  std::min(corners.second[d], next->upper_bound(d));
                if (!(corners.first[d] < corners.second[d]))
                  throw InputError("Of",
                                   "found '" + prm.get("Of") +
                                     "', allowed are shapes that overlap");
              }
            box = BoundingBox<dim>(corners);
          }
        else if (next)
          box = next;
      return {[shapes](const Point<dim> &point) {
                return std::all_of(shapes.begin(),
                                   shapes.end(),
                                   [&](const auto &shape) {
                                     return shape->contains(point);
                                   });
              },
              [shapes](const Point<dim> &point) {
                auto farthest = shapes.front()->proximity(point);
                for (unsigned int i = 1; i < shapes.size(); ++i)
                  if (const auto next = shapes[i]->proximity(point);
                      next.distance > farthest.distance)
                    farthest = next;
                return farthest;
              },
              box};
    }

    template <int dim>
    Shape<dim>
    create_difference(Handler &prm,
                      const Constants &,
                      const NamedShapes<dim> &others)
    {
      const auto shapes = get_shapes(prm, others, 2);
      const auto whole  = shapes.front();
      const auto cuts   = unite<dim>({shapes.begin() + 1, shapes.end()});

      // A point on the surface of what is cut away has to go one way. It goes
      // with the cut: else two touching cuts would leave a film of points
      // between them, and a shape would share points with what surrounds it.
      return {[whole, cuts](const Point<dim> &point) {
                return whole->contains(point) && !cuts.contains(point);
              },
              [whole, cuts](const Point<dim> &point) {
                const auto outer = whole->proximity(point);
                const auto inner = turn(cuts.proximity(point));
                return inner.distance > outer.distance ? inner : outer;
              },
              whole->bounding_box};
    }

    template <int dim>
    Shape<dim>
    create_function(Handler         &prm,
                    const Constants &constants,
                    const NamedShapes<dim> &)
    {
      const std::string entry = "Inside where negative";
      const auto        parser =
        read_expressions<dim>(prm, entry, 1, false, constants);
      if (!parser)
        throw InputError(entry, "found '', allowed is an expression");
      return {[parser](const Point<dim> &point) {
                return parser->value(point) <= 0;
              },
              [parser](const Point<dim> &point) {
                return proximity_to_zero<dim>(point, *parser);
              },
              std::nullopt};
    }

    template <int dim>
    Shape<dim>
    create_mesh(Handler &prm, const Constants &, const NamedShapes<dim> &)
    {
      const std::string file  = prm.get("File");
      const double      scale = prm.get_double("Scale");
      const auto        shift = get_point<dim>(prm, "Shift");
      if (!(scale > 0 && std::isfinite(scale)))
        throw InputError("Scale",
                         "found '" + prm.get("Scale") +
                           "', allowed are numbers > 0");
      try
        {
          auto surface = read_mesh_file<dim>(file);
          for (auto &vertex : surface.vertices)
            vertex = scale * vertex + shift;
          const auto mesh =
            std::make_shared<const SurfaceMesh<dim>>(std::move(surface));
          return {
            [mesh](const Point<dim> &point) { return mesh->contains(point); },
            [mesh](const Point<dim> &point) { return mesh->proximity(point); },
            mesh->bounding_box()};
        }
      catch (const InputError &error)
        {
          throw InputError("File", "found '" + file + "', " + error.what());
        }
    }

    template <int dim>
    std::vector<ShapeEntry<dim>>
    make_list()
    {
      // No limit on the length of lists, as create() has more to say about it.
      const Value point{Patterns::List(Patterns::Double()).clone(),
                        "Coordinates [m], one for each direction."};
      const Value radius{Patterns::Double(0).clone(), "Positive [m].", "0"};
      const Value names{Patterns::List(Patterns::Anything()).clone(),
                        "Names of shapes that come before this one."};
      const Value expression{
        Patterns::Anything().clone(),
        "Expression in x, y, z [m] and the constants; 0 is the "
        "surface."};

      const Value file{
        Patterns::Anything().clone(),
        ".msh, .vtk, .inp (Abaqus), .ucd, in 3D .stl: a mesh, whose boundary is "
        "taken, or a closed surface; a path from the file that sets it."};
      const Value scale{Patterns::Double().clone(),
                        "Numbers of the file times this are metres, positive.",
                        "1",
                        false};
      const Value shift{Patterns::List(Patterns::Double()).clone(),
                        "Is added to all places after that [m].",
                        dim == 2 ? "0, 0" : "0, 0, 0",
                        false};

      std::vector<ShapeEntry<dim>> list = {
        {"box",
         "A box with edges along the axes, between two opposite corners.",
         declares({{"Lower corner", point}, {"Upper corner", point}}),
         &create_box<dim>},
        {"ball",
         "All points up to a distance from a centre.",
         declares({{"Centre", point}, {"Radius", radius}}),
         &create_ball<dim>},
        {"union",
         "All points of one or more other shapes.",
         declares({{"Of", names}}),
         &create_union<dim>},
        {"difference",
         "The first of other shapes without what lies in or on the rest.",
         declares({{"Of", names}}),
         &create_difference<dim>},
        {"intersection",
         "All points that lie in each of two or more other shapes.",
         declares({{"Of", names}}),
         &create_intersection<dim>},
        {"mesh",
         "What a mesh from a file fills.",
         declares({{"File", file}, {"Scale", scale}, {"Shift", shift}}),
         &create_mesh<dim>},
        {"function",
         "Where an expression is not positive. It has no bounding box.",
         declares({{"Inside where negative", expression}}),
         &create_function<dim>}};
      if constexpr (dim == 3)
        list.insert(
          list.begin() + 2,
          {"cylinder",
           "A circular cylinder with plane ends, given by their centres.",
           declares(
             {{"Axis from", point}, {"Axis to", point}, {"Radius", radius}}),
           &create_cylinder});
      return list;
    }
  } // namespace

  template <int dim>
  const std::vector<ShapeEntry<dim>> &
  shape_list()
  {
    static const auto list = make_list<dim>();
    return list;
  }

  template const std::vector<ShapeEntry<2>> &
  shape_list();
  template const std::vector<ShapeEntry<3>> &
  shape_list();
} // namespace impm
