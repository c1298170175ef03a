#include <impm/contact/faced_surface.h>

#include <boost/geometry/index/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  namespace
  {
    // Of angles between surfaces that face each other, and between what is
    // still the same surface.
    constexpr double facing = -0.25, alike = 0.5;

    /** How far, in spacings, neighbours are looked at. */
    constexpr double radius = 2;

    /** So many of its spacings from every point, a surface has ended. Pieces
     * may be longer than wide. */
    template <int dim>
    constexpr double end_of_surface = dim == 2 ? 0.55 : 1;

    template <int dim>
    Tensor<1, dim>
    along(const Tensor<1, dim> &vector, const Tensor<1, dim> &normal)
    {
      return vector - (vector * normal) * normal;
    }

    double
    weight_at(const double distance)
    {
      const double rest = std::max(0., 1 - distance * distance);
      return rest * rest;
    }
  } // namespace

  template <int dim>
  FacedSurface<dim>::FacedSurface(std::vector<SurfacePatch<dim>> some)
    : patches(std::move(some))
    , places([&]() {
      std::vector<Point<dim>> result;
      for (const auto &patch : patches)
        result.push_back(patch.place);
      return result;
    }())
    , tree(pack_rtree_of_indices(places))
  {}

  template <int dim>
  std::optional<typename FacedSurface<dim>::Facing>
  FacedSurface<dim>::find(const Point<dim>     &place,
                          const Tensor<1, dim> &normal,
                          const unsigned int    body,
                          const double          reach) const
  {
    namespace bgi = boost::geometry::index;
    BoundingBox<dim> box({place, place});
    box.extend(reach);
    std::vector<unsigned int> near;
    for (const auto i : tree | bgi::adaptors::queried(bgi::intersects(box)))
      if (patches[i].body == body && patches[i].normal * normal < facing)
        near.push_back(i);
    if (near.empty())
      return std::nullopt;
    // Trees of different ranks give them in different orders.
    std::sort(near.begin(), near.end(), [&](const auto i, const auto j) {
      for (unsigned int d = 0; d < dim; ++d)
        if (places[i][d] != places[j][d])
          return places[i][d] < places[j][d];
      return false;
    });
    const unsigned int first =
      *std::min_element(near.begin(),
                        near.end(),
                        [&](const auto i, const auto j) {
                          return places[i].distance_square(place) <
                                 places[j].distance_square(place);
                        });

    // The plane through what is near where it is met.
    Tensor<1, dim> n       = patches[first].normal;
    double         spacing = 0; // the largest, since pieces may be small
    for (const auto i : near)
      if (patches[i].normal * n > alike)
        spacing = std::max(spacing, patches[i].spacing);
    std::vector<std::pair<unsigned int, double>> weights;
    const auto                                   weigh = [&]() {
      weights.clear();
      for (const auto i : near)
        if (patches[i].normal * n > alike)
          if (const double weight = weight_at(
                along(places[i] - place, n).norm() / (radius * spacing));
              weight > 0)
            weights.emplace_back(i, weight);
    };
    weigh();
    Tensor<1, dim> mean;
    for (const auto &[i, weight] : weights)
      mean += weight * patches[i].normal;
    if (mean.norm() == 0)
      return std::nullopt;
    n = mean / mean.norm();
    weigh();
    double         nearest = std::numeric_limits<double>::max(), sum = 0;
    Tensor<1, dim> middle;
    Tensor<2, dim> moment;
    for (const auto &[i, weight] : weights)
      {
        const auto offset = along(places[i] - place, n);
        nearest = std::min(nearest, offset.norm() / patches[i].spacing);
        sum += weight;
        middle += weight * offset;
        moment += weight * outer_product(offset, offset);
      }
    if (nearest > end_of_surface<dim>)
      return std::nullopt;

    // w (1 + b . offset), whose middle is at the place; where that takes
    // weights below zero, the surface ends on one side.
    moment += spacing * spacing * sum * outer_product(n, n);
    for (unsigned int d = 0; d < dim; ++d)
      moment[d][d] += 1e-10 * spacing * spacing * sum;
    const auto b        = -invert(moment) * middle;
    bool       is_inner = true;
    for (const auto &[i, weight] : weights)
      is_inner = is_inner && 1 + b * along(places[i] - place, n) >= 0;
    Facing result{0, n};
    sum = 0;
    for (const auto &[i, weight] : weights)
      {
        const double share =
          weight * (is_inner ? 1 + b * along(places[i] - place, n) : 1.);
        sum += share;
        // The plane across the mean normal is as much too low as that of the
        // patch is too high.
        result.gap +=
          share * (0.5 * (n + patches[i].normal) * (place - places[i]));
      }
    result.gap /= sum;
    if (std::abs(result.gap) > reach)
      return std::nullopt;
    return result;
  }

  template class FacedSurface<2>;
  template class FacedSurface<3>;
} // namespace impm
