#include <impm/balance/residual_norm.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Stiffness times the size of a cell, Sulsky & Kaul's unit of forces. */
    template <int dim>
    double
    force_of_cell(const Bodies<dim>         &bodies,
                  const MaterialPoints<dim> &points,
                  const Footprints<dim>     &footprints)
    {
      double stiffness = 0, volume = std::numeric_limits<double>::max();
      for (const auto &body : bodies)
        if (!body.rigid)
          stiffness = std::max(stiffness, body.material->stiffness());
      for (const auto &cell : footprints.cells)
        {
          double product = 1;
          for (unsigned int d = 0; d < dim; ++d)
            product *= cell_extent(cell.cell, d);
          volume = std::min(volume, product);
        }
      // The paper's forces around an axis are those of a radian.
      const bool axisymmetric =
        points.layout.geometry == GeometryKind::axisymmetric;
      return (axisymmetric ? 2 * numbers::PI : 1.) * stiffness *
             Utilities::MPI::min(volume, points.communicator);
    }
  } // namespace

  template <int dim>
  ResidualNorm::ResidualNorm(const ResidualScale        scale,
                             const double               dt,
                             const Bodies<dim>         &bodies,
                             const MaterialPoints<dim> &points,
                             const Footprints<dim>     &footprints,
                             const Discretization<dim> &discretization)
    : communicator(discretization.communicator)
  {
    const bool   is_by_body   = scale == ResidualScale::body;
    unsigned int n_deformable = 0;
    for (const auto &body : bodies)
      {
        group_of_body.push_back(is_by_body ? n_deformable : 0);
        n_deformable += !body.rigid;
      }
    std::vector<Vector> forces(is_by_body ? n_deformable : 1);
    for (Vector &force : forces)
      discretization.initialize(force);
    for (const auto &cell : footprints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        {
          const unsigned int p     = footprints.point[e];
          Vector            &force = forces[group_of_body[points.body(p)]];
          const double share = footprints.weight[e] * points.initial_volume(p) *
                               points.material(p).stiffness() / cell.extent;
          for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
            if (footprints.touches(e, n))
              for (unsigned int c = 0; c < dim; ++c)
                force.local_element(dim * cell.nodes[n] + c) += share;
        }
    discretization.initialize(unit_strain_forces);
    for (Vector &force : forces)
      {
        force.compress(VectorOperation::add);
        discretization.condense_hanging(force);
        stiffness.push_back(force.l2_norm());
        unit_strain_forces += force;
      }
    unit_strain_forces.update_ghost_values();

    units = stiffness;
    if (scale == ResidualScale::cell)
      units = {force_of_cell(bodies, points, footprints)};
    else if (scale == ResidualScale::momentum)
      units = {1 / dt};
    if (forces.size() > 1)
      find_neighbors(forces);
  }

  void
  ResidualNorm::find_neighbors(const std::vector<Vector> &forces)
  {
    const unsigned int n = forces.size();
    nearby.resize(n * n);
    shares.resize(n);
    for (unsigned int i = 0; i < unit_strain_forces.locally_owned_size(); ++i)
      for (unsigned int g = 0; g < n; ++g)
        if (forces[g].local_element(i) > 0)
          {
            shares[g].push_back({i,
                                 forces[g].local_element(i) /
                                   unit_strain_forces.local_element(i)});
            for (unsigned int h = 0; h < n; ++h)
              if (forces[h].local_element(i) > 0)
                nearby[n * g + h] = 1;
          }
    Utilities::MPI::max(nearby, communicator, nearby);
    for (unsigned int k = 0; k < n; ++k)
      for (unsigned int g = 0; g < n; ++g)
        for (unsigned int h = 0; h < n; ++h)
          if (nearby[n * g + k] > 0 && nearby[n * k + h] > 0)
            nearby[n * g + h] = 1;
  }

  std::vector<double>
  ResidualNorm::squares(const Vector &force) const
  {
    std::vector<double> sums(n_groups());
    if (shares.empty())
      sums[0] =
        std::inner_product(force.begin(), force.end(), force.begin(), 0.);
    else
      for (unsigned int g = 0; g < n_groups(); ++g)
        for (const auto &share : shares[g])
          sums[g] +=
            std::pow(share.weight * force.local_element(share.index), 2);
    return sums;
  }

  std::vector<double>
  ResidualNorm::largest_nearby(const Vector &force) const
  {
    auto norms = squares(force);
    Utilities::MPI::sum(norms, communicator, norms);
    for (double &norm : norms)
      norm = std::sqrt(norm);
    return largest_nearby(norms);
  }

  std::vector<double>
  ResidualNorm::largest_nearby(std::vector<double> norms) const
  {
    for (unsigned int g = 0; g < n_groups(); ++g)
      norms[g] /= units[g];
    std::vector<double> result = norms;
    for (unsigned int i = 0; i < nearby.size(); ++i)
      if (nearby[i] > 0)
        result[i / n_groups()] =
          std::max(result[i / n_groups()], norms[i % n_groups()]);
    return result;
  }

  template ResidualNorm::ResidualNorm(ResidualScale,
                                      double,
                                      const Bodies<2> &,
                                      const MaterialPoints<2> &,
                                      const Footprints<2> &,
                                      const Discretization<2> &);
  template ResidualNorm::ResidualNorm(ResidualScale,
                                      double,
                                      const Bodies<3> &,
                                      const MaterialPoints<3> &,
                                      const Footprints<3> &,
                                      const Discretization<3> &);
} // namespace impm
