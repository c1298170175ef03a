#include <impm/balance/momentum_balance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  MomentumBalance<dim>::add_forces_of_strain(const Vector &strain_u,
                                             Vector       &result) const
  {
    for (const Term *term : parts.strain_terms)
      term->add_force(strain_u, result);
    result.compress(VectorOperation::add);
    parts.discretization.condense_hanging(result);
  }

  template <int dim>
  Vector
  MomentumBalance<dim>::forces_of_strain(const Vector &u) const
  {
    Vector result;
    initialize(result);
    const Vector &strain_u = strain_increment(u);
    for (const Term *term : parts.strain_terms)
      term->add_end_force(strain_u, result);
    result.compress(VectorOperation::add);
    parts.discretization.condense_hanging(result);
    return result;
  }

  template <int dim>
  bool
  MomentumBalance<dim>::strain(const Vector &u, const bool with_tangent)
  {
    const Vector &strain_u = strain_increment(u);
    bool          fine     = true;
    for (Term *term : parts.strain_terms)
      fine = term->evaluate(strain_u, with_tangent) && fine;
    return Utilities::MPI::min(fine ? 1 : 0,
                               parts.discretization.communicator) == 1;
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::evaluate(const Vector &u, const bool with_tangent)
  {
    Evaluation result;
    u.update_ghost_values();
    if (!strain(u, with_tangent))
      return result;

    const Vector &strain_u  = parts.smoothing ? smooth : u;
    const double  weight    = parts.end_weight;
    double        potential = 0;
    forces                  = 0;
    add_forces_of_strain(strain_u, forces);
    for (const Term *term : parts.strain_terms)
      potential += weight * term->energy(strain_u, strain_u);
    const auto strain_forces = parts.norm->squares(forces);
    if (weight < 1)
      {
        forces.sadd(weight, 1 - weight, parts.start_forces);
        potential +=
          (1 - weight) * std::inner_product(parts.start_forces.begin(),
                                            parts.start_forces.end(),
                                            strain_u.begin(),
                                            0.);
      }
    const Vector *felt = &u;
    if (parts.smoothing)
      {
        work = u;
        parts.constraints.set_zero(work);
        felt = &strain_direction();
      }
    for (const Term *term : parts.node_terms)
      {
        term->add_force(u, forces);
        potential += term->energy(u, *felt);
      }

    free_residual = forces;
    parts.constraints.set_zero(free_residual);
    result.potential =
      Utilities::MPI::sum(potential, parts.discretization.communicator);
    judge(u, strain_forces, result);
    result.admissible =
      std::isfinite(result.residual) && std::isfinite(result.potential);
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
    for (const auto &terms : {parts.strain_terms, parts.node_terms})
      for (const Term *term : terms)
        append(term->squares_of_parts(u, norm));
    Utilities::MPI::sum(sums, parts.discretization.communicator, sums);
    for (double &sum : sums)
      sum = std::sqrt(sum);

    // What cancels in the residual at most leaves this behind. A deformation
    // near one and differences of u have errors of their own, however small
    // the stress is that comes of them.
    // An increment of more than a million lengths is none: singular systems
    // have such solutions, whose noise would pass for convergence.
    const double strain =
      parts.end_weight * (1 + std::min(u.linfty_norm() / length_scale(), 1e6));
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
  MomentumBalance<dim>::apply_tangent(Vector &dst) const
  {
    ++counts->operator_applications;
    const Vector &strain_src = strain_direction();
    dst                      = 0;
    for (const Term *term : parts.strain_terms)
      term->apply(strain_src, dst);
    dst.compress(VectorOperation::add);
    parts.discretization.condense_hanging(dst);
    dst *= parts.end_weight;
    for (const Term *term : parts.node_terms)
      term->apply(work, dst);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult(Vector &dst, const Vector &src) const
  {
    work = src;
    parts.constraints.set_zero(work);
    apply_tangent(dst);
    for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
      if (is_constrained(i))
        dst.local_element(i) = src.local_element(i);
  }

  template <int dim>
  void
  MomentumBalance<dim>::vmult_lift(Vector &dst, const Vector &src) const
  {
    work = src;
    apply_tangent(dst);
    parts.constraints.set_zero(dst);
  }

  template <int dim>
  void
  MomentumBalance<dim>::diagonal(Vector &diagonal) const
  {
    diagonal = 0;
    for (const Term *term : parts.strain_terms)
      term->add_diagonal(diagonal);
    diagonal.compress(VectorOperation::add);
    parts.discretization.condense_hanging(diagonal);
    diagonal *= parts.end_weight;
    for (const Term *term : parts.node_terms)
      term->add_diagonal(diagonal);
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      if (is_constrained(i))
        diagonal.local_element(i) = 1;
  }

  template <int dim>
  Unknowns
  MomentumBalance<dim>::make_unknowns() const
  {
    const auto &numbering = *parts.discretization.numbering;
    return Unknowns(numbering.partitioner,
                    parts.constraints.is_constrained,
                    numbering.masters,
                    dim);
  }

  template <int dim>
  std::unique_ptr<SparseMatrix>
  MomentumBalance<dim>::make_matrix(const Unknowns &unknowns) const
  {
    auto matrix = std::make_unique<SparseMatrix>(unknowns);
    for (const Term *term : parts.strain_terms)
      term->add_matrix(true, [&](const auto &nodes, const auto &) {
        matrix->add_to_pattern(nodes);
      });
    matrix->end_pattern();
    if (!parts.smoothing)
      return matrix;
    // What is asked for is a product.
    stiffness   = std::move(matrix);
    spread_mass = std::make_unique<SparseMatrix>(unknowns);
    parts.smoothing->fill_spread_mass(*spread_mass);
    return std::make_unique<SparseMatrix>(unknowns);
  }

  template <int dim>
  void
  MomentumBalance<dim>::assemble(SparseMatrix &matrix) const
  {
    const Unknowns &unknowns = matrix.unknowns;
    SparseMatrix   &K        = parts.smoothing ? *stiffness : matrix;
    K.set_zero();
    for (const Term *term : parts.strain_terms)
      term->add_matrix(false, [&](const auto &nodes, auto &block) {
        if (parts.end_weight != 1)
          block *= parts.end_weight;
        K.add_block(nodes, block);
      });
    K.end_blocks();

    // Rows of what is held beside a free value. A free one, without any
    // stiffness, needs a place for its inertia: products leave out what is
    // zero.
    Vector diagonal;
    unknowns.initialize(diagonal);
    K.get_diagonal(diagonal);
    double largest = 0;
    for (const double entry : diagonal)
      largest = std::max(largest, entry);
    largest = Utilities::MPI::max(largest, parts.discretization.communicator);
    if (largest == 0) // nothing is stiff, as where all grains have come apart
      largest = 1;
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      if (double &entry = diagonal.local_element(i); entry == 0)
        entry = unknowns.is_held(i) ? largest :
                parts.smoothing     ? std::numeric_limits<double>::min() :
                                      0.;
    K.set_diagonal(diagonal);

    if (parts.smoothing)
      {
        Vector scaling;
        unknowns.initialize(scaling);
        unknowns.pack(parts.smoothing->scaling, scaling);
        matrix.multiply(K, scaling, *spread_mass);
        matrix.get_diagonal(diagonal);
      }
    if (parts.node_terms.empty())
      return;
    work = 0;
    for (const Term *term : parts.node_terms)
      term->add_diagonal(work);
    parts.constraints.set_zero(work);
    Vector more;
    unknowns.initialize(more);
    unknowns.pack(work, more);
    diagonal += more;
    matrix.set_diagonal(diagonal);
  }

  template <int dim>
  LowRank
  MomentumBalance<dim>::correction() const
  {
    LowRank result;
    for (const Term *term : parts.strain_terms)
      term->add_correction(work, result);
    for (auto *vectors : {&result.left, &result.right})
      for (Vector &vector : *vectors)
        {
          vector.compress(VectorOperation::add);
          parts.discretization.condense_hanging(vector);
          parts.constraints.set_zero(vector);
        }
    for (Vector &vector : result.left)
      vector *= parts.end_weight;
    return result;
  }

  template <int dim>
  std::vector<std::vector<double>>
  MomentumBalance<dim>::near_null_space(const Unknowns &unknowns) const
  {
    const unsigned int n = unknowns.n_owned();
    const unsigned int n_modes =
      dim + (parts.has_rotations ? dim * (dim - 1) / 2 : 0);
    std::vector<std::vector<double>> modes(n_modes, std::vector<double>(n));
    for (unsigned int i = 0; i < n; ++i)
      {
        if (unknowns.is_held(i))
          continue;
        const unsigned int c = i % dim;
        const auto        &place =
          parts.discretization.node_positions[unknowns.nodes[i / dim]];
        modes[c][i]       = 1;
        unsigned int mode = dim;
        if (parts.has_rotations)
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = a + 1; b < dim; ++b, ++mode)
              modes[mode][i] = c == a ? -place[b] : c == b ? place[a] : 0.;
      }
    return modes;
  }

  template <int dim>
  NodeLattice
  MomentumBalance<dim>::lattice(const Unknowns &unknowns) const
  {
    const auto &nodes    = parts.discretization.numbering->lattice;
    const auto  place_of = [&](const unsigned int node) {
      NodeLattice::Place place{};
      std::copy(nodes[node].place.begin(),
                nodes[node].place.end(),
                place.begin());
      return place;
    };
    NodeLattice result;
    for (const unsigned int node : unknowns.nodes)
      {
        result.places.push_back(place_of(node));
        result.layers.push_back(nodes[node].layer);
        result.extents.push_back(nodes[node].extent);
      }
    const auto &carrier = parts.constraints.carrier;
    for (unsigned int i = 0; i < dim * nodes.size(); ++i)
      if (carrier[i] != StepConstraints<dim>::no_carrier)
        result.prescribed.push_back(
          {place_of(i / dim), nodes[i / dim].layer, i % dim});
    return result;
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace impm
