#include <deal.II/base/geometry_info.h>
#include <deal.II/base/utilities.h>

#include <impm/scene/part_of_box.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Zeroth to second moment of a part of the unit box, about its origin. */
    template <int dim>
    struct BoxMoments
    {
      double         measure = 0;
      Tensor<1, dim> first, second;
    };

    /** The middles of n^dim equal parts of the unit box, by number. */
    template <int dim>
    Point<dim>
    lattice_place(unsigned int number, const unsigned int n)
    {
      Point<dim> place;
      for (unsigned int d = 0; d < dim; ++d, number /= n)
        place[d] = (number % n + 0.5) / n;
      return place;
    }

    /** Adds what a line through a place along an axis has inside. */
    template <int dim, typename Contains>
    void
    add_line(const Contains    &contains,
             Point<dim>         place,
             const unsigned int axis,
             const unsigned int n,
             BoxMoments<dim>   &moments)
    {
      const double width     = std::pow(1. / n, dim - 1);
      const auto   inside_at = [&](const double along) {
        place[axis] = along;
        return contains(place);
      };
      const auto add = [&](const double from, const double to) {
        const double measure = width * (to - from);
        moments.measure += measure;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double mean   = d == axis ? (from + to) / 2 : place[d];
            const double extent = d == axis ? to - from : 1. / n;
            moments.first[d] += measure * mean;
            moments.second[d] += measure * (mean * mean + extent * extent / 12);
          }
      };
      double last = 0, start = 0;
      bool   was_inside = inside_at(0);
      for (unsigned int i = 0; i <= n; ++i)
        {
          const double next      = i < n ? (i + 0.5) / n : 1.;
          const bool   is_inside = inside_at(next);
          if (is_inside != was_inside)
            {
              double here = last, there = next;
              while (there - here > 1e-5)
                {
                  const double middle = (here + there) / 2;
                  (inside_at(middle) == was_inside ? here : there) = middle;
                }
              const double surface = (here + there) / 2;
              if (was_inside)
                add(start, surface);
              start = surface;
            }
          last       = next;
          was_inside = is_inside;
        }
      if (was_inside)
        add(start, 1);
    }
  } // namespace

  template <int dim>
  PartOfBox<dim>
  find_part(const std::function<bool(const Point<dim> &)> &contains,
            const BoundingBox<dim>                        &box)
  {
    constexpr unsigned int n         = dim == 2 ? 8 : 6;
    constexpr double       tolerance = 1e-2;
    const auto             is_inside = [&](const Point<dim> &unit) {
      return contains(box.unit_to_real(unit));
    };

    // The inside lies off the centre, along the normal. A film at a face has
    // none but vertices.
    const auto         center = create_unit_bounding_box<dim>().center();
    Tensor<1, dim>     offset;
    const unsigned int n_places = Utilities::fixed_power<dim>(n);
    for (unsigned int i = 0; i < n_places; ++i)
      if (const auto place = lattice_place<dim>(i, n); is_inside(place))
        offset += place - center;
    for (const unsigned int v : GeometryInfo<dim>::vertex_indices())
      if (contains(box.vertex(v)))
        offset += create_unit_bounding_box<dim>().vertex(v) - center;
    unsigned int axis = 0;
    for (unsigned int d = 1; d < dim; ++d)
      if (std::abs(offset[d]) > std::abs(offset[axis]))
        axis = d;

    BoxMoments<dim> moments;
    for (unsigned int i = 0; i < n_places / n; ++i)
      {
        const auto across = lattice_place<dim - 1>(i, n);
        Point<dim> place;
        for (unsigned int d = 0, other = 0; d < dim; ++d)
          if (d != axis)
            place[d] = across[other++];
        add_line(is_inside, place, axis, n, moments);
      }

    PartOfBox<dim> part;
    if (moments.measure < tolerance)
      return part;
    part.centroid = box.center();
    for (unsigned int d = 0; d < dim; ++d)
      part.extents[d] = box.side_length(d);
    if (moments.measure > 1 - tolerance)
      {
        part.share = 1;
        return part;
      }
    part.share    = moments.measure;
    double excess = 1 / part.share;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double mean = moments.first[d] / moments.measure;
        const double edge =
          std::sqrt(12 * (moments.second[d] / moments.measure - mean * mean));
        part.centroid[d] = box.lower_bound(d) + mean * box.side_length(d);
        part.extents[d] *= edge;
        excess *= edge;
      }
    part.extents /= std::pow(excess, 1. / dim);
    return part;
  }

  template PartOfBox<2>
  find_part(const std::function<bool(const Point<2> &)> &,
            const BoundingBox<2> &);
  template PartOfBox<3>
  find_part(const std::function<bool(const Point<3> &)> &,
            const BoundingBox<3> &);
} // namespace impm
