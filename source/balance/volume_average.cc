#include <impm/balance/volume_average.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace impm
{
  using namespace dealii;

  template <int dim>
  VolumeAverage<dim>::VolumeAverage(const MaterialPoints<dim> &points,
                                    const Kinematics<dim>     &kinematics)
    : kinematics(kinematics)
  {
    if (points.all_materials(
          [](const Material &material) { return !material.average_volume; }))
      return;
    groups.assign(points.size(), numbers::invalid_unsigned_int);
    std::map<std::pair<unsigned int, unsigned int>, unsigned int>
                 group_of; // by cell and body
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        if (points.material(p).average_volume)
          {
            const auto cell = particle.get_surrounding_cell();
            groups[p] =
              group_of
                .try_emplace({cell->active_cell_index(), points.body(p)},
                             group_of.size())
                .first->second;
          }
        ++p;
      }
    if (group_of.empty())
      groups.clear();
    start_volume.resize(groups.size());
    jacobian.resize(groups.size());
    mean.resize(groups.size() * kinematics.size);
    coupling.resize(groups.size() * kinematics.size);
    if (!points.all_materials([](const Material &material) {
          return !material.average_volume || material.has_symmetric_tangent();
        }))
      left_coupling.resize(coupling.size());
    square.resize(groups.size());
    group_volume.resize(group_of.size());
    for (unsigned int q = 0; q < groups.size(); ++q)
      if (includes(q))
        {
          start_volume[q] = points.initial_volume(q) *
                            determinant(points.layout.load_tensor(
                              points.fields(q) + points.offset_deformation));
          group_volume[groups[q]] += start_volume[q];
        }
  }

  template <int dim>
  PointBatch
  VolumeAverage<dim>::next_batch(unsigned int first) const
  {
    const unsigned int n = groups.size();
    while (first < n && !includes(first))
      ++first;
    unsigned int size = 0;
    while (size < n_lanes && first + size < n && includes(first + size))
      ++size;
    return {first, size};
  }

  template <int dim>
  bool
  VolumeAverage<dim>::measure(const std::vector<double> &gradients,
                              const bool                 with_tangent)
  {
    group_change.assign(group_volume.size(), 0.);
    group_pressure.assign(group_volume.size(), 0.);
    if (with_tangent)
      group_square.assign(group_volume.size(), 0.);
    typename Kinematics<dim>::template List<Lanes> gradient;
    for (auto batch = next_batch(0); batch.size > 0;
         batch      = next_batch(batch.first + batch.size))
      {
             batch.load(gradients, kinematics.size, gradient.data());
             const Lanes change =
               determinant(kinematics.deformation(gradient.data()));
             if (!all_of(change > 0.))
          return false;
        batch.scatter(change, [&](const double value, const unsigned int p) {
          jacobian[p] = value;
          group_change[groups[p]] += start_volume[p] * value;
        });
      }
    return true;
  }

  template <int dim>
  double
  VolumeAverage<dim>::factor(const unsigned int point) const
  {
    const unsigned int g = groups[point];
    const double ratio   = group_change[g] / group_volume[g] / jacobian[point];
    return kinematics.n_dilating == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
  }

  template <int dim>
  void
  VolumeAverage<dim>::take_out_pressure(const PointBatch          &batch,
                                        const Lanes               &volume,
                                        const Tensor<2, 3, Lanes> &inverse,
                                        Material::Responses       &response,
                                        Lanes                     *matrix)
  {
    const unsigned int n_g = kinematics.size;
    const double       n   = kinematics.n_dilating;
    auto              &tau = response.kirchhoff_stress;
    Lanes              pi  = 0.;
    for (unsigned int i = 0; i < n; ++i)
      pi += tau[i][i] / n;
    batch.scatter(volume * pi, [&](const double value, const unsigned int p) {
      group_pressure[groups[p]] += value;
    });

    if (matrix != nullptr)
      {
        using List = typename Kinematics<dim>::template List<Lanes>;
        // K is `matrix`.
        const bool symmetric = left_coupling.empty();
        const auto e         = kinematics.list(unit_symmetric_tensor<3>());
        const auto t         = kinematics.list(tau);
        List       Ke{}, eK{};
        Lanes      eKe = 0.;
        for (unsigned int a = 0; a < n_g; ++a)
          {
            for (unsigned int b = 0; b < n_g; ++b)
              Ke[a] += matrix[a * n_g + b] * e[b];
            for (unsigned int b = 0; b < n_g && !symmetric; ++b)
              eK[a] += e[b] * matrix[b * n_g + a];
            eKe += e[a] * Ke[a];
          }
        if (symmetric)
          eK = Ke;
        // A = (1 - ee/n) K (1 - ee/n) - (te + et)/n + pi/n ee + pi X, where
        // g.X.h = tr(g h); then b, b' and c of the class.
        const auto coupling_by = [&](const List &changes) {
          List b{};
          for (unsigned int k = 0; k < n_g; ++k)
            b[k] =
              changes[k] / n - eKe / (n * n) * e[k] + t[k] / n - pi / n * e[k];
          return b;
        };
        for (unsigned int k = 0; k < n_g; ++k)
          for (unsigned int l = 0; l < n_g; ++l)
            matrix[k * n_g + l] += -(Ke[k] * e[l] + e[k] * eK[l]) / n +
                                   eKe / (n * n) * (e[k] * e[l]) -
                                   (t[k] * e[l] + e[k] * t[l]) / n +
                                   pi / n * (e[k] * e[l]);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            matrix[(dim * i + j) * n_g + dim * j + i] += pi;
        if (kinematics.axisymmetric)
          matrix[n_g * n_g - 1] += pi;
        List carried;
        kinematics.carry_back(coupling_by(Ke), inverse, volume, carried.data());
        batch.store(carried.data(), coupling, n_g);
        if (!symmetric)
          {
            kinematics.carry_back(coupling_by(eK),
                                  inverse,
                                  volume,
                                  carried.data());
            batch.store(carried.data(), left_coupling, n_g);
          }
        batch.scatter(volume * (eKe / (n * n) + pi / n - pi),
                      [&](const double value, const unsigned int p) {
                        square[p] = value;
                        group_square[groups[p]] += value;
                      });
      }
    for (unsigned int i = 0; i < n; ++i)
      tau[i][i] -= pi;
  }

  template <int dim>
  void
  VolumeAverage<dim>::share_pressure(const std::vector<double> &gradients,
                                     const bool                 with_tangent,
                                     const AddShare            &add)
  {
    using List             = typename Kinematics<dim>::template List<Lanes>;
    const unsigned int n_g = kinematics.size;
    const auto         e   = kinematics.list(unit_symmetric_tensor<3, Lanes>());
    List               gradient, m, stress;
    typename Kinematics<dim>::template Matrix<Lanes> A;
    for (auto batch = next_batch(0); batch.size > 0;
         batch      = next_batch(batch.first + batch.size))
      {
             const Lanes share    = batch.gather([&](const unsigned int p) {
          return start_volume[p] * jacobian[p] / group_change[groups[p]];
        });
             const Lanes pressure = batch.gather(
          [&](const unsigned int p) { return group_pressure[groups[p]]; });
             batch.load(gradients, n_g, gradient.data());
             const auto inverse = invert(kinematics.deformation(gradient.data()));
             kinematics.carry_back(e, inverse, share, m.data());
             for (unsigned int a = 0; a < n_g; ++a)
          stress[a] = pressure * m[a];
        if (with_tangent)
          {
                 // From the second derivative of ln theta:
            // share (tr g tr h - tr(g h)).
            batch.store(m.data(), mean, n_g);
            for (unsigned int a = 0; a < n_g; ++a)
              for (unsigned int b = 0; b < n_g; ++b)
                A[a * n_g + b] = pressure / share * m[a] * m[b];
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                for (unsigned int k = 0; k < dim; ++k)
                  for (unsigned int l = 0; l < dim; ++l)
                    A[(dim * i + j) * n_g + dim * k + l] -=
                      pressure * share * inverse[j][k] * inverse[l][i];
            if (kinematics.axisymmetric)
              A[n_g * n_g - 1] -=
                pressure * share * inverse[2][2] * inverse[2][2];
          }
        add(batch, stress, A);
      }
  }

  template <int dim>
  void
  VolumeAverage<dim>::apply_coupling(
    const std::vector<double> &gradient_changes,
    std::vector<double>       &stress_changes) const
  {
    const unsigned int n_g = kinematics.size;
    by_mean.assign(group_volume.size(), 0.);
    by_coupling.assign(group_volume.size(), 0.);
    for (unsigned int p = 0; p < groups.size(); ++p)
      if (includes(p))
        {
          const double *left = left_of(p), *change = &gradient_changes[p * n_g];
          for (unsigned int a = 0; a < n_g; ++a)
            {
              by_mean[groups[p]] += mean[p * n_g + a] * change[a];
              by_coupling[groups[p]] += left[a] * change[a];
            }
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
