#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <impm/balance/point_response.h>

#include <algorithm>
#include <utility>

namespace impm
{
  using namespace dealii;

  template <int dim>
  PointResponse<dim>::PointResponse(const Bodies<dim>         &bodies,
                                    const MaterialPoints<dim> &points,
                                    const double               dt,
                                    unsigned long             &n_evaluations)
    : kinematics(points.layout.geometry == GeometryKind::axisymmetric)
    , average(bodies, points, kinematics)
    , points(points)
    , dt(dt)
    , n_evaluations(n_evaluations)
    , n_stress(
        points.offset_stress > 0 ?
          points.layout.n_components(PointLayout::Kind::symmetric_tensor) :
          0)
  {
    if (points.layout.geometry == GeometryKind::plane_stress)
      plane_stress.emplace();
    const unsigned int n = points.size(), n_g = kinematics.size;
    gradients.assign(n * n_g, 0.);
    stresses.resize(n * n_g);
    histories.resize(n * points.history_size());
    end_stresses.resize(n * n_stress);
    thickening.assign(plane_stress ? n : 0, 1.);
  }

  template <int dim>
  Tensor<2, 3>
  PointResponse<dim>::increment(const unsigned int point) const
  {
    auto dF = kinematics.deformation(&gradients[point * kinematics.size]);
    if (plane_stress)
      dF[2][2] = thickening[point];
    return average.includes(point) ? average.average(point, dF) : dF;
  }

  template <int dim>
  void
  PointResponse<dim>::begin_batch(Batch &batch) const
  {
    batch.law = &points.material(batch.first);
    const unsigned int most =
      std::min(Batch::max_size, points.size() - batch.first);
    batch.size = 1;
    while (batch.size < most &&
           &points.material(batch.first + batch.size) == batch.law)
      ++batch.size;
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate_law(Batch &batch, const bool with_tangent)
  {
    const unsigned int n = batch.size;
    for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int p      = batch.first + i;
        const double      *fields = points.fields(p);
        batch.start[i] =
          points.layout.load_tensor(fields + points.offset_deformation);
        batch.history[i]       = fields + points.offset_history;
        batch.trial_history[i] = histories.data() + p * points.history_size();
        batch.increment[i] =
          kinematics.deformation(&gradients[p * kinematics.size]);
      }
    if (plane_stress)
      {
        for (unsigned int i = 0; i < n; ++i)
          {
            if (!plane_stress->evaluate(*batch.law,
                                        batch.start[i],
                                        dt,
                                        batch.history[i],
                                        batch.trial_history[i],
                                        batch.increment[i],
                                        batch.response[i],
                                        with_tangent ? batch.spatial[i].data() :
                                                       nullptr))
              return false;
            thickening[batch.first + i] = batch.increment[i][2][2];
          }
        return true;
      }
    if (average.includes(batch.first))
      for (unsigned int i = 0; i < n; ++i)
        batch.increment[i] =
          average.average(batch.first + i, batch.increment[i]);
    for (unsigned int i = 0; i < n; ++i)
      batch.total[i] = batch.increment[i] * batch.start[i];
    if (!batch.law->evaluate({n,
                              batch.increment.data(),
                              batch.total.data(),
                              dt,
                              batch.history.data(),
                              batch.trial_history.data()},
                             with_tangent,
                             batch.response.data()))
      return false;
    if (with_tangent)
      {
        const auto form = batch.law->form();
        for (unsigned int i = 0; i < n; ++i)
          kinematics.spatial_tangent(batch.response[i],
                                     form,
                                     batch.spatial[i].data());
      }
    return true;
  }

