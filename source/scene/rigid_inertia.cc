#include <impm/scene/part_of_box.h>
#include <impm/scene/rigid_inertia.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Sums of volume, first and second moments. */
    template <int dim>
    struct BodyMoments
    {
      /** Of a box, or of what has its second moments, times a share. */
      void
      add(const Point<dim>     &middle,
          const Tensor<1, dim> &extents,
          const double          share,
          const bool            is_axisymmetric)
      {
        double part =
          share * (is_axisymmetric ? 2 * numbers::PI * middle[0] : 1.);
        for (unsigned int d = 0; d < dim; ++d)
          part *= extents[d];
        volume += part;
        first += part * middle;
        for (unsigned int c = 0; c < dim; ++c)
          {
            for (unsigned int d = 0; d < dim; ++d)
              second[c][d] += part * middle[c] * middle[d];
            second[c][c] += part * extents[c] * extents[c] / 12;
          }
      }

      double         volume = 0;
      Tensor<1, dim> first;
      Tensor<2, 3>   second;
    };

    /** Boxes that the surface cuts are halved in all directions, and its part
     * is found in the last ones. */
    template <int dim>
    void
    add_box(const Shape<dim>       &shape,
            const BoundingBox<dim> &box,
            const bool              is_axisymmetric,
            const unsigned int      depth,
            BodyMoments<dim>       &moments)
    {
      // The distance of implicit functions is worth something near the surface.
      const unsigned int first = 3, last = dim == 2 ? 8 : 5;
      const auto         middle   = box.center();
      const auto         diagonal = box.vertex((1u << dim) - 1) - box.vertex(0);
      if (depth >= first || shape.is_box)
        {
          const double distance = shape.proximity(middle).distance;
          if (distance > 0.5 * diagonal.norm())
            return;
          if (distance < -0.5 * diagonal.norm() || shape.is_box)
            {
              moments.add(middle, diagonal, 1, is_axisymmetric);
              return;
            }
        }
      if (depth == last)
        {
          const auto part = find_part<dim>(shape.contains, box);
          double     rest = part.share; // beside what the extents have
          for (unsigned int d = 0; d < dim; ++d)
            rest *= part.share > 0 ? diagonal[d] / part.extents[d] : 0.;
          if (part.share > 0)
            moments.add(part.centroid, part.extents, rest, is_axisymmetric);
          return;
        }
      for (unsigned int v = 0; v < (1u << dim); ++v)
        {
          Point<dim> lower = box.vertex(0);
          for (unsigned int d = 0; d < dim; ++d)
            lower[d] += (v >> d) % 2 * 0.5 * diagonal[d];
          add_box(shape,
                  BoundingBox<dim>({lower, lower + 0.5 * diagonal}),
                  is_axisymmetric,
                  depth + 1,
                  moments);
        }
    }
  } // namespace

  template <int dim>
  RigidInertia<dim>
  inertia_of_shape(const Shape<dim> &shape,
                   const double      density,
                   const bool        is_axisymmetric)
  {
    BodyMoments<dim> moments;
    add_box(shape, *shape.bounding_box, is_axisymmetric, 0, moments);
    RigidInertia<dim> inertia;
    inertia.mass   = density * moments.volume;
    inertia.centre = Point<dim>(moments.first / moments.volume);
    if (is_axisymmetric)
      inertia.centre[0] = 0;
    auto &about_centre = moments.second;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int d = 0; d < dim; ++d)
        about_centre[c][d] -=
          moments.volume * inertia.centre[c] * inertia.centre[d];
    inertia.tensor = -density * about_centre;
    for (unsigned int d = 0; d < 3; ++d)
      inertia.tensor[d][d] += density * trace(about_centre);
    return inertia;
  }

  template RigidInertia<2>
  inertia_of_shape(const Shape<2> &, double, bool);
  template RigidInertia<3>
  inertia_of_shape(const Shape<3> &, double, bool);
} // namespace impm
