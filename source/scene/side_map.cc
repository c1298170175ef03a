#include <impm/scene/side_map.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  SideMap<dim>::SideMap(
    const BoundingBox<dim>                        &box,
    const std::vector<BoundingBox<dim>>           &facets,
    const std::function<bool(const Point<dim> &)> &is_inside)
    : lower(box.get_boundary_points().first)
  {
    const double wanted = std::clamp<double>(10. * facets.size(), 1000., 1e7);
    const double extent = std::pow(box.volume() / wanted, 1. / dim);
    unsigned int n      = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        numbers[d] = std::clamp(box.side_length(d) / extent, 1., wanted);
        extents[d] = box.side_length(d) / numbers[d];
        n *= numbers[d];
      }
    sides.assign(n, Side::outside);

    for (const auto &facet : facets)
      {
        std::array<unsigned int, dim> first, last;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double margin = 1e-6 * extents[d];
            first[d]            = position_of(facet.lower_bound(d) - margin, d);
            last[d]             = position_of(facet.upper_bound(d) + margin, d);
          }
        auto position = first;
        for (unsigned int d = 0; d < dim;)
          {
            unsigned int part = 0;
            for (unsigned int e = dim; e-- > 0;)
              part = part * numbers[e] + position[e];
            sides[part] = Side::unknown;
            for (d = 0; d < dim && position[d]++ == last[d]; ++d)
              position[d] = first[d];
          }
      }

    // A part is on the side of those before it, if one of them is on any.
    for (unsigned int part = 0; part < n; ++part)
      if (sides[part] != Side::unknown)
        {
          Side         known = Side::unknown;
          Point<dim>   middle;
          unsigned int stride = 1;
          for (unsigned int d = 0; d < dim; stride *= numbers[d++])
            {
              const unsigned int position = part / stride % numbers[d];
              middle[d] = lower[d] + (position + 0.5) * extents[d];
              if (position > 0 && sides[part - stride] != Side::unknown)
                known = sides[part - stride];
            }
          sides[part] = known != Side::unknown ? known :
                        is_inside(middle)      ? Side::inside :
                                                 Side::outside;
        }
  }

  template <int dim>
  unsigned int
  SideMap<dim>::position_of(const double coordinate, const unsigned int d) const
  {
    const double position = (coordinate - lower[d]) / extents[d];
    return std::clamp(position, 0., numbers[d] - 1.);
  }

  template <int dim>
  unsigned int
  SideMap<dim>::part_at(const Point<dim> &place) const
  {
    unsigned int part = 0;
    for (unsigned int d = dim; d-- > 0;)
      part = part * numbers[d] + position_of(place[d], d);
    return part;
  }

  template class SideMap<2>;
  template class SideMap<3>;
} // namespace impm
