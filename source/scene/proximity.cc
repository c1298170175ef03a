#include <impm/scene/proximity.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    using Limits = std::numeric_limits<double>;

    /** Without overflow, unlike Tensor::norm(). */
    template <int dim>
    double
    length_of(const Tensor<1, dim> &vector)
    {
      double length = 0;
      for (unsigned int d = 0; d < dim; ++d)
        length = std::hypot(length, vector[d]);
      return length;
    }

    /**
     * To a circle, cylinder or sphere without ends: `offset` is from its centre
     * or axis, in the subspace that a projector names. Nearer to the centre
     * than round-off the normal is the one given, since a direction would be
     * chance.
     */
    template <int dim>
    Proximity<dim>
    proximity_to_round(const Tensor<1, dim>          &offset,
                       const SymmetricTensor<2, dim> &subspace,
                       const double                   radius,
                       const Tensor<1, dim>          &normal_of_centre)
    {
      const double length = length_of(offset);
      if (length <= 1e-14 * radius)
        return {length - radius, normal_of_centre, {}};
      const auto normal = offset / length;
      return {length - radius,
              normal,
              (subspace - symmetrize(outer_product(normal, normal))) / length};
    }

    /** To what two shapes share whose normals are everywhere across each other:
     * inside of one it is the other that is near, outside of both their edge.
     */
    template <int dim>
    Proximity<dim>
    intersect_across(const Proximity<dim> &a, const Proximity<dim> &b)
    {
      if (std::min(a.distance, b.distance) < Limits::min())
        return a.distance > b.distance ? a : b;
      const double distance = std::hypot(a.distance, b.distance);
      const double by_a     = a.distance / distance;
      const double by_b     = b.distance / distance;
      const auto   around   = by_b * a.normal - by_a * b.normal;
      return {distance,
              by_a * a.normal + by_b * b.normal,
              symmetrize(outer_product(around, around)) / distance +
                by_a * a.curvature + by_b * b.curvature};
    }
  } // namespace

  template <int dim>
  Proximity<dim>
  proximity_to_box(const Point<dim> &place,
                   const Point<dim> &lower,
                   const Point<dim> &upper)
  {
    Proximity<dim> result{-Limits::max(), {}, {}};
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double   below = lower[d] - place[d], above = place[d] - upper[d];
        Proximity<dim> slab{std::max({below, above, -Limits::max()}), {}, {}};
        slab.normal[d] = below > above ? -1 : 1;
        result         = d == 0 ? slab : intersect_across(result, slab);
      }
    return result;
  }

  template <int dim>
  Proximity<dim>
  proximity_to_ball(const Point<dim> &place,
                    const Point<dim> &centre,
                    const double      radius)
  {
    return proximity_to_round<dim>(place - centre,
                                   unit_symmetric_tensor<dim>(),
                                   radius,
                                   Point<dim>::unit_vector(0));
  }

  Proximity<3>
  proximity_to_cylinder(const Point<3>     &place,
                        const Point<3>     &from,
                        const Tensor<1, 3> &axis,
                        const double        length,
                        const double        radius)
  {
    const auto   offset = place - from;
    const double along  = offset * axis;

    unsigned int across = 0;
    for (unsigned int d = 1; d < 3; ++d)
      if (std::abs(axis[d]) < std::abs(axis[across]))
        across = d;
    const auto normal = cross_product_3d(axis, Point<3>::unit_vector(across));

    const auto side =
      proximity_to_round<3>(offset - along * axis,
                            unit_symmetric_tensor<3>() -
                              symmetrize(outer_product(axis, axis)),
                            radius,
                            normal / normal.norm());
    const Proximity<3> ends = 2 * along < length ?
                                Proximity<3>{-along, -axis, {}} :
                                Proximity<3>{along - length, axis, {}};
    return intersect_across(side, ends);
  }

  template <int dim>
  Proximity<dim>
  proximity_to_zero(const Point<dim> &place, const Function<dim> &function)
  {
    // A function knows no length of its own: the one of the coordinates leaves
    // half of their digits, and what is near the origin is taken for meters.
    const double   step = std::max(1e-6 * place.norm(), 1e-8);
    Tensor<1, dim> gradient;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const Tensor<1, dim> shift = step * Point<dim>::unit_vector(d);
        gradient[d] =
          (function.value(place + shift) - function.value(place - shift)) /
          (2 * step);
      }

    const double value    = function.value(place);
    const double slope    = length_of(gradient);
    const double distance = value / slope;
    if (slope > 0 && std::isfinite(slope) && std::isfinite(distance))
      return {distance, gradient / slope, {}};
    // Shape::contains() has what is no number outside, too.
    return {std::isnan(value) ?
              Limits::max() :
              std::clamp(value, -Limits::max(), Limits::max()),
            Point<dim>::unit_vector(0),
            {}};
  }

  template Proximity<2>
  proximity_to_box(const Point<2> &, const Point<2> &, const Point<2> &);
  template Proximity<3>
  proximity_to_box(const Point<3> &, const Point<3> &, const Point<3> &);
  template Proximity<2>
  proximity_to_ball(const Point<2> &, const Point<2> &, double);
  template Proximity<3>
  proximity_to_ball(const Point<3> &, const Point<3> &, double);
  template Proximity<2>
  proximity_to_zero(const Point<2> &, const Function<2> &);
  template Proximity<3>
  proximity_to_zero(const Point<3> &, const Function<3> &);
} // namespace impm
