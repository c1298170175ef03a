#include <impm/balance/momentum_balance.h>

#include <cmath>
#include <limits>

namespace impm
{
  using namespace dealii;

  template <int dim>
  MomentumBalance<dim>::MomentumBalance(
    const Discretization<dim>  &discretization,
    const StepConstraints<dim> &constraints,
    Parts                       the_parts,
    WorkCounts                 &work_counts)
    : discretization(discretization)
    , constraints(constraints)
    , parts(std::move(the_parts))
  {
    counts = &work_counts;
    for (Vector *vector : {&forces, &free_residual, &work, &smooth})
      initialize(*vector);
  }

  template <int dim>
  Vector
  MomentumBalance<dim>::forces_of_strain(const Vector &u) const
  {
    Vector result;
    initialize(result);
    if (parts.smoothing)
      parts.smoothing->apply(u, parts.start_increment, smooth);
    for (const auto &term : parts.strain_terms)
      term->add_force(parts.smoothing ? smooth : u, result);
    result.compress(VectorOperation::add);
    discretization.condense_hanging(result);
    return result;
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::evaluate(const Vector &u, const bool with_tangent)
  {
    Evaluation result;
    u.update_ghost_values();
    if (parts.smoothing)
      parts.smoothing->apply(u, parts.start_increment, smooth);
    const Vector &strain_u = parts.smoothing ? smooth : u;
    bool          fine     = true;
    for (const auto &term : parts.strain_terms)
      fine = term->evaluate(strain_u, with_tangent) && fine;
    const MPI_Comm communicator = discretization.communicator;
    if (Utilities::MPI::min(fine ? 1 : 0, communicator) == 0)
      return result;

    const double weight    = parts.end_weight;
    double       potential = 0;
    forces                 = 0;
    if (weight > 0)
      {
        for (const auto &term : parts.strain_terms)
          {
            term->add_force(strain_u, forces);
            potential += weight * term->energy(strain_u);
          }
        forces.compress(VectorOperation::add);
        discretization.condense_hanging(forces);
      }
    const auto strain_forces = parts.norm->squares(forces);
    if (weight < 1)
      {
        forces.sadd(weight, 1 - weight, parts.start_forces);
        for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
          potential += (1 - weight) * parts.start_forces.local_element(i) *
                       strain_u.local_element(i);
      }
    for (const auto &term : parts.node_terms)
      {
        term->add_force(u, forces);
        potential += term->energy(u);
      }

    free_residual = forces;
    constraints.set_zero(free_residual);
    result.admissible = true;
    result.potential  = Utilities::MPI::sum(potential, communicator);
    judge(u, strain_forces, result);
    if (!std::isfinite(result.residual) || !std::isfinite(result.potential))
      result.admissible = false;
    return result;
  }

  template <int dim>
  void
  MomentumBalance<dim>::judge(const Vector              &u,
                              const std::vector<double> &strain_forces,
                              Evaluation                &result) const
  {
    const auto         &norm   = *parts.norm;
    const unsigned int  n      = norm.n_groups();
    std::vector<double> sums   = norm.squares(free_residual);
    const auto          append = [&](const std::vector<double> &more) {
      sums.insert(sums.end(), more.begin(), more.end());
    };
    append(strain_forces);
    for (const Terms *terms : {&parts.strain_terms, &parts.node_terms})
      for (const auto &term : *terms)
        {
          std::vector<double> squares(n);
          term->add_squares_of_parts(u, norm, squares);
          append(squares);
        }
    Utilities::MPI::sum(sums, discretization.communicator, sums);
    for (double &sum : sums)
      sum = std::sqrt(sum);

    // What cancels in the residual at most leaves this behind. A deformation
    // near one and differences of u have errors of their own, however small
    // the stress is that comes of them.
    const double strain =
      parts.end_weight *
      (1 + u.linfty_norm() / discretization.smallest_cell_extent);
    const auto at_work = norm.largest_nearby(
      std::vector<double>(sums.begin() + n, sums.begin() + 2 * n));
    result.parts.resize(n);
    for (unsigned int g = 0; g < n; ++g)
      {
        auto &part    = result.parts[g];
        part.residual = sums[g] / norm.units[g];
        double noise  = strain * norm.stiffness[g];
        for (unsigned int i = n + g; i < sums.size(); i += n)
          noise += sums[i];
        part.round_off =
          16 * std::numeric_limits<double>::epsilon() * noise / norm.units[g];
        if (parts.minds_forces_at_work)
          part.at_work = at_work[g];
        // not a number stays so
        if (!(part.residual <= result.residual))
          result.residual = part.residual;
      }
  }

  template <int dim>
  double
  MomentumBalance<dim>::work_along(const Vector &direction,
                                   const Vector &force) const
  {
    if (!parts.smoothing)
      return force * direction;
    parts.smoothing->apply_derivative(direction, smooth);
    return force * smooth;
  }

  template <int dim>
  void
  MomentumBalance<dim>::project_tangent()
  {
    for (const auto &term : parts.strain_terms)
      term->project_tangent();
  }

  template <int dim>
  void
  MomentumBalance<dim>::apply_tangent(Vector       &dst,
                                      const Vector &strain_src,
                                      const Vector &src) const
  {
    ++counts->operator_applications;
    dst = 0;
    for (const auto &term : parts.strain_terms)
      term->apply(strain_src, dst);
    dst.compress(VectorOperation::add);
    discretization.condense_hanging(dst);
    dst *= parts.end_weight;
    for (const auto &term : parts.node_terms)
      term->apply(src, dst);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult(Vector &dst, const Vector &src) const
  {
    work = src;
    constraints.set_zero(work);
    interpolate_hanging(work);
    if (parts.smoothing)
      parts.smoothing->apply_derivative(work, smooth);
    apply_tangent(dst, parts.smoothing ? smooth : work, work);
    for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        dst.local_element(i) = src.local_element(i);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult_lift(Vector &dst, const Vector &src) const
  {
    work = src;
    interpolate_hanging(work);
    if (parts.smoothing)
      parts.smoothing->apply_derivative(work, smooth);
    apply_tangent(dst, parts.smoothing ? smooth : work, work);
    constraints.set_zero(dst);
  }

  template <int dim>
  void
  MomentumBalance<dim>::diagonal(Vector &diagonal) const
  {
    diagonal = 0;
    for (const auto &term : parts.strain_terms)
      term->add_diagonal(diagonal);
    diagonal.compress(VectorOperation::add);
    discretization.condense_hanging(diagonal);
    diagonal *= parts.end_weight;
    for (const auto &term : parts.node_terms)
      term->add_diagonal(diagonal);
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        diagonal.local_element(i) = 1;
  }

  template <int dim>
  std::unique_ptr<SparseMatrix>
  MomentumBalance<dim>::make_matrix() const
  {
    auto matrix =
      std::make_unique<SparseMatrix>(*discretization.numbering->partitioner,
                                     constraints.constraints);
    for (const auto &term : parts.strain_terms)
      term->add_matrix(true,
                       [&](const unsigned int *begin,
                           const unsigned int *end,
                           const FullMatrix<double> &) {
                         matrix->add_to_pattern(
                           discretization.dofs_of_nodes(begin, end));
                       });
    matrix->end_pattern();
    if (!parts.smoothing)
      return matrix;
    // What is asked for is a product.
    stiffness   = std::move(matrix);
    spread_mass = parts.smoothing->make_spread_mass();
    return std::make_unique<SparseMatrix>(
      *discretization.numbering->partitioner, constraints.constraints);
  }

  template <int dim>
  void
  MomentumBalance<dim>::assemble_stiffness(SparseMatrix &matrix) const
  {
    matrix.set_zero();
    FullMatrix<double> weighed;
    for (const auto &term : parts.strain_terms)
      term->add_matrix(false,
                       [&](const unsigned int       *begin,
                           const unsigned int       *end,
                           const FullMatrix<double> &block) {
                         const auto dofs =
                           discretization.dofs_of_nodes(begin, end);
                         if (parts.end_weight == 1)
                           {
                             matrix.add_block(block, dofs);
                             return;
                           }
                         weighed = block;
                         weighed *= parts.end_weight;
                         matrix.add_block(weighed, dofs);
                       });
    matrix.compress(VectorOperation::add);

    // Rows that nothing has touched. A free one, without any stiffness, needs
    // a place for its inertia: products leave out what is zero.
    const auto &partitioner = *discretization.numbering->partitioner;
    double      largest     = 0;
    for (const auto dof : discretization.locally_owned_dofs())
      largest = std::max(largest, matrix.diagonal(dof));
    largest = Utilities::MPI::max(largest, discretization.communicator);
    for (unsigned int i = 0; i < partitioner.locally_owned_size(); ++i)
      {
        const auto dof = partitioner.local_to_global(i);
        if (matrix.diagonal(dof) != 0)
          continue;
        if (constraints.is_constrained[i])
          matrix.add_to_diagonal(dof, largest);
        else if (parts.smoothing)
          matrix.add_to_diagonal(dof, std::numeric_limits<double>::min());
      }
    matrix.compress(VectorOperation::add);
  }

  template <int dim>
  void
  MomentumBalance<dim>::assemble(SparseMatrix &matrix) const
  {
    assemble_stiffness(parts.smoothing ? *stiffness : matrix);
    if (parts.smoothing)
      matrix.multiply(*stiffness, parts.smoothing->scaling(), *spread_mass);
    if (parts.node_terms.empty())
      return;
    work = 0;
    for (const auto &term : parts.node_terms)
      term->add_diagonal(work);
    const auto &partitioner = *discretization.numbering->partitioner;
    for (unsigned int i = 0; i < work.locally_owned_size(); ++i)
      if (!constraints.is_constrained[i] && work.local_element(i) > 0)
        {
          const auto dof = partitioner.local_to_global(i);
          matrix.add_to_diagonal(dof, work.local_element(i));
        }
    matrix.compress(VectorOperation::add);
  }

  template <int dim>
  std::vector<std::vector<double>>
  MomentumBalance<dim>::near_null_space() const
  {
    const unsigned int n =
      discretization.numbering->partitioner->locally_owned_size();
    const unsigned int n_modes =
      dim + (parts.has_rotations ? dim * (dim - 1) / 2 : 0);
    std::vector<std::vector<double>> modes(n_modes, std::vector<double>(n));
    for (unsigned int i = 0; i < n; ++i)
      {
        if (constraints.is_constrained[i])
          continue;
        const unsigned int c     = i % dim;
        const auto        &place = discretization.node_positions[i / dim];
        modes[c][i]              = 1;
        unsigned int mode        = dim;
        if (parts.has_rotations)
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = a + 1; b < dim; ++b, ++mode)
              modes[mode][i] = c == a ? -place[b] : c == b ? place[a] : 0.;
      }
    return modes;
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace impm
