#include <impm/balance/volume_average.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  VolumeAverage<dim>::VolumeAverage(const Bodies<dim>         &bodies,
                                    const MaterialPoints<dim> &points,
                                    const Kinematics<dim>     &kinematics)
    : points(points)
    , kinematics(kinematics)
  {
    std::vector<char> body_takes_part;
    for (const auto &body : bodies)
      {
        body_takes_part.push_back(!body.rigid && body.material->average_volume);
        used = used || body_takes_part.back();
      }
    if (!used)
      return;
    groups.assign(points.size(), numbers::invalid_unsigned_int);
    start_volume.resize(points.size());
    jacobian.resize(points.size());
    mean.resize(points.size() * kinematics.size);
    coupling.resize(points.size() * kinematics.size);
    square.resize(points.size());

    std::vector<unsigned int>                  group_of_body;
    unsigned int                               n_groups = 0, p = 0;
    typename Triangulation<dim>::cell_iterator current;
    for (const auto &particle : points.sorted.particles)
      {
        const auto cell = particle.get_surrounding_cell();
        if (p == 0 || cell != current)
          group_of_body.assign(body_takes_part.size(),
                               numbers::invalid_unsigned_int);
        current                 = cell;
        const unsigned int body = points.body(p);
        if (body_takes_part[body])
          {
            if (group_of_body[body] == numbers::invalid_unsigned_int)
              group_of_body[body] = n_groups++;
            groups[p]       = group_of_body[body];
            start_volume[p] = points.initial_volume(p) *
                              determinant(points.layout.load_tensor(
                                points.fields(p) + points.offset_deformation));
          }
        ++p;
      }
    group_volume.assign(n_groups, 0.);
    for (unsigned int q = 0; q < groups.size(); ++q)
      if (includes(q))
        group_volume[groups[q]] += start_volume[q];
  }

  template <int dim>
  bool
  VolumeAverage<dim>::measure(const std::vector<double> &gradients,
                              const bool                 with_tangent)
  {
    if (!used)
      return true;
    group_change.assign(group_volume.size(), 0.);
    group_pressure.assign(group_volume.size(), 0.);
    if (with_tangent)
      group_square.assign(group_volume.size(), 0.);
    for (unsigned int p = 0; p < groups.size(); ++p)
      if (includes(p))
        {
          jacobian[p] = determinant(
            kinematics.deformation(&gradients[p * kinematics.size]));
          if (!(jacobian[p] > 0))
            return false;
          group_change[groups[p]] += start_volume[p] * jacobian[p];
        }
    return true;
  }

  template <int dim>
  Tensor<2, 3>
  VolumeAverage<dim>::average(const unsigned int point, Tensor<2, 3> dF) const
  {
    const unsigned int g = groups[point];
    const double ratio   = group_change[g] / group_volume[g] / jacobian[point];
    const double factor =
      kinematics.n_dilating == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
    for (unsigned int i = 0; i < kinematics.n_dilating; ++i)
      for (unsigned int j = 0; j < kinematics.n_dilating; ++j)
        dF[i][j] *= factor;
    return dF;
  }

  template <int dim>
  void
  VolumeAverage<dim>::take_out_pressure(const unsigned int  point,
                                        const double        volume,
                                        const Tensor<2, 3> &inverse,
                                        Material::Response &response,
                                        double             *matrix)
  {
    const unsigned int n_g = kinematics.size;
    const double       n   = kinematics.n_dilating;
    auto              &tau = response.kirchhoff_stress;
    double             pi  = 0;
    for (unsigned int i = 0; i < n; ++i)
      pi += tau[i][i] / n;
    group_pressure[groups[point]] += volume * pi;

    if (matrix != nullptr)
      {
        // Lists of the unit tensor and of tau; K is `matrix`.
        typename Kinematics<dim>::List e{}, t{}, Ke{};
        for (unsigned int i = 0; i < dim; ++i)
          {
            e[dim * i + i] = 1;
            for (unsigned int j = 0; j < dim; ++j)
              t[dim * i + j] = tau[i][j];
          }
        if (kinematics.axisymmetric)
          {
            e[dim * dim] = 1;
            t[dim * dim] = tau[2][2];
          }
        double eKe = 0;
        for (unsigned int a = 0; a < n_g; ++a)
          {
            for (unsigned int b = 0; b < n_g; ++b)
              Ke[a] += matrix[a * n_g + b] * e[b];
            eKe += e[a] * Ke[a];
          }
        // A = (1 - ee/n) K (1 - ee/n) - (te + et)/n + pi/n ee + pi X, where
        // g.X.h = tr(g h); then b and c of the class.
        typename Kinematics<dim>::List b{};
        for (unsigned int k = 0; k < n_g; ++k)
          {
            for (unsigned int l = 0; l < n_g; ++l)
              matrix[k * n_g + l] += -(Ke[k] * e[l] + e[k] * Ke[l]) / n +
                                     eKe / (n * n) * e[k] * e[l] -
                                     (t[k] * e[l] + e[k] * t[l]) / n +
                                     pi / n * e[k] * e[l];
            b[k] = Ke[k] / n - eKe / (n * n) * e[k] + t[k] / n - pi / n * e[k];
          }
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            matrix[(dim * i + j) * n_g + dim * j + i] += pi;
        if (kinematics.axisymmetric)
          matrix[n_g * n_g - 1] += pi;
        kinematics.carry_back(b.data(),
                              inverse,
                              volume,
                              &coupling[point * n_g]);
        square[point] = volume * (eKe / (n * n) + pi / n - pi);
        group_square[groups[point]] += square[point];
      }
    for (unsigned int i = 0; i < n; ++i)
      tau[i][i] -= pi;
  }

  template <int dim>
  void
  VolumeAverage<dim>::share_pressure(const std::vector<double> &gradients,
                                     const bool                 with_tangent,
                                     std::vector<double>       &stresses,
                                     std::vector<double>       &tangents)
  {
    const unsigned int n_g = kinematics.size;
    for (unsigned int p = 0; p < groups.size(); ++p)
      {
        if (!includes(p))
          continue;
        const unsigned int g  = groups[p];
        const double share    = start_volume[p] * jacobian[p] / group_change[g];
        const double pressure = group_pressure[g];
        const auto   inverse =
          invert(kinematics.deformation(&gradients[p * n_g]));
        typename Kinematics<dim>::List m{};
        kinematics.carry_back_stress(unit_symmetric_tensor<3>(),
                                     inverse,
                                     share,
                                     m.data());
        for (unsigned int a = 0; a < n_g; ++a)
          stresses[p * n_g + a] += pressure * m[a];
        if (!with_tangent)
          continue;
        // From the second derivative of ln theta: share (tr g tr h - tr(g h)).
        std::copy_n(m.begin(), n_g, &mean[p * n_g]);
        double *A = &tangents[p * n_g * n_g];
        for (unsigned int a = 0; a < n_g; ++a)
          for (unsigned int b = 0; b < n_g; ++b)
            A[a * n_g + b] += pressure / share * m[a] * m[b];
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int l = 0; l < dim; ++l)
                A[(dim * i + j) * n_g + dim * k + l] -=
                  pressure * share * inverse[j][k] * inverse[l][i];
        if (kinematics.axisymmetric)
          A[n_g * n_g - 1] -= pressure * share * inverse[2][2] * inverse[2][2];
      }
  }

  template <int dim>
  void
  VolumeAverage<dim>::apply_coupling(
    const std::vector<double> &gradient_changes,
    std::vector<double>       &stress_changes) const
  {
    if (!used)
      return;
    const unsigned int n_g = kinematics.size;
    by_mean.assign(group_volume.size(), 0.);
    by_coupling.assign(group_volume.size(), 0.);
    for (unsigned int p = 0; p < groups.size(); ++p)
      if (includes(p))
        for (unsigned int a = p * n_g; a < (p + 1) * n_g; ++a)
          {
            by_mean[groups[p]] += mean[a] * gradient_changes[a];
            by_coupling[groups[p]] += coupling[a] * gradient_changes[a];
          }
    for (unsigned int p = 0; p < groups.size(); ++p)
      if (includes(p))
        {
          const unsigned int g = groups[p];
          const double factor  = by_coupling[g] + group_square[g] * by_mean[g];
          for (unsigned int a = p * n_g; a < (p + 1) * n_g; ++a)
            stress_changes[a] += by_mean[g] * coupling[a] + factor * mean[a];
        }
  }

  template class VolumeAverage<2>;
  template class VolumeAverage<3>;
} // namespace impm
