// The tangent of MomentumBalance: as an operator, its diagonal, its matrix.

#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <impm/balance/momentum_balance.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  MomentumBalance<dim>::apply_tangent(Vector       &dst,
                                      const Vector &strain_src,
                                      const Vector &src) const
  {
    ++n_operator_applications;
    gradients_at_points(strain_src, gradient_increments);
    response.apply_tangent(gradient_increments, stress_increments);
    dst = 0;
    add_point_forces(stress_increments, dst);
    ghost.add_force(strain_src, 1., dst);
    dst.compress(VectorOperation::add);
    constraints.condense_hanging(dst);
    const double force = integrator.force_factor();
    for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
      dst.local_element(i) = force * dst.local_element(i) +
                             diagonal_stiffness(i) * src.local_element(i);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult(Vector &dst, const Vector &src) const
  {
    work = src;
    constraints.set_zero(work);
    constraints.interpolate_hanging(work);
    if (smoothing)
      smoothing->apply_derivative(work, smooth);
    apply_tangent(dst, smoothing ? smooth : work, work);
    for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        dst.local_element(i) = src.local_element(i);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult_lift(Vector &dst, const Vector &src) const
  {
    work = src;
    constraints.interpolate_hanging(work);
    if (smoothing)
      smoothing->apply_derivative(work, smooth);
    apply_tangent(dst, smoothing ? smooth : work, work);
    constraints.set_zero(dst);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult_by_matrix(
    const TrilinosWrappers::SparseMatrix &matrix,
    Vector                               &dst,
    const Vector                         &src) const
  {
    ++n_operator_applications;
    matrix.vmult(dst, src);
  }

  template <int dim>
  template <typename Size>
  void
  MomentumBalance<dim>::add_points(const Patch        &patch,
                                   const Size          n_patch_nodes,
                                   FullMatrix<double> &matrix) const
  {
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
      {
        const unsigned int p     = prints.patch_points[i];
        const unsigned int begin = prints.first[p], end = prints.first[p + 1];
        const double      *A     = response.tangent(p);
        const double      *slope = slopes.data();
        const double      *share = shares.data();
        const double       inverse_radius =
          axisymmetric ? prints.inverse_radius[p] : 0.;
        if (end == begin + 1 && n_patch_nodes == n_nodes)
          {
            slope = prints.gradient(prints.entries[begin]);
            share = prints.value(prints.entries[begin]);
          }
        else
          {
            std::fill(slopes.begin(), slopes.end(), 0.);
            std::fill(shares.begin(), shares.end(), 0.);
            for (unsigned int k = begin; k < end; ++k)
              for (unsigned int v = 0; v < n_nodes; ++v)
                {
                  const unsigned int e = prints.entries[k];
                  const unsigned int m = prints.place[e * n_nodes + v];
                  shares[m] += prints.value(e)[v];
                  for (unsigned int d = 0; d < dim; ++d)
                    slopes[dim * m + d] += prints.gradient(e)[dim * v + d];
                }
          }
        // rows of A B: one per value of a gradient, one column per unknown
        for (unsigned int m = 0; m < n_patch_nodes; ++m)
          for (unsigned int c = 0; c < dim; ++c)
            {
              typename Kinematics<dim>::List AB;
              for (unsigned int a = 0; a < n_gradients; ++a)
                {
                  double sum = 0;
                  for (unsigned int d = 0; d < dim; ++d)
                    sum +=
                      A[a * n_gradients + dim * c + d] * slope[dim * m + d];
                  if (axisymmetric && c == 0)
                    sum += A[a * n_gradients + dim * dim] * share[m] *
                           inverse_radius;
                  AB[a] = sum;
                }
              for (unsigned int l = 0; l < n_patch_nodes; ++l)
                for (unsigned int b = 0; b < dim; ++b)
                  {
                    double sum = 0;
                    for (unsigned int d = 0; d < dim; ++d)
                      sum += slope[dim * l + d] * AB[dim * b + d];
                    if (axisymmetric && b == 0)
                      sum += share[l] * inverse_radius * AB[dim * dim];
                    matrix(dim * l + b, dim * m + c) += sum;
                  }
            }
      }
  }

  template <int dim>
  void
  MomentumBalance<dim>::add_coupling(const Patch        &patch,
                                     FullMatrix<double> &matrix) const
  {
    const auto        &average = response.average;
    const unsigned int first   = prints.patch_points[patch.begin_points];
    if (!average.includes(first))
      return;
    // F-bar: nodal forces of the mean dilation and of what it does.
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    const unsigned int     n       = matrix.m();
    dealii::Vector<double> dilation(n), answer(n);
    for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
      {
        const unsigned int p = prints.patch_points[i];
        const double      *m = &average.mean[p * n_gradients];
        const double      *b = &average.coupling[p * n_gradients];
        for (unsigned int k = prints.first[p]; k < prints.first[p + 1]; ++k)
          for (unsigned int v = 0; v < n_nodes; ++v)
            {
              const unsigned int e     = prints.entries[k];
              const unsigned int l     = prints.place[e * n_nodes + v];
              const double      *slope = prints.gradient(e) + dim * v;
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    dilation[dim * l + c] += m[dim * c + d] * slope[d];
                    answer[dim * l + c] += b[dim * c + d] * slope[d];
                  }
              if (axisymmetric)
                {
                  const double share =
                    prints.value(e)[v] * prints.inverse_radius[p];
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
  MomentumBalance<dim>::patch_matrix(const Patch        &patch,
                                     FullMatrix<double> &matrix) const
  {
    const unsigned int n = patch.end_nodes - patch.begin_nodes;
    matrix.reinit(dim * n, dim * n);
    slopes.resize(dim * n);
    shares.resize(n);
    // The most frequent number of nodes deserves loops that unroll.
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    if (n == n_nodes)
      add_points(patch,
                 std::integral_constant<unsigned int, n_nodes>(),
                 matrix);
    else
      add_points(patch, n, matrix);
    add_coupling(patch, matrix);
  }

  template <int dim>
  void
  MomentumBalance<dim>::diagonal(Vector &diagonal) const
  {
    FullMatrix<double> local;
    diagonal = 0;
    for (const auto &patch : prints.patches)
      {
        patch_matrix(patch, local);
        for (unsigned int n = patch.begin_nodes; n < patch.end_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            {
              const unsigned int i = dim * (n - patch.begin_nodes) + c;
              diagonal.local_element(dim * prints.patch_nodes[n] + c) +=
                local(i, i);
            }
      }
    for (const auto &face : ghost.faces)
      for (unsigned int a = 0; a < face.n_nodes; ++a)
        for (unsigned int c = 0; c < dim; ++c)
          diagonal.local_element(dim * face.nodes[a] + c) += face.matrix[a][a];
    diagonal.compress(VectorOperation::add);
    constraints.condense_hanging(diagonal);
    diagonal *= integrator.force_factor();
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        diagonal.local_element(i) = 1;
      else
        diagonal.local_element(i) += diagonal_stiffness(i);
  }

  template <int dim>
  std::vector<types::global_dof_index>
  MomentumBalance<dim>::dofs_of_nodes(const unsigned int *begin,
                                      const unsigned int *end) const
  {
    std::vector<types::global_dof_index> dofs;
    for (; begin != end; ++begin)
      for (unsigned int c = 0; c < dim; ++c)
        dofs.push_back(
          mass.get_partitioner()->local_to_global(dim * *begin + c));
    return dofs;
  }

  template <int dim>
  void
  MomentumBalance<dim>::initialize_matrix(
    TrilinosWrappers::SparseMatrix &matrix) const
  {
    const IndexSet &owned = grid.dof_handler.locally_owned_dofs();
    TrilinosWrappers::SparsityPattern sparsity(owned,
                                               owned,
                                               grid.locally_relevant_dofs,
                                               grid.communicator);
    const auto add = [&](const unsigned int *begin, const unsigned int *end) {
      constraints.constraints.add_entries_local_to_global(dofs_of_nodes(begin,
                                                                        end),
                                                          sparsity);
    };
    for (const auto &patch : prints.patches)
      add(prints.patch_nodes.data() + patch.begin_nodes,
          prints.patch_nodes.data() + patch.end_nodes);
    for (const auto &face : ghost.faces)
      add(face.nodes.data(), face.nodes.data() + face.n_nodes);
    for (const auto dof : owned)
      sparsity.add(dof, dof);
    sparsity.compress();
    (smoothing ? stiffness : matrix).reinit(sparsity);
    if (smoothing)
      smoothing->assemble();
  }

  template <int dim>
  void
  MomentumBalance<dim>::assemble_stiffness(
    TrilinosWrappers::SparseMatrix &matrix) const
  {
    FullMatrix<double> local;
    matrix         = 0;
    const auto add = [&](const unsigned int *begin, const unsigned int *end) {
      local *= integrator.force_factor();
      constraints.constraints.distribute_local_to_global(
        local, dofs_of_nodes(begin, end), matrix);
    };
    for (const auto &patch : prints.patches)
      {
        patch_matrix(patch, local);
        add(prints.patch_nodes.data() + patch.begin_nodes,
            prints.patch_nodes.data() + patch.end_nodes);
      }
    for (const auto &face : ghost.faces)
      {
        local.reinit(dim * face.n_nodes, dim * face.n_nodes);
        for (unsigned int a = 0; a < face.n_nodes; ++a)
          for (unsigned int b = 0; b < face.n_nodes; ++b)
            for (unsigned int c = 0; c < dim; ++c)
              local(dim * a + c, dim * b + c) = face.matrix[a][b];
        add(face.nodes.data(), face.nodes.data() + face.n_nodes);
      }
    matrix.compress(VectorOperation::add);

    // Rows that nothing has touched. A free one, without any stiffness, needs
    // a place for its inertia: products leave out what is zero.
    double largest = 0;
    for (const auto dof : grid.dof_handler.locally_owned_dofs())
      largest = std::max(largest, matrix.diag_element(dof));
    largest = Utilities::MPI::max(largest, grid.communicator);
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      {
        const auto dof = mass.get_partitioner()->local_to_global(i);
        if (matrix.diag_element(dof) != 0)
          continue;
        if (constraints.is_constrained[i])
          matrix.add(dof, dof, largest);
        else if (smoothing)
          matrix.add(dof, dof, std::numeric_limits<double>::min());
      }
    matrix.compress(VectorOperation::add);
  }

  template <int dim>
  void
  MomentumBalance<dim>::assemble(TrilinosWrappers::SparseMatrix &matrix) const
  {
    assemble_stiffness(smoothing ? stiffness : matrix);
    if (smoothing)
      smoothing->multiply(stiffness, matrix);
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      if (!constraints.is_constrained[i] && diagonal_stiffness(i) > 0)
        {
          const auto dof = mass.get_partitioner()->local_to_global(i);
          matrix.add(dof, dof, diagonal_stiffness(i));
        }
    matrix.compress(VectorOperation::add);
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace impm
