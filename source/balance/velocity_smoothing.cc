#include <impm/balance/velocity_smoothing.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  VelocitySmoothing<dim>::VelocitySmoothing(
    const MaterialPoints<dim>  &points,
    const Footprints<dim>      &footprints,
    const StepConstraints<dim> &constraints,
    const Discretization<dim>  &discretization,
    const NodalMotion          &motion,
    const double                dt)
    : points(points)
    , footprints(footprints)
    , constraints(constraints)
    , discretization(discretization)
    , start(motion.velocity)
  {
    start *= dt;
    const Vector &mass = motion.mass;
    discretization.initialize(scaling);
    discretization.initialize(change);
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        scaling.local_element(i) = 1;
      else if (mass.local_element(i) > 0)
        scaling.local_element(i) = 1 / mass.local_element(i);
  }

  template <int dim>
  void
  VelocitySmoothing<dim>::apply_derivative(const Vector &u,
                                           Vector       &result) const
  {
    change = u;
    discretization.interpolate_hanging(change);
    footprints.interpolate(change, at_points);
    for (unsigned int p = 0; p < points.size(); ++p)
      at_points[p] *= points.mass(p);
    change = 0;
    footprints.spread(at_points, change);
    change.compress(VectorOperation::add);
    discretization.condense_hanging(change);
    for (unsigned int i = 0; i < result.locally_owned_size(); ++i)
      result.local_element(i) =
        constraints.is_constrained[i] ?
          u.local_element(i) :
          scaling.local_element(i) * change.local_element(i);
    discretization.interpolate_hanging(result);
  }

  template <int dim>
  void
  VelocitySmoothing<dim>::apply(const Vector &u, Vector &result) const
  {
    result = u;
    result -= start;
    apply_derivative(result, result);
    for (unsigned int i = 0; i < result.locally_owned_size(); ++i)
      result.local_element(i) =
        constraints.is_constrained[i] ?
          u.local_element(i) :
          result.local_element(i) + start.local_element(i);
    discretization.interpolate_hanging(result);
  }

  template <int dim>
  void
  VelocitySmoothing<dim>::fill_spread_mass(SparseMatrix &matrix) const
  {
    // Components do not mix.
    const auto &partitioner = *discretization.numbering->partitioner;
    const auto  dofs        = [&](const auto &patch, const unsigned int c) {
      SparseMatrix::Dofs result;
      for (unsigned int n = patch.begin_nodes; n < patch.end_nodes; ++n)
        result.push_back(
          partitioner.local_to_global(dim * footprints.patch_nodes[n] + c));
      return result;
    };
    for (const auto &patch : footprints.patches)
      for (unsigned int c = 0; c < dim; ++c)
        matrix.add_to_pattern(dofs(patch, c));
    matrix.end_pattern();

    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    FullMatrix<double>     mass; // sum_p m_p S_pI S_pJ of the nodes of a patch
    dealii::Vector<double> shares;
    for (const auto &patch : footprints.patches)
      {
        const unsigned int n = patch.end_nodes - patch.begin_nodes;
        mass.reinit(n, n);
        for (unsigned int i = patch.begin_points; i < patch.end_points; ++i)
          {
            const unsigned int p = footprints.patch_points[i];
            shares.reinit(n);
            for (unsigned int k = footprints.first[p];
                 k < footprints.first[p + 1];
                 ++k)
              for (unsigned int v = 0; v < n_nodes; ++v)
                {
                  const unsigned int e = footprints.entries[k];
                  shares[footprints.place[e * n_nodes + v]] +=
                    footprints.value(e)[v];
                }
            for (unsigned int a = 0; a < n; ++a)
              for (unsigned int b = 0; b < n; ++b)
                mass(a, b) += points.mass(p) * shares[a] * shares[b];
          }
        for (unsigned int c = 0; c < dim; ++c)
          matrix.add_block(mass, dofs(patch, c));
      }
    matrix.compress(VectorOperation::add);

    // Identity where constrained, whatever condensing has left there.
    for (unsigned int i = 0; i < partitioner.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        {
          const auto dof = partitioner.local_to_global(i);
          matrix.set_diagonal(dof, 1.);
        }
    matrix.compress(VectorOperation::insert);
  }

  template class VelocitySmoothing<2>;
  template class VelocitySmoothing<3>;
} // namespace impm
