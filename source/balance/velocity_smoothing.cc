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
    const auto nodes = [&](const auto &patch) {
      return make_array_view(footprints.patch_nodes.begin() + patch.begin_nodes,
                             footprints.patch_nodes.begin() + patch.end_nodes);
    };
    for (const auto &patch : footprints.patches)
      matrix.add_to_pattern(nodes(patch));
    matrix.end_pattern();

    constexpr unsigned int n_nodes = Footprints<dim>::n_nodes;
    // sum_p m_p S_pI S_pJ of the nodes of a patch; components do not mix
    FullMatrix<double>     mass;
    dealii::Vector<double> shares;
    for (const auto &patch : footprints.patches)
      {
        const unsigned int n = patch.end_nodes - patch.begin_nodes;
        mass.reinit(dim * n, dim * n);
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
                for (unsigned int c = 0; c < dim; ++c)
                  mass(dim * a + c, dim * b + c) +=
                    points.mass(p) * shares[a] * shares[b];
          }
        matrix.add_block(nodes(patch), mass);
      }
    matrix.end_blocks();

    const Unknowns &unknowns = matrix.unknowns;
    Vector          diagonal;
    unknowns.initialize(diagonal);
    matrix.get_diagonal(diagonal);
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      if (unknowns.is_held(i))
        diagonal.local_element(i) = 1;
    matrix.set_diagonal(diagonal);
  }

  template class VelocitySmoothing<2>;
  template class VelocitySmoothing<3>;
} // namespace impm