  template <int dim>
  void
  PointResponse<dim>::carry_back(Batch     &batch,
                                 const bool with_tangent,
                                 double    &potential)
  {
    const unsigned int n_g = kinematics.size, n = batch.size;
    const bool linearized = batch.law->form() == Material::Form::linearized;
    const auto volume     = [&](const unsigned int i) {
      return points.initial_volume(batch.first + i);
    };
    for (unsigned int i = 0; i < n; ++i)
      potential += volume(i) * batch.response[i].potential;
    if (n_stress > 0)
      for (unsigned int i = 0; i < n; ++i)
        {
          // that of a linearized law counts from the volume at the start
          const double growth =
            linearized ? determinant(batch.increment[i]) : 1.;
          points.layout.store_symmetric(
            growth * batch.response[i].kirchhoff_stress,
            &end_stresses[(batch.first + i) * n_stress]);
        }
    if (linearized)
      batch.inverse.fill(unit_symmetric_tensor<3>());
    else
      for (unsigned int i = 0; i < n; ++i)
        batch.inverse[i] =
          invert(kinematics.deformation(&gradients[(batch.first + i) * n_g]));
    if (average.includes(batch.first))
      for (unsigned int i = 0; i < n; ++i)
        average.take_out_pressure(batch.first + i,
                                  volume(i),
                                  batch.inverse[i],
                                  batch.response[i],
                                  with_tangent ? batch.spatial[i].data() :
                                                 nullptr);
    for (unsigned int i = 0; i < n; ++i)
      kinematics.carry_back_stress(batch.response[i].kirchhoff_stress,
                                   batch.inverse[i],
                                   volume(i),
                                   &stresses[(batch.first + i) * n_g]);
    if (with_tangent)
      for (unsigned int i = 0; i < n; ++i)
        kinematics.carry_back_tangent(batch.spatial[i].data(),
                                      batch.inverse[i],
                                      volume(i),
                                      &tangents[(batch.first + i) * n_g * n_g]);
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate(const bool with_tangent, double &potential)
  {
    n_evaluations += plane_stress ? 0 : points.size();
    if (!average.measure(gradients, with_tangent))
      return false;
    if (with_tangent) // explicit steps never ask for it
      tangents.resize(points.size() * kinematics.size * kinematics.size);
    Batch batch;
    for (batch.first = 0; batch.first < points.size();
         batch.first += batch.size)
      {
        begin_batch(batch);
        if (!evaluate_law(batch, with_tangent))
          return false;
        carry_back(batch, with_tangent, potential);
      }
    average.share_pressure(gradients, with_tangent, stresses, tangents);
    if (plane_stress)
      n_evaluations += std::exchange(plane_stress->n_evaluations, 0);
    return true;
  }

  template <int dim>
  bool
  PointResponse<dim>::evaluate_start()
  {
    if (n_stress > 0)
      {
        const Tensor<2, 3> unit = unit_symmetric_tensor<3>();
        start_stresses.resize(stresses.size());
        for (unsigned int p = 0; p < points.size(); ++p)
          kinematics.carry_back_stress(points.layout.load_symmetric(
                                         points.fields(p) +
                                         points.offset_stress),
                                       unit,
                                       points.initial_volume(p),
                                       &start_stresses[p * kinematics.size]);
        return true;
      }
    double       potential = 0;
    const double length    = std::exchange(dt, 0.);
    const bool   fine      = evaluate(false, potential);
    dt                     = length;
    start_stresses         = stresses;
    return fine;
  }

  template <int dim>
  double
  PointResponse<dim>::work() const
  {
    double sum = 0;
    for (unsigned int i = 0; i < gradients.size(); ++i)
      sum += 0.5 * (start_stresses[i] + stresses[i]) * gradients[i];
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
        const double *A = tangent(p);
        const double *g = &gradient_changes[p * n_g];
        double       *s = &stress_changes[p * n_g];
        for (unsigned int a = 0; a < n_g; ++a)
          {
            double sum = 0;
            for (unsigned int b = 0; b < n_g; ++b)
              sum += A[a * n_g + b] * g[b];
            s[a] = sum;
          }
      }
    average.apply_coupling(gradient_changes, stress_changes);
  }

  namespace
  {
    /** The positive part of a symmetric matrix, given by rows. */
    void
    make_positive(const unsigned int n, double *A)
    {
      LAPACKFullMatrix<double> matrix(n);
      FullMatrix<double>       vectors(n);
      dealii::Vector<double>   values;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          matrix(a, b) = 0.5 * (A[a * n + b] + A[b * n + a]);
      const double bound = matrix.frobenius_norm();
      matrix.compute_eigenvalues_symmetric(
        -2 * bound, 2 * bound, 1e-14 * bound, values, vectors);
      if (values.size() < n || values[0] >= 0)
        return;
      std::fill(A, A + n * n, 0.);
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            A[a * n + b] +=
              std::max(values[k], 0.) * vectors(a, k) * vectors(b, k);
    }
  } // namespace

  template <int dim>
  void
  PointResponse<dim>::project_tangent()
  {
    const unsigned int  n_g = kinematics.size, m = n_g + 1;
    std::vector<double> bordered(m * m);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        double *A = &tangents[p * n_g * n_g];
        if (!average.includes(p))
          {
            make_positive(n_g, A);
            continue;
          }
        // The form in (g, d ln theta) of a point.
        double *b = &average.coupling[p * n_g];
        for (unsigned int i = 0; i < n_g; ++i)
          {
            std::copy_n(A + i * n_g, n_g, &bordered[i * m]);
            bordered[i * m + n_g] = bordered[n_g * m + i] = b[i];
          }
        bordered[m * m - 1] = average.square[p];
        make_positive(m, bordered.data());
        for (unsigned int i = 0; i < n_g; ++i)
          {
            std::copy_n(&bordered[i * m], n_g, A + i * n_g);
            b[i] = bordered[i * m + n_g];
          }
        average.group_square[average.groups[p]] +=
          bordered[m * m - 1] - average.square[p];
        average.square[p] = bordered[m * m - 1];
      }
  }

  template <int dim>
  void
  PointResponse<dim>::add_squares_of_stresses(
    const std::vector<unsigned int> &group_of_body,
    std::vector<double>             &squares) const
  {
    const unsigned int n_g = kinematics.size;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        double sum = 0;
        for (unsigned int a = p * n_g; a < (p + 1) * n_g; ++a)
          sum += stresses[a] * stresses[a];
        squares[group_of_body[points.body(p)]] += sum;
      }
  }

  template class PointResponse<2>;
  template class PointResponse<3>;
} // namespace impm
