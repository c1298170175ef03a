#include <deal.II/base/exceptions.h>
#include <deal.II/base/function_parser.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>
#include <impm/input/parameter_file.h>
#include <impm/scene/shapes.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/range/adaptor/map.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

namespace impm
{
  namespace
  {
    namespace Patterns  = dealii::Patterns;
    namespace Utilities = dealii::Utilities;
    using dealii::BoundingBox;
    using dealii::FunctionParser;
    using dealii::Point;
    using Constants = std::map<std::string, double>;
    using Handler   = dealii::ParameterHandler;

    template <int dim>
    using ShapePointer = std::shared_ptr<const Shape<dim>>;

    /** How far outside of a surface a point still counts as on it, relative to
     * the size of the shape: round-off must not decide. */
    constexpr double tolerance = 1e-12;

    /** A shape put together from its two answers. */
    template <int dim>
    class Region : public Shape<dim>
    {
    public:
      using IsInside = std::function<bool(const Point<dim> &)>;

      Region(const IsInside                        &inside,
             const std::optional<BoundingBox<dim>> &around,
             const bool                             fills_box = false)
        : is_inside(inside)
        , box(around)
        , fills_box(fills_box)
      {}

      bool
      contains(const Point<dim> &point) const override
      {
        return is_inside(point);
      }

      std::optional<BoundingBox<dim>>
      bounding_box() const override
      {
        return box;
      }

      bool
      is_box() const override
      {
        return fills_box;
      }

    private:
      const IsInside                        is_inside;
      const std::optional<BoundingBox<dim>> box;
      const bool                            fills_box;
    };

    /** What may stand in an entry. All have to be set: the defaults match the
     * patterns, but create() refuses them. */
    struct Value
    {
      std::shared_ptr<const Patterns::PatternBase> pattern;
      std::string                                  documentation, fallback = "";
    };

    auto
    declares(const std::map<std::string, Value> &entries)
    {
      return [entries](Handler &prm) {
        for (const auto &[name, value] : entries)
          prm.declare_entry(
            name, value.fallback, *value.pattern, value.documentation, true);
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
    std::vector<ShapePointer<dim>>
    get_shapes(const Handler          &prm,
               const NamedShapes<dim> &others,
               const unsigned int      n_at_least)
    {
      const std::string allowed =
        "the shapes named before it: " +
        boost::algorithm::join(others | boost::adaptors::map_keys, ", ") +
        (others.empty() ? "none" : "");

      std::vector<ShapePointer<dim>> shapes;
      for (const auto &name : split_names(prm.get("Of")))
        {
          const auto other = others.find(name);
          if (other == others.end())
            throw InputError("Of",
                             "found '" + name + "', allowed are " + allowed);
          shapes.push_back(other->second);
        }
      if (shapes.size() < n_at_least)
        throw InputError("Of",
                         "found '" + prm.get("Of") + "', allowed are " +
                           std::to_string(n_at_least) + " or more of " +
                           allowed);
      return shapes;
    }

    template <int dim>
    ShapePointer<dim>
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

      // The tolerance is one per direction: a box that is to reach "to
      // infinity" in one of them stays sharp in the others.
      const BoundingBox<dim> box({lower, upper});
      const auto             is_inside = [box](const Point<dim> &point) {
        return box.point_inside(point, tolerance);
      };
      return std::make_shared<Region<dim>>(is_inside, box, true);
    }

    template <int dim>
    ShapePointer<dim>
    create_ball(Handler &prm, const Constants &, const NamedShapes<dim> &)
    {
      const auto       centre = get_point<dim>(prm, "Centre");
      const double     radius = get_radius(prm);
      BoundingBox<dim> box({centre, centre});
      box.extend(radius);
      const auto is_inside = [centre, radius](const Point<dim> &point) {
        return centre.distance(point) <= radius * (1 + tolerance);
      };
      return std::make_shared<Region<dim>>(is_inside, box);
    }

    ShapePointer<3>
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

      // The ends are discs, which reach the farther in a direction the less
      // the axis points there.
      Point<3> lower, upper;
      for (unsigned int d = 0; d < 3; ++d)
        {
          const double reach =
            radius * std::sqrt(std::max(0., 1 - axis[d] * axis[d]));
          lower[d] = std::min(from[d], to[d]) - reach;
          upper[d] = std::max(from[d], to[d]) + reach;
        }
      return std::make_shared<Region<3>>(is_inside,
                                         BoundingBox<3>({lower, upper}));
    }

    template <int dim>
    ShapePointer<dim>
    create_union(Handler &prm,
                 const Constants &,
                 const NamedShapes<dim> &others)
    {
      const auto shapes = get_shapes(prm, others, 1);
      auto       box    = shapes.front()->bounding_box();
      for (const auto &shape : shapes)
        if (const auto next = shape->bounding_box(); box && next)
          box->merge_with(*next);
        else
          box.reset();
      const auto is_inside = [shapes](const Point<dim> &point) {
        const auto has_point = [&](const auto &shape) {
          return shape->contains(point);
        };
        return std::any_of(shapes.begin(), shapes.end(), has_point);
      };
      return std::make_shared<Region<dim>>(is_inside, box);
    }

    template <int dim>
    ShapePointer<dim>
    create_difference(Handler &prm,
                      const Constants &,
                      const NamedShapes<dim> &others)
    {
      const auto shapes = get_shapes(prm, others, 2);

      // A point on the surface of what is cut away has to go one way. It goes
      // with the cut: else two touching cuts would leave a film of points
      // between them, and a shape would share points with what surrounds it.
      const auto is_inside = [shapes](const Point<dim> &point) {
        const auto has_point = [&](const auto &shape) {
          return shape->contains(point);
        };
        return has_point(shapes.front()) &&
               std::none_of(shapes.begin() + 1, shapes.end(), has_point);
      };
      return std::make_shared<Region<dim>>(is_inside,
                                           shapes.front()->bounding_box());
    }

    template <int dim>
    ShapePointer<dim>
    create_function(Handler         &prm,
                    const Constants &constants,
                    const NamedShapes<dim> &)
    {
      const std::string entry = "Inside where negative";
      const auto        parser =
        read_expressions<dim>(prm, entry, 1, false, constants);
      if (!parser)
        throw InputError(entry, "found '', allowed is an expression");
      const auto is_inside = [parser](const Point<dim> &point) {
        return parser->value(point) <= 0;
      };
      return std::make_shared<Region<dim>>(is_inside, std::nullopt);
    }

    template <int dim>
    std::vector<ShapeEntry<dim>>
    make_list()
    {
      // No limit on the length of lists, as create() has more to say about it.
      const Value point{Patterns::List(Patterns::Double()).clone(),
                        std::to_string(dim) + " coordinates [m]."};
      const Value radius{Patterns::Double(0).clone(), "Positive [m].", "0"};
      const Value names{Patterns::List(Patterns::Anything()).clone(),
                        "Names of shapes that come before this one."};
      const Value expression{Patterns::Anything().clone(),
                             "Expression in " +
                               FunctionParser<dim>::default_variable_names() +
                               " [m] and the constants; 0 is the surface."};

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
  shape_list<2>();
  template const std::vector<ShapeEntry<3>> &
  shape_list<3>();
} // namespace impm
