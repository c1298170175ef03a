// The tangent of MomentumBalance: as an operator, its diagonal, its matrix.

#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <impm/momentum_balance.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  MomentumBalance<dim>::project_tangent()
  {
    LAPACKFullMatrix<double> matrix(n_gradients);
    FullMatrix<double>       vectors(n_gradients);
    dealii::Vector<double>   values;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        double *A = &tangents[p * n_gradients * n_gradients];
        matrix.reinit(n_gradients);
        for (unsigned int a = 0; a < n_gradients; ++a)
          for (unsigned int b = 0; b < n_gradients; ++b)
            matrix(a, b) =
              0.5 * (A[a * n_gradients + b] + A[b * n_gradients + a]);
        const double bound = matrix.frobenius_norm();
        matrix.compute_eigenvalues_symmetric(
          -2 * bound, 2 * bound, 1e-14 * bound, values, vectors);
        if (values.size() < n_gradients || values[0] >= 0)
          continue;
        std::fill(A, A + n_gradients * n_gradients, 0.);
        for (unsigned int k = 0; k < n_gradients; ++k)
          for (unsigned int a = 0; a < n_gradients; ++a)
            for (unsigned int b = 0; b < n_gradients; ++b)
              A[a * n_gradients + b] +=
                std::max(values[k], 0.) * vectors(a, k) * vectors(b, k);
      }
  }

  template <int dim>
  void
  MomentumBalance<dim>::apply_tangent(Vector &dst, const Vector &src) const
  {
    ++n_operator_applications;
    gradients_at_points(src, gradient_increments);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double *A = &tangents[p * n_gradients * n_gradients];
        const double *g = &gradient_increments[p * n_gradients];
        double       *s = &stress_increments[p * n_gradients];
        for (unsigned int a = 0; a < n_gradients; ++a)
          {
            double sum = 0;
            for (unsigned int b = 0; b < n_gradients; ++b)
              sum += A[a * n_gradients + b] * g[b];
            s[a] = sum;
          }
      }
    dst = 0;
    add_point_forces(stress_increments, dst);
    ghost.add_force(src, 1., dst);
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
    apply_tangent(dst, work);
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
    apply_tangent(dst, work);
    constraints.set_zero(dst);
  }

  template <int dim>
  void
  MomentumBalance<dim>::cell_matrix(const typename Footprints<dim>::Cell &cell,
                                    FullMatrix<double> &matrix) const
  {
    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    constexpr unsigned int n       = n_nodes * dim;
    matrix                         = 0;
    // rows of A B: one per value of a gradient, one column per unknown
    std::array<std::array<double, n>, dim * dim + 1> AB;
    for (unsigned int e = cell.begin; e < cell.end; ++e)
      {
        const unsigned int p     = prints.point[e];
        const double      *slope = prints.gradient(e);
        const double      *A     = &tangents[p * n_gradients * n_gradients];
        const double       inverse_radius =
          axisymmetric ? prints.inverse_radius[p] : 0.;
        for (unsigned int a = 0; a < n_gradients; ++a)
          for (unsigned int m = 0; m < n_nodes; ++m)
            for (unsigned int c = 0; c < dim; ++c)
              {
                double sum = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  sum += A[a * n_gradients + dim * c + d] * slope[dim * m + d];
                if (axisymmetric && c == 0)
                  sum += A[a * n_gradients + dim * dim] * prints.value(e)[m] *
                         inverse_radius;
                AB[a][dim * m + c] = sum;
              }
        for (unsigned int m = 0; m < n_nodes; ++m)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int j = 0; j < n; ++j)
              {
                double sum = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  sum += slope[dim * m + d] * AB[dim * c + d][j];
                if (axisymmetric && c == 0)
                  sum += prints.value(e)[m] * inverse_radius * AB[dim * dim][j];
                matrix(dim * m + c, j) += sum;
              }
      }
  }

  template <int dim>
  void
  MomentumBalance<dim>::diagonal(Vector &diagonal) const
  {
    FullMatrix<double> local(Footprints<dim>::n_nodes * dim);
    diagonal = 0;
    for (const auto &cell : prints.cells)
      {
        cell_matrix(cell, local);
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            diagonal.local_element(dim * cell.nodes[n] + c) +=
              local(dim * n + c, dim * n + c);
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

  namespace
  {
    /** The unknowns of a face, those of a node together. */
    template <int dim>
    std::vector<types::global_dof_index>
    dofs_of(const typename GhostPenalty<dim>::Face &face, const Vector &vector)
    {
      std::vector<types::global_dof_index> dofs;
      for (unsigned int a = 0; a < face.n_nodes; ++a)
        for (unsigned int c = 0; c < dim; ++c)
          dofs.push_back(
            vector.get_partitioner()->local_to_global(dim * face.nodes[a] + c));
      return dofs;
    }
  } // namespace

  template <int dim>
  void
  MomentumBalance<dim>::initialize_matrix(
    TrilinosWrappers::SparseMatrix &matrix) const
  {
    const IndexSet &owned = grid.dof_handler.locally_owned_dofs();
    TrilinosWrappers::SparsityPattern    sparsity(owned,
                                               owned,
                                               grid.locally_relevant_dofs,
                                               grid.communicator);
    std::vector<types::global_dof_index> dofs(Footprints<dim>::n_nodes * dim);
    for (const auto &cell : prints.cells)
      {
        cell.cell->get_dof_indices(dofs);
        constraints.constraints.add_entries_local_to_global(dofs, sparsity);
      }
    for (const auto &face : ghost.faces)
      constraints.constraints.add_entries_local_to_global(dofs_of<dim>(face,
                                                                       mass),
                                                          sparsity);
    for (const auto dof : owned)
      sparsity.add(dof, dof);
    sparsity.compress();
    matrix.reinit(sparsity);
  }

  template <int dim>
  void
  MomentumBalance<dim>::assemble(TrilinosWrappers::SparseMatrix &matrix) const
  {
    constexpr unsigned int               n = Footprints<dim>::n_nodes * dim;
    std::vector<types::global_dof_index> dofs(n);
    FullMatrix<double>                   local(n), face_local;
    matrix = 0;
    for (const auto &cell : prints.cells)
      {
        cell.cell->get_dof_indices(dofs);
        cell_matrix(cell, local);
        local *= integrator.force_factor();
        constraints.constraints.distribute_local_to_global(local, dofs, matrix);
      }
    for (const auto &face : ghost.faces)
      {
        face_local.reinit(dim * face.n_nodes, dim * face.n_nodes);
        for (unsigned int a = 0; a < face.n_nodes; ++a)
          for (unsigned int b = 0; b < face.n_nodes; ++b)
            for (unsigned int c = 0; c < dim; ++c)
              face_local(dim * a + c, dim * b + c) =
                integrator.force_factor() * face.matrix[a][b];
        constraints.constraints.distribute_local_to_global(
          face_local, dofs_of<dim>(face, mass), matrix);
      }
    matrix.compress(VectorOperation::add);

    // Inertia, and rows that nothing has touched.
    const auto &partitioner = *mass.get_partitioner();
    double      largest     = 0;
    for (const auto dof : grid.dof_handler.locally_owned_dofs())
      largest = std::max(largest, matrix.diag_element(dof));
    largest = Utilities::MPI::max(largest, grid.communicator);
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      {
        const auto dof = partitioner.local_to_global(i);
        if (!constraints.is_constrained[i] && diagonal_stiffness(i) > 0)
          matrix.add(dof, dof, diagonal_stiffness(i));
        else if (constraints.is_constrained[i] && matrix.diag_element(dof) == 0)
          matrix.add(dof, dof, largest);
      }
    matrix.compress(VectorOperation::add);
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace impm
