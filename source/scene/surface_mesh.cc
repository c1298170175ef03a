#include <impm/scene/surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace impm
{
  using namespace dealii;
  namespace bgi = boost::geometry::index;

  namespace
  {
    /** How far outside of the surface a point still counts as on it, relative
     * to its size: round-off must not decide. */
    constexpr double surface_tolerance = 1e-12;

    /** The angle of a facet at a corner; in the plane, where a segment has
     * none, all weigh the same. */
    template <int dim>
    double
    angle_at(const std::array<Point<dim>, dim> &corners, const unsigned int i)
    {
      if constexpr (dim == 2)
        return 1;
      else
        {
          const auto a = corners[(i + 1) % 3] - corners[i];
          const auto b = corners[(i + 2) % 3] - corners[i];
          return std::atan2(cross_product_3d(a, b).norm(), a * b);
        }
    }
  } // namespace

  template <int dim>
  void
  SurfaceMesh<dim>::Joint::add(const Tensor<1, dim> &unit_normal,
                               const double          angle)
  {
    normal += angle * unit_normal;
    const Tensor<1, dim> news   = unit_normal - span * unit_normal;
    const double         length = news.norm();
    if (length > 1e-6)
      span += symmetrize(outer_product(news, news)) / (length * length);
  }

  template <int dim>
  SurfaceMesh<dim>::SurfaceMesh(FacettedSurface<dim> given)
    : surface(std::move(given))
  {
    turn_outwards(surface);
    box  = BoundingBox<dim>(surface.vertices);
    size = box.get_boundary_points().first.distance(
      box.get_boundary_points().second);

    std::vector<Leaf>             leaves;
    std::vector<BoundingBox<dim>> boxes;
    at_vertex.resize(surface.vertices.size());
    for (unsigned int f = 0; f < surface.facets.size(); ++f)
      {
        // Slivers have no normal, and no place that is not their neighbours'.
        const auto corners = corners_of(f);
        auto       normal  = area_of<dim>(corners);
        double     longest = 0;
        for (unsigned int i = 0; i < dim; ++i)
          longest =
            std::max(longest, corners[i].distance(corners[(i + 1) % dim]));
        const double area = normal.norm();
        normal = area > 1e-12 * std::pow(longest, dim - 1) ? normal / area :
                                                             Tensor<1, dim>();
        normals.push_back(normal);
        if (normal.norm() == 0)
          continue;
        for (unsigned int i = 0; i < dim; ++i)
          at_vertex[surface.facets[f][i]].add(normal,
                                              angle_at<dim>(corners, i));
        leaves.emplace_back(BoundingBox<dim>(std::vector<Point<dim>>(
                              corners.begin(), corners.end())),
                            f);
        boxes.push_back(leaves.back().first);
      }
    if constexpr (dim == 3)
      add_edges();
    tree     = pack_rtree(leaves);
    side_map = SideMap<dim>(box, boxes, [&](const Point<dim> &place) {
      return distance_to(find_nearest(place), place) < 0;
    });
  }

  template <int dim>
  void
  SurfaceMesh<dim>::add_edges()
  {
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> numbers;
    for (unsigned int f = 0; f < surface.facets.size(); ++f)
      {
        edges_of_facet.emplace_back();
        for (unsigned int i = 0; i < dim; ++i)
          {
            const auto ends = std::minmax(surface.facets[f][(i + 1) % dim],
                                          surface.facets[f][(i + 2) % dim]);
            const auto number =
              numbers.emplace(ends, at_edge.size()).first->second;
            if (number == at_edge.size())
              at_edge.emplace_back();
            if (normals[f].norm() > 0)
              at_edge[number].add(normals[f], 1);
            edges_of_facet[f][i] = number;
          }
      }
  }

  template <int dim>
  std::array<Point<dim>, dim>
  SurfaceMesh<dim>::corners_of(const unsigned int facet) const
  {
    std::array<Point<dim>, dim> corners;
    for (unsigned int i = 0; i < dim; ++i)
      corners[i] = surface.vertices[surface.facets[facet][i]];
    return corners;
  }

  template <int dim>
  typename SurfaceMesh<dim>::Nearest
  SurfaceMesh<dim>::nearest_of(const unsigned int facet,
                               const Point<dim>  &place) const
  {
    const auto corners = corners_of(facet);
    Nearest    nearest{{}, std::numeric_limits<double>::max(), facet, nullptr};

    const auto look_at_line = [&](const unsigned int from,
                                  const unsigned int to,
                                  const Joint       *between) {
      const auto   along    = corners[to] - corners[from];
      const double position = (place - corners[from]) * along;
      const double length   = along.norm_square();
      const auto   at_end   = [&](const unsigned int i) {
        return &at_vertex[surface.facets[facet][i]];
      };
      const Nearest found =
        position <= 0 ?
          Nearest{corners[from], 0, facet, at_end(from)} :
        position >= length ?
          Nearest{corners[to], 0, facet, at_end(to)} :
          Nearest{corners[from] + position / length * along, 0, facet, between};
      const double distance = place.distance(found.point);
      if (distance < nearest.distance)
        {
          nearest          = found;
          nearest.distance = distance;
        }
    };

    if constexpr (dim == 2)
      look_at_line(0, 1, nullptr);
    else
      {
        const auto      &normal  = normals[facet];
        const double     height  = (place - corners[0]) * normal;
        const Point<dim> foot    = place - height * normal;
        bool             is_over = true;
        for (unsigned int i = 0; i < dim; ++i)
          {
            const auto &from = corners[(i + 1) % dim],
                       &to   = corners[(i + 2) % dim];
            is_over =
              is_over && cross_product_3d(to - from, foot - from) * normal > 0;
          }
        if (is_over)
          return {foot, std::abs(height), facet, nullptr};
        for (unsigned int i = 0; i < dim; ++i)
          look_at_line((i + 1) % dim,
                       (i + 2) % dim,
                       &at_edge[edges_of_facet[facet][i]]);
      }
    return nearest;
  }

  template <int dim>
  typename SurfaceMesh<dim>::Nearest
  SurfaceMesh<dim>::find_nearest(const Point<dim> &place) const
  {
    // The facet with the nearest box is near. What is nearer comes closer.
    Leaf guess;
    tree.query(bgi::nearest(place, 1), &guess);
    auto             nearest = nearest_of(guess.second, place);
    BoundingBox<dim> around({place, place});
    around.extend(nearest.distance);
    for (auto leaf = tree.qbegin(bgi::intersects(around)); leaf != tree.qend();
         ++leaf)
      if (boost::geometry::distance(place, leaf->first) < nearest.distance)
        if (const auto found = nearest_of(leaf->second, place);
            found.distance < nearest.distance)
          nearest = found;
    return nearest;
  }

  template <int dim>
  double
  SurfaceMesh<dim>::distance_to(const Nearest    &nearest,
                                const Point<dim> &place) const
  {
    if (!nearest.joint)
      return (place - nearest.point) * normals[nearest.facet];
    const bool is_inside = (place - nearest.point) * nearest.joint->normal < 0;
    return is_inside ? -nearest.distance : nearest.distance;
  }

  template <int dim>
  bool
  SurfaceMesh<dim>::contains(const Point<dim> &place) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (!(place[d] >= box.lower_bound(d) - surface_tolerance * size &&
            place[d] <= box.upper_bound(d) + surface_tolerance * size))
        return false;
    using Side = typename SideMap<dim>::Side;
    if (const auto side = side_map.side_of(place); side != Side::unknown)
      return side == Side::inside;
    return distance_to(find_nearest(place), place) <= surface_tolerance * size;
  }

  template <int dim>
  Proximity<dim>
  SurfaceMesh<dim>::proximity(const Point<dim> &place) const
  {
    const auto     nearest  = find_nearest(place);
    const double   distance = distance_to(nearest, place);
    Proximity<dim> result{distance, normals[nearest.facet], {}};
    // The nearest point is known up to round-off of the coordinates.
    if (nearest.joint && nearest.distance > 1e-10 * size)
      {
        result.normal = (place - nearest.point) / distance;
        result.normal /= result.normal.norm();
        const auto onto_normal =
          symmetrize(outer_product(result.normal, result.normal));
        result.curvature = (nearest.joint->span - onto_normal) / distance;
      }
    return result;
  }

  template class SurfaceMesh<2>;
  template class SurfaceMesh<3>;
} // namespace impm
