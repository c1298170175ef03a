#include <deal.II/base/geometry_info.h>

#include <impm/scene/surface_of_shape.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using Numbers = std::array<unsigned int, dim>;

    template <int dim>
    struct Corner
    {
      Point<dim> place;
      bool       is_inside = false;
    };

    /** The number of things along each direction, from their number in all. */
    template <int dim>
    Numbers<dim>
    unpack(unsigned int number, const Numbers<dim> &sizes)
    {
      Numbers<dim> numbers;
      for (unsigned int d = 0; d < dim; number /= sizes[d++])
        numbers[d] = number % sizes[d];
      return numbers;
    }

    template <int dim>
    unsigned int
    pack(const Numbers<dim> &numbers, const Numbers<dim> &sizes)
    {
      unsigned int number = 0;
      for (unsigned int d = dim; d-- > 0;)
        number = number * sizes[d] + numbers[d];
      return number;
    }

    /**
     * Whether a place is inside of a shape or on its surface, up to a margin.
     * Where round-off decided, two boxes that share a corner might disagree on
     * a surface through it, which then is found twice or not at all.
     */
    template <int dim>
    bool
    contains_nearly(const Shape<dim>     &shape,
                    const Point<dim>     &place,
                    const Tensor<1, dim> &margin)
    {
      if (shape.contains(place))
        return true;
      if (shape.bounding_box && !shape.bounding_box->point_inside(place, 1e-9))
        return false;
      const BoundingBox<dim> around({place - margin, place + margin});
      for (const unsigned int v : GeometryInfo<dim>::vertex_indices())
        if (shape.contains(around.vertex(v)))
          return true;
      return false;
    }

    /** Where the surface lies between two corners, to 1e-12 of their distance
     * or up to the margin. */
    template <int dim>
    Point<dim>
    find_surface(const Shape<dim>     &shape,
                 Point<dim>            inside,
                 Point<dim>            outside,
                 const Tensor<1, dim> &margin)
    {
      // An edge that round-off has put beside a face still ends at its border.
      const bool is_clear = shape.contains(inside);
      for (unsigned int step = 0; step < 40; ++step)
        {
          const Point<dim> middle        = (inside + outside) / 2;
          const bool       is_inside     = is_clear ?
                                             shape.contains(middle) :
                                             contains_nearly(shape, middle, margin);
          (is_inside ? inside : outside) = middle;
        }
      return inside;
    }

    template <int dim>
    SurfacePiece<dim>
    make_facet(const std::array<Point<dim>, dim> &corners,
               const Tensor<1, dim>              &outwards)
    {
      SurfacePiece<dim> facet;
      for (const auto &corner : corners)
        facet.position += corner / dim;
      if constexpr (dim == 2)
        facet.area = cross_product_2d(corners[1] - corners[0]);
      else
        facet.area =
          cross_product_3d(corners[1] - corners[0], corners[2] - corners[0]) /
          2;
      if (facet.area * outwards < 0)
        facet.area *= -1;
      return facet;
    }

    /**
     * The surface in a simplex. It cuts the edges between corners inside and
     * outside, whose places, by row and column, are the corners of a product of
     * two simplices. The ways through rows and columns divide it into facets.
     */
    template <int dim>
    void
    add_facets(const Shape<dim>                       &shape,
               const Tensor<1, dim>                   &margin,
               const std::array<Corner<dim>, dim + 1> &corners,
               std::vector<SurfacePiece<dim>>         &facets)
    {
      std::array<Point<dim>, dim + 1> inside, outside;
      unsigned int                    n_inside = 0, n_outside = 0;
      for (const auto &[place, is_inside] : corners)
        (is_inside ? inside[n_inside++] : outside[n_outside++]) = place;
      if (n_inside == 0 || n_outside == 0)
        return;

      std::array<std::array<Point<dim>, dim>, dim> cuts;
      Tensor<1, dim>                               outwards;
      for (unsigned int i = 0; i < n_inside; ++i)
        for (unsigned int j = 0; j < n_outside; ++j)
          {
            cuts[i][j] = find_surface(shape, inside[i], outside[j], margin);
            outwards += outside[j] - inside[i];
          }

      std::array<bool, dim - 1> goes_down; // else to the next column
      for (unsigned int s = 0; s < dim - 1; ++s)
        goes_down[s] = s + 1 >= n_outside;
      do
        {
          unsigned int                row = 0, column = 0;
          std::array<Point<dim>, dim> facet{{cuts[0][0]}};
          for (unsigned int s = 0; s < dim - 1; ++s)
            {
              ++(goes_down[s] ? row : column);
              facet[s + 1] = cuts[row][column];
            }
          facets.push_back(make_facet<dim>(facet, outwards));
        }
      while (std::next_permutation(goes_down.begin(), goes_down.end()));
    }

    /** Adds up the facets of a part, each side alone if they would cancel. What
     * is smaller than `no_area` is a point or line on the plane of a face. */
    template <int dim>
    void
    add_pieces(const std::vector<SurfacePiece<dim>> &facets,
               const double                          no_area,
               std::vector<SurfacePiece<dim>>       &pieces)
    {
      Tensor<1, dim> sum, largest;
      double         measure = 0;
      for (const auto &facet : facets)
        {
          sum += facet.area;
          measure += facet.area.norm();
          if (facet.area.norm() > largest.norm())
            largest = facet.area;
        }
      const bool has_two_sides = sum.norm() < measure / 2;

      for (const bool is_other_side : {false, true})
        {
          SurfacePiece<dim> piece;
          double            weight = 0;
          for (const auto &[position, area] : facets)
            if ((has_two_sides && area * largest < 0) == is_other_side)
              {
                piece.area += area;
                piece.position += area.norm() * position;
                weight += area.norm();
              }
          if (piece.area.norm() > no_area)
            {
              piece.position /= weight;
              pieces.push_back(piece);
            }
        }
    }
  } // namespace

  template <int dim>
  std::vector<SurfacePiece<dim>>
  surface_in_box(const Shape<dim>     &shape,
                 const Point<dim>     &lower,
                 const Tensor<1, dim> &extents,
                 const Numbers<dim>   &divisions)
  {
    Numbers<dim>   sizes    = divisions;
    unsigned int   n_places = 1, n_parts = 1;
    double         part = 1;
    Tensor<1, dim> margin;
    for (unsigned int d = 0; d < dim; ++d)
      {
        n_parts *= divisions[d];
        n_places *= ++sizes[d];
        part *= extents[d] / divisions[d];
        margin[d] = 1e-10 * extents[d] / divisions[d];
      }
    const double no_area = 1e-9 * std::pow(part, (dim - 1.) / dim);

    std::vector<Corner<dim>> corners(n_places);
    for (unsigned int i = 0; i < n_places; ++i)
      {
        const auto numbers = unpack<dim>(i, sizes);
        for (unsigned int d = 0; d < dim; ++d)
          corners[i].place[d] =
            lower[d] + extents[d] * numbers[d] / divisions[d];
        corners[i].is_inside = contains_nearly(shape, corners[i].place, margin);
      }

    std::vector<SurfacePiece<dim>> pieces, facets;
    for (unsigned int i = 0; i < n_parts; ++i)
      {
        // Kuhn's simplices: the ways along the edges of the part, from its
        // lower to its upper corner.
        facets.clear();
        Numbers<dim> order;
        std::iota(order.begin(), order.end(), 0);
        do
          {
            auto numbers = unpack<dim>(i, divisions);
            std::array<Corner<dim>, dim + 1> simplex;
            for (unsigned int c = 0; c <= dim; ++c)
              {
                simplex[c] = corners[pack<dim>(numbers, sizes)];
                if (c < dim)
                  ++numbers[order[c]];
              }
            add_facets<dim>(shape, margin, simplex, facets);
          }
        while (std::next_permutation(order.begin(), order.end()));
        add_pieces(facets, no_area, pieces);
      }
    return pieces;
  }

  template std::vector<SurfacePiece<2>>
  surface_in_box<2>(const Shape<2> &,
                    const Point<2> &,
                    const Tensor<1, 2> &,
                    const std::array<unsigned int, 2> &);
  template std::vector<SurfacePiece<3>>
  surface_in_box<3>(const Shape<3> &,
                    const Point<3> &,
                    const Tensor<1, 3> &,
                    const std::array<unsigned int, 3> &);
} // namespace impm
