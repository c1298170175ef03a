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

  namespace
  {
    /** Lists are filled up with zeros. */
    constexpr unsigned int
    filled_up(const unsigned int n)
    {
      return (n + n_lanes - 1) / n_lanes * n_lanes;
    }
  } // namespace

  template <int dim>
  void
  InternalForces<dim>::place_on_patch(const unsigned int point,
                                      const unsigned int n) const
  {
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    slopes.assign(dim * n, 0.);
    hoops.assign(axisymmetric ? n : 0, 0.);
    for (unsigned int k = prints.first[point]; k < prints.first[point + 1]; ++k)
      {
        const unsigned int  e        = prints.entries[k];
        const unsigned int *place    = &prints.place[e * n_nodes];
        const double       *gradient = prints.gradient(e);
        for (unsigned int v = 0; v < n_nodes; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            slopes[n * d + place[v]] += gradient[dim * v + d];
        for (unsigned int v = 0; axisymmetric && v < n_nodes; ++v)
          hoops[place[v]] += prints.value(e)[v] * prints.inverse_radius[point];
      }
  }

  template <int dim>
  void
  InternalForces<dim>::add_point(const unsigned int point,
                                 const unsigned int n) const
  {
    constexpr unsigned int n_values = Kinematics<dim>::max_size;
    constexpr unsigned int n_list   = filled_up(n_values);
    // columns of A, one per value of a gradient
    std::array<std::array<double, n_list>, n_values> A{};
    for (unsigned int a = 0; a < n_gradients; ++a)
      for (unsigned int b = 0; b < n_gradients; ++b)
        A[b][a] = response.tangent(point, a, b);

    double *sum = sums.data();
    for (unsigned int m = 0; m < n; ++m, sum += dim * dim * n)
      {
        bool touches = axisymmetric && hoops[m] != 0;
        for (unsigned int d = 0; d < dim; ++d)
          touches = touches || slopes[n * d + m] != 0;
        for (unsigned int c = 0; c < dim && touches; ++c)
          {
            std::array<double, n_list> AB; // a column of it
            for (unsigned int a = 0; a < n_list; a += n_lanes)
              {
                Lanes part = slopes[m] * load_lanes(&A[dim * c][a]);
                for (unsigned int d = 1; d < dim; ++d)
                  part += slopes[n * d + m] * load_lanes(&A[dim * c + d][a]);
                if (axisymmetric && c == 0)
                  part += hoops[m] * load_lanes(&A[dim * dim][a]);
                part.copy_to(&AB[a], stdx::element_aligned);
              }
            for (unsigned int b = 0; b < dim; ++b)
              for (unsigned int l = 0; l < n; l += n_lanes)
                {
                  double *place = sum + (c * dim + b) * n + l;
                  Lanes   part  = load_lanes(place);
                  for (unsigned int d = 0; d < dim; ++d)
                    part += AB[dim * b + d] * load_lanes(&slopes[n * d + l]);
                  if (axisymmetric && b == 0)
                    part += AB[dim * dim] * load_lanes(&hoops[l]);
                  part.copy_to(place, stdx::element_aligned);
                }
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
    // F-bar: nodal forces of the mean dilation and of what it does; `answer`
    // and `dilation` take increments, the others give forces.
    const unsigned int     n        = matrix.m();
    const unsigned int     n_filled = filled_up(n / dim);
    dealii::Vector<double> dilation(n), answer(n), dilating(n), answering(n);
    const auto add = [&](const double *list, dealii::Vector<double> &forces) {
      for (unsigned int l = 0; l < n / dim; ++l)
        {
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              forces[dim * l + c] +=
                list[dim * c + d] * slopes[n_filled * d + l];
          if (axisymmetric)
            forces[dim * l] += list[dim * dim] * hoops[l];
        }
    };
    const bool is_skew = !average.left_coupling.empty();
    for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
      {
        const unsigned int p = prints.patch_points[i];
        const double      *m = &average.mean[p * n_gradients];
        const double      *b = &average.coupling[p * n_gradients];
        place_on_patch(p, n_filled);
        add(m, dilation);
        add(average.left_of(p), answer);
        if (response.acts_in_the_middle)
          {
            add(response.turn(p, m).data(), dilating);
            add(response.turn(p, b).data(), answering);
          }
        else if (is_skew)
          add(b, answering);
      }
    if (!response.acts_in_the_middle)
      {
        dilating = dilation;
        if (!is_skew)
          answering = answer;
      }
    const double square = average.group_square[average.groups[first]];
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        matrix(i, j) += answering[i] * dilation[j] + dilating[i] * answer[j] +
                        square * dilating[i] * dilation[j];
  }

  template <int dim>
  void
  InternalForces<dim>::patch_matrix(const Patch        &patch,
                                    FullMatrix<double> &matrix) const
  {
    const unsigned int n        = patch.end_nodes - patch.begin_nodes;
    const unsigned int n_filled = filled_up(n);
    sums.assign(dim * dim * n_filled * n_filled, 0.);
    for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
      {
        const unsigned int p = prints.patch_points[i];
        place_on_patch(p, n_filled);
        add_point(p, n_filled);
      }
    matrix.reinit(dim * n, dim * n, true);
    const double *sum = sums.data();
    for (unsigned int j = 0; j < dim * n; ++j)
      for (unsigned int b = 0; b < dim; ++b, sum += n_filled)
        for (unsigned int l = 0; l < n; ++l)
          matrix(dim * l + b, j) = sum[l];
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
