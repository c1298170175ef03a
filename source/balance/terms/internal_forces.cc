#include <impm/balance/terms/internal_forces.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  template <int dim>
  std::vector<double>
  InternalForces<dim>::squares_of_parts(const Vector &,
                                        const ResidualNorm &norm) const
  {
    // Stresses become forces by slopes of at most one over the smallest cell.
    auto squares = response.squares_of_stresses(norm);
    for (double &square : squares)
      square /= extent * extent;
    return squares;
  }

  template <int dim>
  void
  InternalForces<dim>::apply(const Vector &direction, Vector &image) const
  {
    gradient_changes.resize(response.gradients.size());
    stress_changes.resize(response.gradients.size());
    gradients_at_points(direction, gradient_changes);
    response.apply_tangent(gradient_changes, stress_changes);
    add_forces_of(stress_changes, image);
  }

  template <int dim>
  void
  InternalForces<dim>::gradients_at_points(const Vector        &u,
                                           std::vector<double> &gradients) const
  {
    std::fill(gradients.begin(), gradients.end(), 0.);
    for (const auto &cell : prints.cells)
      {
        std::array<double, Footprints<dim>::n_nodes * dim> local;
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            local[dim * n + c] = u.local_element(dim * cell.nodes[n] + c);
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            const unsigned int p        = prints.point[e];
            const double      *slope    = prints.gradient(e);
            double            *gradient = &gradients[p * n_gradients];
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  gradient[dim * c + d] +=
                    local[dim * n + c] * slope[dim * n + d];
            if (axisymmetric)
              for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
                gradient[dim * dim] += local[dim * n] * prints.value(e)[n] *
                                       prints.inverse_radius[p];
          }
      }
  }

  template <int dim>
  void
  InternalForces<dim>::add_forces_of(const std::vector<double> &stresses,
                                     Vector                    &force) const
  {
    for (const auto &cell : prints.cells)
      {
        std::array<double, Footprints<dim>::n_nodes * dim> local{};
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            const unsigned int p     = prints.point[e];
            const double      *slope = prints.gradient(e);
            const double      *P     = &stresses[p * n_gradients];
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  local[dim * n + c] += P[dim * c + d] * slope[dim * n + d];
            if (axisymmetric)
              for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
                local[dim * n] +=
                  P[dim * dim] * prints.value(e)[n] * prints.inverse_radius[p];
          }
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            force.local_element(dim * cell.nodes[n] + c) += local[dim * n + c];
      }
  }

  template <int dim>
  void
  InternalForces<dim>::place_on_patch(const unsigned int point) const
  {
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    std::fill(slopes.begin(), slopes.end(), 0.);
    std::fill(shares.begin(), shares.end(), 0.);
    touched.clear();
    for (unsigned int k = prints.first[point]; k < prints.first[point + 1]; ++k)
      for (unsigned int v = 0; v < n_nodes; ++v)
        {
          const unsigned int e = prints.entries[k];
          const unsigned int m = prints.place[e * n_nodes + v];
          if (std::find(touched.begin(), touched.end(), m) == touched.end())
            touched.push_back(m);
          shares[m] += prints.value(e)[v];
          for (unsigned int d = 0; d < dim; ++d)
            slopes[dim * m + d] += prints.gradient(e)[dim * v + d];
        }
  }

  template <int dim>
  template <typename Size, typename Places>
  void
  InternalForces<dim>::add_point(const unsigned int  point,
                                 const Size          n_point_nodes,
                                 const Places       &places,
                                 const double       *slope,
                                 const double       *share,
                                 FullMatrix<double> &matrix) const
  {
    const double *A = response.tangent(point);
    const double  inverse_radius =
      axisymmetric ? prints.inverse_radius[point] : 0.;
    // rows of A B: one per value of a gradient, one column per unknown
    for (unsigned int m = 0; m < n_point_nodes; ++m)
      for (unsigned int c = 0; c < dim; ++c)
        {
          typename Kinematics<dim>::List AB;
          for (unsigned int a = 0; a < n_gradients; ++a)
            {
              double sum = 0;
              for (unsigned int d = 0; d < dim; ++d)
                sum += A[a * n_gradients + dim * c + d] * slope[dim * m + d];
              if (axisymmetric && c == 0)
                sum +=
                  A[a * n_gradients + dim * dim] * share[m] * inverse_radius;
              AB[a] = sum;
            }
          for (unsigned int l = 0; l < n_point_nodes; ++l)
            for (unsigned int b = 0; b < dim; ++b)
              {
                double sum = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  sum += slope[dim * l + d] * AB[dim * b + d];
                if (axisymmetric && b == 0)
                  sum += share[l] * inverse_radius * AB[dim * dim];
                matrix(dim * places[l] + b, dim * places[m] + c) += sum;
              }
        }
  }

  template <int dim>
  void
  InternalForces<dim>::add_coupling(const Patch        &patch,
                                    FullMatrix<double> &matrix) const
  {
    const auto        &average = response.average;
    const unsigned int first   = prints.patch_points[patch.begin_points];
    if (!average.includes(first))
      return;
    // F-bar: nodal forces of the mean dilation and of what it does.
    const unsigned int     n = matrix.m();
    dealii::Vector<double> dilation(n), answer(n);
    for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
      {
        const unsigned int p = prints.patch_points[i];
        const double      *m = &average.mean[p * n_gradients];
        const double      *b = &average.coupling[p * n_gradients];
        place_on_patch(p);
        for (unsigned int l = 0; l < shares.size(); ++l)
          {
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int d = 0; d < dim; ++d)
                {
                  dilation[dim * l + c] += m[dim * c + d] * slopes[dim * l + d];
                  answer[dim * l + c] += b[dim * c + d] * slopes[dim * l + d];
                }
            if (axisymmetric)
              {
                const double share = shares[l] * prints.inverse_radius[p];
                dilation[dim * l] += m[dim * dim] * share;
                answer[dim * l] += b[dim * dim] * share;
              }
          }
      }
    const double square = average.group_square[average.groups[first]];
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        matrix(i, j) += answer[i] * dilation[j] + dilation[i] * answer[j] +
                        square * dilation[i] * dilation[j];
  }

  template <int dim>
  void
  InternalForces<dim>::patch_matrix(const Patch        &patch,
                                    FullMatrix<double> &matrix) const
  {
    const unsigned int n = patch.end_nodes - patch.begin_nodes;
    matrix.reinit(dim * n, dim * n);
    slopes.resize(dim * n);
    shares.resize(n);
    // The most frequent number of nodes deserves loops that unroll.
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    const std::integral_constant<unsigned int, n_nodes> n_of_a_cell;
    for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
      {
        const unsigned int p     = prints.patch_points[i];
        const unsigned int begin = prints.first[p];
        if (prints.first[p + 1] == begin + 1)
          {
            const unsigned int e = prints.entries[begin];
            add_point(p,
                      n_of_a_cell,
                      &prints.place[e * n_nodes],
                      prints.gradient(e),
                      prints.value(e),
                      matrix);
            continue;
          }
        place_on_patch(p);
        point_slopes.clear();
        point_shares.clear();
        for (const unsigned int m : touched)
          {
            point_shares.push_back(shares[m]);
            for (unsigned int d = 0; d < dim; ++d)
              point_slopes.push_back(slopes[dim * m + d]);
          }
        add_point(p,
                  static_cast<unsigned int>(touched.size()),
                  touched.data(),
                  point_slopes.data(),
                  point_shares.data(),
                  matrix);
      }
    add_coupling(patch, matrix);
  }

  template <int dim>
  void
  InternalForces<dim>::add_matrix(const bool       only_pattern,
                                  const TakeBlock &take) const
  {
    FullMatrix<double> block;
    for (const auto &patch : prints.patches)
      {
        if (!only_pattern)
          patch_matrix(patch, block);
        take(make_array_view(prints.patch_nodes.begin() + patch.begin_nodes,
                             prints.patch_nodes.begin() + patch.end_nodes),
             block);
      }
  }

  template class InternalForces<2>;
  template class InternalForces<3>;
} // namespace impm
