#include <deal.II/base/symmetric_tensor.h>

#include <impm/points/point_domains.h>
#include <impm/points/point_shape.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  Tensor<1, dim>
  PointShape<dim>::edge(const unsigned int axis) const
  {
    return domain_edge<dim>(deformation, domain[axis], axis);
  }

  template <int dim>
  Tensor<1, dim>
  PointShape<dim>::second_moments() const
  {
    Tensor<1, dim> moments;
    for (unsigned int axis = 0; axis < dim; ++axis)
      {
        const auto along = edge(axis);
        for (unsigned int d = 0; d < dim; ++d)
          moments[d] += along[d] * along[d] / 12;
      }
    return moments;
  }

  namespace
  {
    /** Sums and means of two points, with no shape yet. */
    template <int dim>
    PointShape<dim>
    add_up(const PointShape<dim> &first, const PointShape<dim> &second)
    {
      PointShape<dim> both;
      both.volume          = first.volume + second.volume;
      both.present_measure = first.present_measure + second.present_measure;
      both.place           = first.place +
                   second.volume / both.volume * (second.place - first.place);
      return both;
    }

    /**
     * Scales the edges of a box to a measure, so that none becomes longer than
     * the most that it may: what that takes from it, the others get.
     */
    template <int dim>
    Tensor<1, dim>
    scale_box(Tensor<1, dim>        edges,
              const double          measure,
              const Tensor<1, dim> &most)
    {
      std::array<bool, dim> is_longest{};
      for (bool again = true; again;)
        {
          double       ratio  = measure;
          unsigned int n_free = 0;
          for (unsigned int d = 0; d < dim; ++d)
            {
              ratio /= edges[d];
              n_free += !is_longest[d];
            }
          again = false;
          for (unsigned int d = 0; d < dim; ++d)
            if (!is_longest[d])
              {
                edges[d] *= std::pow(ratio, 1. / n_free);
                if (edges[d] > most[d])
                  {
                    edges[d]      = most[d];
                    is_longest[d] = again = true;
                  }
              }
        }
      return edges;
    }
  } // namespace

  template <int dim>
  std::optional<PointShape<dim>>
  merge_along(const unsigned int     axis,
              const PointShape<dim> &first,
              const PointShape<dim> &second,
              const MergeRoom<dim>  &room)
  {
    const auto edge = 0.5 * (first.edge(axis) + second.edge(axis));
    // Well below the length at which points are split.
    if (span<dim>(2 * edge, room.cell) > 0.8 / room.points_across)
      return {};
    auto gap = second.place - first.place;
    gap -= (gap * edge < 0 ? -1 : 1) * edge;
    for (unsigned int d = 0; d < dim; ++d)
      {
        double extent = 0;
        for (unsigned int a = 0; a < dim; ++a)
          extent = std::max(extent, std::abs(first.edge(a)[d]));
        if (std::abs(gap[d]) > 0.25 * extent)
          return {};
        if (d != axis && std::abs(first.domain[d] - second.domain[d]) >
                           0.1 * first.domain[d])
          return {};
      }
    auto         both = add_up(first, second);
    const double part = second.volume / both.volume;
    both.domain       = first.domain + part * (second.domain - first.domain);
    both.domain[axis] = first.domain[axis] + second.domain[axis];
    // The mean of F has less volume.
    both.deformation =
      first.deformation + part * (second.deformation - first.deformation);
    const double J = (1 - part) * determinant(first.deformation) +
                     part * determinant(second.deformation);
    const double scale = std::pow(J / determinant(both.deformation), 1. / dim);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        both.deformation[i][j] *= scale;
    return both;
  }

  template <int dim>
  std::optional<PointShape<dim>>
  merge_to_box(const PointShape<dim> &first,
               const PointShape<dim> &second,
               const MergeRoom<dim>  &room,
               const bool             compact)
  {
    auto         both = add_up(first, second);
    const double part = second.present_measure / both.present_measure;
    const auto   gap  = second.place - first.place;
    const auto   one = first.second_moments(), other = second.second_moments();
    // Seeds of a full cell stay as they are; boxes are shorter than what
    // splits.
    const auto     most   = 1.05 / room.points_across * room.cell;
    double         wished = 1, box = 1;
    Tensor<1, dim> edges;
    for (unsigned int d = 0; d < dim; ++d)
      {
        edges[d] = std::sqrt(12 * ((1 - part) * one[d] + part * other[d] +
                                   part * (1 - part) * gap[d] * gap[d]));
        box *= edges[d];
        wished *= room.cell[d] / room.points_across;
      }
    if (both.present_measure > 1.1 * wished ||
        (compact && both.present_measure < 0.7 * box))
      return {};

    // Volumes add up and, where thickness is one thing more, areas do.
    double volume = 0, area = 0;
    for (const auto *shape : {&first, &second})
      {
        const double present = shape->volume * determinant(shape->deformation);
        volume += present;
        area += present / shape->deformation[2][2];
      }
    both.deformation = unit_symmetric_tensor<3>();
    if (dim == 2)
      both.deformation[2][2] = volume / area;
    const double stretch =
      std::pow(volume / both.volume / both.deformation[2][2], 1. / dim);
    for (unsigned int d = 0; d < dim; ++d)
      both.deformation[d][d] = stretch;
    both.domain = scale_box(edges, both.present_measure, most) / stretch;
    return both;
  }

  template struct PointShape<2>;
  template struct PointShape<3>;
  template std::optional<PointShape<2>>
  merge_along(unsigned int,
              const PointShape<2> &,
              const PointShape<2> &,
              const MergeRoom<2> &);
  template std::optional<PointShape<3>>
  merge_along(unsigned int,
              const PointShape<3> &,
              const PointShape<3> &,
              const MergeRoom<3> &);
  template std::optional<PointShape<2>>
  merge_to_box(const PointShape<2> &,
               const PointShape<2> &,
               const MergeRoom<2> &,
               bool);
  template std::optional<PointShape<3>>
  merge_to_box(const PointShape<3> &,
               const PointShape<3> &,
               const MergeRoom<3> &,
               bool);
} // namespace impm
