#include <deal.II/base/bounding_box.h>
#include <deal.II/base/numbers.h>

#include <impm/base/exceptions.h>
#include <impm/scene/closed_surface.h>

#include <boost/lexical_cast.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** What bounds a facet: a vertex in the plane, else an edge. */
    template <int dim>
    using Ridge = std::array<unsigned int, dim - 1>;

    /** A facet at a ridge, which has it on one side or the other. */
    struct Side
    {
      unsigned int facet;
      bool         is_left;
    };

    template <int dim>
    using Ridges = std::map<Ridge<dim>, std::vector<Side>>;

    template <int dim>
    std::array<Point<dim>, dim>
    corners_of(const FacettedSurface<dim> &surface, const unsigned int facet)
    {
      std::array<Point<dim>, dim> corners;
      for (unsigned int i = 0; i < dim; ++i)
        corners[i] = surface.vertices[surface.facets[facet][i]];
      return corners;
    }

    template <int dim>
    Point<dim>
    middle_of(const std::array<Point<dim>, dim> &corners)
    {
      Point<dim> middle;
      for (const auto &corner : corners)
        middle += corner / dim;
      return middle;
    }

    template <int dim>
    Ridges<dim>
    find_ridges(const FacettedSurface<dim> &surface)
    {
      Ridges<dim> ridges;
      for (unsigned int f = 0; f < surface.facets.size(); ++f)
        for (unsigned int i = 0; i < dim; ++i)
          {
            const auto &facet = surface.facets[f];
            Ridge<dim>  ridge;
            bool        is_left = i == 0;
            ridge[0]            = facet[(i + 1) % dim];
            if constexpr (dim == 3)
              {
                ridge[1] = facet[(i + 2) % dim];
                is_left  = ridge[0] < ridge[1];
                std::sort(ridge.begin(), ridge.end());
              }
            ridges[ridge].push_back({f, is_left});
          }
      return ridges;
    }

    /** Where ridges go round a part and come back, each has two facets, or four
     * if two parts touch there. */
    template <int dim>
    void
    check_closed(const FacettedSurface<dim> &surface, const Ridges<dim> &ridges)
    {
      unsigned int      n_open = 0;
      const Ridge<dim> *first  = nullptr;
      for (const auto &[ridge, sides] : ridges)
        if (sides.size() % 2 == 1)
          {
            ++n_open;
            if (!first)
              first = &ridge;
          }
      if (n_open == 0)
        return;
      Point<dim> place;
      for (const auto vertex : *first)
        place += surface.vertices[vertex] / (dim - 1);
      throw InputError("",
                       "whose surface is not closed: " +
                         std::to_string(n_open) +
                         (dim == 2 ? " vertices with an odd number of segments"
                                     ", one of them at (" :
                                     " edges with an odd number of facets, one "
                                     "of them around (") +
                         boost::lexical_cast<std::string>(place) + ")");
    }

    /**
     * Numbers the parts that ridges of two facets hold together, and turns the
     * facets of each alike.
     */
    template <int dim>
    std::vector<std::vector<unsigned int>>
    turn_alike(FacettedSurface<dim> &surface, const Ridges<dim> &ridges)
    {
      struct Neighbour
      {
        unsigned int facet;
        bool         looks_away;
      };
      std::vector<std::vector<Neighbour>> neighbours(surface.facets.size());
      for (const auto &[ridge, sides] : ridges)
        if (sides.size() == 2)
          for (const unsigned int s : {0, 1})
            neighbours[sides[s].facet].push_back(
              {sides[1 - s].facet, sides[0].is_left == sides[1].is_left});

      enum class State
      {
        unknown,
        kept,
        turned
      };
      std::vector<State>                     states(surface.facets.size());
      std::vector<std::vector<unsigned int>> parts;
      for (unsigned int first = 0; first < states.size(); ++first)
        if (states[first] == State::unknown)
          {
            states[first] = State::kept;
            auto &part    = parts.emplace_back(1, first);
            for (std::size_t i = 0; i < part.size(); ++i)
              for (const auto &[facet, looks_away] : neighbours[part[i]])
                {
                  const auto wanted =
                    (states[part[i]] == State::turned) != looks_away ?
                      State::turned :
                      State::kept;
                  if (states[facet] == State::unknown)
                    {
                      states[facet] = wanted;
                      part.push_back(facet);
                    }
                  else if (states[facet] != wanted)
                    throw InputError(
                      "",
                      "whose surface has one side only, around (" +
                        boost::lexical_cast<std::string>(
                          middle_of<dim>(corners_of(surface, facet))) +
                        ")");
                }
          }
      for (unsigned int f = 0; f < states.size(); ++f)
        if (states[f] == State::turned)
          std::swap(surface.facets[f][0], surface.facets[f][1]);
      return parts;
    }

    /** Which part of all directions a facet covers, as seen from a place behind
     * it; negative from the front. */
    template <int dim>
    double
    share_of_view(const std::array<Point<dim>, dim> &corners,
                  const Point<dim>                  &from)
    {
      std::array<Tensor<1, dim>, dim> ways;
      for (unsigned int i = 0; i < dim; ++i)
        ways[i] = corners[i] - from;
      if constexpr (dim == 2)
        return std::atan2(cross_product_2d(ways[1]) * ways[0],
                          ways[0] * ways[1]) /
               (2 * numbers::PI);
      else
        {
          // van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30, 1983
          const double a = ways[0].norm(), b = ways[1].norm(),
                       c = ways[2].norm();
          return std::atan2(cross_product_3d(ways[0], ways[1]) * ways[2],
                            a * b * c + ways[0] * ways[1] * c +
                              ways[1] * ways[2] * a + ways[2] * ways[0] * b) /
                 (2 * numbers::PI);
        }
    }

    /** A part of the surface by itself. */
    template <int dim>
    struct Part
    {
      std::vector<unsigned int> facets;
      BoundingBox<dim>          box;
      double                    volume = 0; ///< negative if it looks inwards
      Point<dim>                place;      ///< amid its largest facet

      Part(const FacettedSurface<dim>      &surface,
           const std::vector<unsigned int> &facets)
        : facets(facets)
      {
        const auto              origin = corners_of(surface, facets[0])[0];
        std::vector<Point<dim>> points;
        double                  largest = -1;
        for (const auto facet : facets)
          {
            const auto corners = corners_of(surface, facet);
            const auto area    = area_of<dim>(corners);
            points.insert(points.end(), corners.begin(), corners.end());
            volume += area * (corners[0] - origin) / dim;
            if (area.norm() > largest)
              {
                largest = area.norm();
                place   = middle_of<dim>(corners);
              }
          }
        box = BoundingBox<dim>(points);
      }

      bool
      encloses(const FacettedSurface<dim> &surface,
               const Point<dim>           &other) const
      {
        if (!box.point_inside(other))
          return false;
        double share = 0;
        for (const auto facet : facets)
          share += share_of_view<dim>(corners_of(surface, facet), other);
        return std::abs(share) > 0.5;
      }
    };
  } // namespace

  template <int dim>
  Tensor<1, dim>
  area_of(const std::array<Point<dim>, dim> &corners)
  {
    if constexpr (dim == 2)
      return cross_product_2d(corners[1] - corners[0]);
    else
      return 0.5 *
             cross_product_3d(corners[1] - corners[0], corners[2] - corners[0]);
  }

  template <int dim>
  void
  turn_outwards(FacettedSurface<dim> &surface)
  {
    const BoundingBox<dim> box(surface.vertices);
    const double           extent = box.get_boundary_points().first.distance(
      box.get_boundary_points().second);
    if (!(extent > 1e-50 && extent < 1e50))
      throw InputError("",
                       "whose surface has a size of " +
                         boost::lexical_cast<std::string>(extent) +
                         " m; allowed are 1e-50 to 1e50");
    const auto ridges = find_ridges(surface);
    check_closed(surface, ridges);

    std::vector<Part<dim>> parts;
    for (const auto &facets : turn_alike(surface, ridges))
      parts.emplace_back(surface, facets);
    double volume = 0;
    for (const auto &part : parts)
      {
        bool is_cavity = false;
        for (const auto &other : parts)
          if (&other != &part && other.encloses(surface, part.place))
            is_cavity = !is_cavity;
        volume += is_cavity ? -std::abs(part.volume) : std::abs(part.volume);
        if ((part.volume < 0) != is_cavity)
          for (const auto facet : part.facets)
            std::swap(surface.facets[facet][0], surface.facets[facet][1]);
      }

    double size = 1;
    for (unsigned int d = 0; d < dim; ++d)
      size *= box.side_length(d);
    if (!(volume > 1e-12 * size))
      throw InputError("", "whose surface encloses nothing");
  }

  template Tensor<1, 2>
  area_of<2>(const std::array<Point<2>, 2> &);
  template Tensor<1, 3>
  area_of<3>(const std::array<Point<3>, 3> &);
  template void
  turn_outwards(FacettedSurface<2> &);
  template void
  turn_outwards(FacettedSurface<3> &);
} // namespace impm
