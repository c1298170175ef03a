#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <impm/balance/plane_stress.h>
#include <impm/balance/point_response.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Adds the values of points to a list that has n for each. */
    template <typename ValueOf>
    void
    add_to(std::vector<double> &list,
           const unsigned int   n,
           const PointBatch    &batch,
           const ValueOf       &value_of)
    {
      for (unsigned int i = 0; i < n; ++i)
        batch.scatter(value_of(i),
                      [&](const double value, const unsigned int p) {
                        list[p * n + i] += value;
                      });
    }
  } // namespace

  template <int dim>
  PointResponse<dim>::PointResponse(const MaterialPoints<dim> &points,
                                    const double               dt,
                                    const double               end_time,
                                    const bool     acts_in_the_middle,
                                    unsigned long &n_evaluations)
    : kinematics(points.layout.geometry == GeometryKind::axisymmetric)
    , average(points, kinematics)
    , acts_in_the_middle(acts_in_the_middle)
    , gradients(points.size() * kinematics.size)
    , stresses(points.size() * kinematics.size)
    , points(points)
    , is_plane_stress(points.layout.geometry == GeometryKind::plane_stress)
    , dt(dt)
    , n_evaluations(n_evaluations)
    , histories(points.size() * points.history_size())
    , thermal(points, end_time, histories)
    , n_stress(
        points.offset_stress > 0 ?
          points.layout.n_components(PointLayout::Kind::symmetric_tensor) :
          0)
    , end_stresses(points.size() * n_stress)
    , thickening(is_plane_stress ? points.size() : 0, 1.)
    , traces(thermal.exists() ? points.size() : 0)
  {
    const unsigned int n = kinematics.size;
    const bool         symmetric =
      !acts_in_the_middle && points.all_materials([](const Material &material) {
        return material.has_symmetric_tangent();
      });
    place_of_entry.resize(n * n);
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int b = 0; b < n; ++b)
        if (b <= a || !symmetric)
          {
            place_of_entry[a * n + b] = entries.size();
            if (symmetric)
              place_of_entry[b * n + a] = entries.size();
            entries.push_back(a * n + b);
          }
  }

  template <int dim>
  unsigned int
  PointResponse<dim>::evaluate_batch(const unsigned int first,
                                     const bool         with_tangent,
                                     Batch             &batch)
  {
    batch.law   = &points.material(first);
    batch.first = first;
    batch.size  = 1;
    while (batch.size < n_lanes && first + batch.size < points.size() &&
           &points.material(first + batch.size) == batch.law)
      ++batch.size;

    batch.load(gradients, kinematics.size, batch.gradient.data());
    batch.increment = kinematics.deformation(batch.gradient.data());
    if (average.includes(first))
      average.dilate(batch.gather(
                       [&](const unsigned int p) { return average.factor(p); }),
                     batch.increment);
    if (!evaluate_law(batch, with_tangent))
      return 0;
    carry_back(batch, with_tangent);
    return batch.size;
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate_law(Batch &batch, const bool with_tangent)
  {
    auto start = points.layout.load_tensor(batch.template places<const double>(
      [&](auto p) { return points.fields(p) + points.offset_deformation; }));
    const auto history = batch.template places<const double>(
      [&](auto p) { return points.fields(p) + points.offset_history; });
    const auto trial_history = batch.template places<double>(
      [&](auto p) { return histories.data() + p * points.history_size(); });
    Lanes     *matrix  = with_tangent ? batch.spatial.data() : nullptr;
    const auto form    = batch.law->form();
    const bool expands = batch.law->expands();
    auto       seen    = batch.increment;
    if (expands)
      thermal.take_out(batch, form, seen, start);
    if (is_plane_stress)
      {
        Lanes      count = 0.;
        const bool fine  = evaluate_plane_stress(*batch.law,
                                                start,
                                                dt,
                                                history,
                                                trial_history,
                                                seen,
                                                batch.response,
                                                matrix,
                                                count);
        batch.scatter(count, [&](const double n, unsigned int) {
          n_evaluations += static_cast<unsigned long>(n);
        });
        batch.increment[2][2] =
          expands ? thermal.put_back(batch, form, seen[2][2]) : seen[2][2];
        batch.store(&batch.increment[2][2], thickening, 1);
        return fine;
      }
    n_evaluations += batch.size;
    batch.total = seen * start;
    if (!batch.law->evaluate({seen, batch.total, dt, history, trial_history},
                             with_tangent,
                             batch.response))
      return false;
    if (with_tangent)
      kinematics.spatial_tangent(batch.response, form, matrix);
    return true;
  }

  template <int dim>
  void
  PointResponse<dim>::carry_back(Batch &batch, const bool with_tangent)
  {
    const unsigned int n_g = kinematics.size;
    const bool linearized  = batch.law->form() == Material::Form::linearized;
    auto      &response    = batch.response;
    const auto volume      = batch.gather(
      [&](const unsigned int p) { return points.initial_volume(p); });
    batch.scatter(volume * response.potential,
                  [&](const double value, unsigned int) {
                    potential += value;
                  });
    if (thermal.exists())
      batch.scatter(volume * trace(response.kirchhoff_stress),
                    [&](const double value, const unsigned int p) {
                      traces[p] = value;
                    });
    if (n_stress > 0)
      {
        // that of a linearized law counts from the volume at the start
        auto stress = response.kirchhoff_stress;
        if (linearized)
          stress *= determinant(batch.increment);
        points.layout.store_symmetric(
          stress, batch.template places<double>([&](const unsigned int p) {
            return &end_stresses[p * n_stress];
          }));
      }
    const Tensor<2, 3, Lanes> inverse =
      linearized ? Tensor<2, 3, Lanes>(unit_symmetric_tensor<3, Lanes>()) :
                   invert(kinematics.deformation(batch.gradient.data()));
    Lanes *matrix = with_tangent ? batch.spatial.data() : nullptr;
    if (average.includes(batch.first))
      average.take_out_pressure(batch, volume, inverse, response, matrix);
    typename Kinematics<dim>::template List<Lanes> stress;
    kinematics.carry_back(kinematics.list(response.kirchhoff_stress),
                          inverse,
                          volume,
                          stress.data());
    batch.store(stress.data(), stresses, n_g);
    if (!with_tangent)
      return;
    typename Kinematics<dim>::template Matrix<Lanes> tangent;
    kinematics.carry_back_tangent(matrix, inverse, volume, tangent.data());
    const auto to = batch.template places<double>(
      [&](const unsigned int p) { return &tangents[p * entries.size()]; });
    for (unsigned int k = 0; k < entries.size(); ++k)
      write(tangent[entries[k]], to, k);
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate(const bool with_tangent)
  {
    if (!with_tangent || !thermal.exists() ||
        !std::exchange(is_first_tangent, false))
      return evaluate_points(with_tangent);
    thermal.is_at_start = true;
    const bool fine     = evaluate_points(true);
    thermal.is_at_start = false;
    return fine && evaluate_points(false);
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate_points(const bool with_tangent)
  {
    potential = 0;
    if (!average.measure(gradients, with_tangent))
      return false;
    if (with_tangent) // explicit steps never ask for it
      tangents.resize(points.size() * entries.size());
    Batch        batch;
    unsigned int size = 0;
    for (unsigned int p = 0; p < points.size(); p += size)
      if ((size = evaluate_batch(p, with_tangent, batch)) == 0)
        return false;
    average.share_pressure(
      gradients,
      with_tangent,
      [&](const auto &shared, const auto &stress, const auto &tangent) {
        add_to(stresses, kinematics.size, shared, [&](const unsigned int a) {
          return stress[a];
        });
        if (with_tangent)
          add_to(tangents, entries.size(), shared, [&](const unsigned int k) {
            return tangent[entries[k]];
          });
      });
    if (acts_in_the_middle && !start_stresses.empty())
      act_in_the_middle(with_tangent);
    return true;
  }

  template <int dim>
  void
  PointResponse<dim>::act_in_the_middle(const bool with_tangent)
  {
    const unsigned int n = kinematics.size;
    turns.resize(stresses.size());
    acting_stresses.resize(stresses.size());
    // Tensors as lists; a symmetric one acts from the right.
    const auto tensor = [&](const double *list) {
      Tensor<2, 3> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result[i][j] = list[dim * i + j];
      if (kinematics.axisymmetric)
        result[2][2] = list[dim * dim];
      return result;
    };
    const auto store = [&](const Tensor<2, 3> &value, double *list) {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          list[dim * i + j] = value[i][j];
      if (kinematics.axisymmetric)
        list[dim * dim] = value[2][2];
    };
    const Tensor<2, 3> unit = unit_symmetric_tensor<3>();
    typename Kinematics<dim>::template Matrix<> A, turned;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const auto dF      = kinematics.deformation(&gradients[p * n]);
        const auto inverse = invert(dF);
        const auto middle  = 0.5 * (unit + dF);
        const auto T       = middle * inverse;
        const auto start   = tensor(&start_stresses[p * n]);
        const auto end     = tensor(&stresses[p * n]);
        store(T, &turns[p * n]);
        store((middle - unit) * start + T * end, &acting_stresses[p * n]);
        if (!with_tangent)
          continue;
        double *list = &tangents[p * n * n]; // of all entries, in their order
        std::copy_n(list, n * n, A.begin());
        const auto S    = inverse * end;
        const auto mean = 0.5 * (start + S);
        turned.fill(0.);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            {
              double *row = &turned[(dim * i + j) * n];
              for (unsigned int m = 0; m < dim; ++m)
                for (unsigned int b = 0; b < n; ++b)
                  row[b] += T[i][m] * A[(dim * m + j) * n + b];
              for (unsigned int l = 0; l < dim; ++l)
                {
                  row[dim * i + l] += mean[l][j];
                  for (unsigned int k = 0; k < dim; ++k)
                    row[dim * k + l] -= T[i][k] * S[l][j];
                }
            }
        if (kinematics.axisymmetric)
          {
            const unsigned int h = dim * dim;
            for (unsigned int b = 0; b < n; ++b)
              turned[h * n + b] = T[2][2] * A[h * n + b];
            turned[h * n + h] += mean[2][2] - T[2][2] * S[2][2];
          }
        std::copy_n(turned.begin(), n * n, list);
      }
  }

  template <int dim>
  typename Kinematics<dim>::template List<>
  PointResponse<dim>::turn(const unsigned int point, const double *list) const
  {
    typename Kinematics<dim>::template List<> result{};
    const double *T = &turns[point * kinematics.size];
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        for (unsigned int m = 0; m < dim; ++m)
          result[dim * i + j] += T[dim * i + m] * list[dim * m + j];
    if (kinematics.axisymmetric)
      result[dim * dim] = T[dim * dim] * list[dim * dim];
    return result;
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate_start()
  {
    if (n_stress == 0)
      {
        const double length = std::exchange(dt, 0.);
        thermal.is_at_start = true;
        const bool fine     = evaluate(false);
        dt                  = length;
        thermal.is_at_start = false;
        start_stresses      = stresses;
        start_potential     = potential;
        start_traces        = traces;
        return fine;
      }
    const Tensor<2, 3> unit = unit_symmetric_tensor<3>();
    start_stresses.resize(stresses.size());
    for (unsigned int p = 0; p < points.size(); ++p)
      kinematics.carry_back(kinematics.list(points.layout.load_symmetric(
                              points.fields(p) + points.offset_stress)),
                            unit,
                            points.initial_volume(p),
                            &start_stresses[p * kinematics.size]);
    start_traces.resize(traces.size());
    for (unsigned int p = 0; p < start_traces.size(); ++p)
      start_traces[p] =
        points.initial_volume(p) * trace(points.layout.load_symmetric(
                                     points.fields(p) + points.offset_stress));
    return true;
  }

  template <int dim>
  double
  PointResponse<dim>::work() const
  {
    const auto &end = acting();
    double      sum = 0;
    for (unsigned int i = 0; i < gradients.size(); ++i)
      sum += 0.5 * (start_stresses[i] + end[i]) * gradients[i];
    return sum;
  }

  template <int dim>
  double
  PointResponse<dim>::work_of_heat() const
  {
    double sum = 0;
    for (unsigned int p = 0; p < traces.size(); ++p)
      sum -= 0.5 * (start_traces[p] + traces[p]) * thermal.change(p);
    return sum;
  }

  template <int dim>
  void
  PointResponse<dim>::apply_tangent(const std::vector<double> &gradient_changes,
                                    std::vector<double> &stress_changes) const
  {
    const unsigned int n_g = kinematics.size;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double *g = &gradient_changes[p * n_g];
        double       *s = &stress_changes[p * n_g];
        for (unsigned int a = 0; a < n_g; ++a)
          {
            double sum = 0;
            for (unsigned int b = 0; b < n_g; ++b)
              sum += tangent(p, a, b) * g[b];
            s[a] = sum;
          }
      }
    if (!acts_in_the_middle || average.groups.empty())
      {
        average.apply_coupling(gradient_changes, stress_changes);
        return;
      }
    coupled.assign(stress_changes.size(), 0.);
    average.apply_coupling(gradient_changes, coupled);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const auto turned = turn(p, &coupled[p * n_g]);
        for (unsigned int a = 0; a < n_g; ++a)
          stress_changes[p * n_g + a] += turned[a];
      }
  }

  namespace
  {
    /** Takes the positive part of a symmetric matrix. */
    void
    make_positive(FullMatrix<double> &matrix)
    {
      const unsigned int       n = matrix.m();
      LAPACKFullMatrix<double> symmetric(n);
      FullMatrix<double>       vectors(n);
      dealii::Vector<double>   values;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          symmetric(a, b) = 0.5 * (matrix(a, b) + matrix(b, a));
      const double bound = symmetric.frobenius_norm();
      if (!std::isfinite(bound))
        return; // the step is told of it by its residual
      // LAPACK finds all vectors if it is to be as accurate as it can.
      const double accuracy = 2 * std::numeric_limits<double>::min();
      symmetric.compute_eigenvalues_symmetric(
        -2 * bound, 2 * bound, accuracy, values, vectors);
      if (values.size() < n || values[0] >= 0)
        return;
      matrix = 0;
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            matrix(a, b) +=
              std::max(values[k], 0.) * vectors(a, k) * vectors(b, k);
    }
  } // namespace

  template <int dim>
  void
  PointResponse<dim>::project_tangent()
  {
    const unsigned int n = kinematics.size;
    FullMatrix<double> form;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        // The form in g or, with F-bar, in (g, d ln theta) of a point.
        const bool coupled = average.includes(p);
        form.reinit(n + coupled, n + coupled);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            form(i, j) = tangent(p, i, j);
        for (unsigned int i = 0; coupled && i < n; ++i)
          form(i, n) = form(n, i) = average.coupling[p * n + i];
        if (coupled)
          form(n, n) = average.square[p];
        make_positive(form);
        for (unsigned int k = 0; k < entries.size(); ++k)
          tangents[p * entries.size() + k] =
            form(entries[k] / n, entries[k] % n);
        if (!coupled)
          continue;
        for (unsigned int i = 0; i < n; ++i)
          average.coupling[p * n + i] = form(i, n);
        average.group_square[average.groups[p]] +=
          form(n, n) - average.square[p];
        average.square[p] = form(n, n);
      }
  }

  template <int dim>
  std::vector<double>
  PointResponse<dim>::squares_of_stresses(const ResidualNorm &norm) const
  {
    const unsigned int  n_g = kinematics.size;
    std::vector<double> squares(norm.n_groups());
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        double sum = 0;
        for (unsigned int a = p * n_g; a < (p + 1) * n_g; ++a)
          sum += stresses[a] * stresses[a];
        squares[norm.group_of_body[points.body(p)]] += sum;
      }
    return squares;
  }

  template class PointResponse<2>;
  template class PointResponse<3>;
} // namespace impm
