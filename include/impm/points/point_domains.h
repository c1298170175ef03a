#ifndef impm_points_point_domains_h
#define impm_points_point_domains_h

#include <impm/points/point_fields.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace impm
{
  template <int dim>
  dealii::Tensor<1, dim>
  extents_of(
    const typename dealii::Triangulation<dim>::active_cell_iterator &cell)
  {
    dealii::Tensor<1, dim> extents;
    for (unsigned int d = 0; d < dim; ++d)
      extents[d] = cell_extent(cell, d);
    return extents;
  }

  /** Largest part of a cell that an edge spans along an axis. */
  template <int dim>
  double
  span(const dealii::Tensor<1, dim> &edge, const dealii::Tensor<1, dim> &cell)
  {
    double largest = 0;
    for (unsigned int d = 0; d < dim; ++d)
      largest = std::max(largest, std::abs(edge[d]) / cell[d]);
    return largest;
  }

  /** What F makes of an edge of the initial box (m). */
  template <int dim>
  dealii::Tensor<1, dim>
  domain_edge(const dealii::Tensor<2, 3> &F,
              const double                length,
              const unsigned int          axis)
  {
    dealii::Tensor<1, dim> edge;
    for (unsigned int d = 0; d < dim; ++d)
      edge[d] = F[d][axis] * length;
    return edge;
  }

  /** Half the edges (m) of the box of a point, along the axes of the grid;
   * the layout has those at the start at an offset. */
  template <int dim>
  dealii::Tensor<1, dim>
  half_extents(const MaterialPoints<dim> &points,
               const unsigned int         p,
               const unsigned int         offset_domain,
               const bool                 stretched)
  {
    dealii::Tensor<1, dim> half = 0.5 * points.vector(p, offset_domain);
    if (!stretched)
      return half;
    // The diagonal of U, which a rotation leaves alone.
    const auto F =
      points.layout.load_tensor(points.fields(p) + points.offset_deformation);
    dealii::SymmetricTensor<2, dim> C;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = i; j < dim; ++j)
        for (unsigned int k = 0; k < dim; ++k)
          C[i][j] += F[k][i] * F[k][j];
    // Of numbers next to nothing deal.II finds no vectors.
    const double nothing = 1e-30 * trace(C);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = i + 1; j < dim; ++j)
        if (std::abs(C[i][j]) < nothing)
          C[i][j] = 0;
    dealii::Tensor<1, dim> stretch;
    for (const auto &[square, axis] : eigenvectors(C))
      for (unsigned int d = 0; d < dim; ++d)
        stretch[d] += std::sqrt(std::max(square, 0.)) * axis[d] * axis[d];
    for (unsigned int d = 0; d < dim; ++d)
      half[d] *= stretch[d];
    return half;
  }

  /** Fields of a point by what splitting and merging do to them. */
  template <int dim>
  class PointDomains
  {
  public:
    explicit PointDomains(const MaterialPoints<dim> &points)
      : layout(points.layout)
      , deformation(points.offset_deformation)
      , domain(layout.offset("initial_domain"))
      , parent(layout.find("parent").value_or(0))
    {
      for (const auto &field : layout.fields())
        if (field.name == "initial_volume" ||
            field.name.rfind("traction_area_", 0) == 0)
          shared.push_back(field.offset);
        else if (field.name != "body" && field.name != "parent" &&
                 field.name != "initial_domain")
          for (unsigned int i = 0; i < field.n_components; ++i)
            common.push_back(field.offset + i);
    }

    /** Of the parallelogram of a point, along an axis of the start. */
    dealii::Tensor<1, dim>
    edge(const double *fields, const unsigned int axis) const
    {
      return domain_edge<dim>(layout.load_tensor(fields + deformation),
                              fields[domain + axis],
                              axis);
    }

    const PointLayout &layout;
    /** `parent` is 0 where no points split. */
    const unsigned int        deformation, domain, parent;
    std::vector<unsigned int> shared; ///< parts add up to the whole
    std::vector<unsigned int> common; ///< the same in all parts
  };

  /** 2 x kinetic energy over mass. */
  template <int dim>
  double
  square_of_velocity(const MaterialPoints<dim> &points, const double *fields)
  {
    double sum = 0;
    if (points.offset_velocity > 0)
      for (unsigned int d = 0; d < dim; ++d)
        sum += fields[points.offset_velocity + d] *
               fields[points.offset_velocity + d];
    return sum;
  }
} // namespace impm

#endif
