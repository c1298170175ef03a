#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <impm/balance/point_response.h>

#include <utility>

namespace impm
{
  using namespace dealii;

  template <int dim>
  PointResponse<dim>::PointResponse(const Scene<dim>          &scene,
                                    const MaterialPoints<dim> &points)
    : kinematics(scene.geometry == GeometryKind::axisymmetric)
    , average(scene, points, kinematics)
    , points(points)
    , n_stress(
        points.offset_stress > 0 ?
          points.layout.n_components(PointLayout::Kind::symmetric_tensor) :
          0)
  {
    if (scene.geometry == GeometryKind::plane_stress)
      plane_stress.emplace();
  }

  template <int dim>
  void
  PointResponse<dim>::begin_step(const double dt)
  {
    this->dt             = dt;
    const unsigned int n = points.size(), n_g = kinematics.size;
    gradients.assign(n * n_g, 0.);
    stresses.resize(n * n_g);
    tangents.resize(n * n_g * n_g);
    histories.resize(n * points.history_size());
    end_stresses.resize(n * n_stress);
    thickening.assign(plane_stress ? n : 0, 1.);
    average.begin_step();
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
  bool
  PointResponse<dim>::evaluate(const bool with_tangent, double &potential)
  {
    n_evaluations += plane_stress ? 0 : points.size();
    if (!average.measure(gradients))
      return false;
    const unsigned int               n_g = kinematics.size;
    Material::Deformation            deformation;
    Material::Response               response;
    typename Kinematics<dim>::Matrix spatial;
    deformation.dt = dt;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const auto   &law     = points.material(p);
        const double *fields  = points.fields(p);
        const double *history = fields + points.offset_history;
        double       *trial   = &histories[p * points.history_size()];
        const auto    start =
          points.layout.load_tensor(fields + points.offset_deformation);
        const auto dF = kinematics.deformation(&gradients[p * n_g]);
        deformation.increment =
          average.includes(p) ? average.average(p, dF) : dF;
        if (plane_stress)
          {
            if (!plane_stress->evaluate(law,
                                        start,
                                        history,
                                        trial,
                                        deformation,
                                        response,
                                        with_tangent ? spatial.data() :
                                                       nullptr))
              return false;
            thickening[p] = deformation.increment[2][2];
          }
        else
          {
            deformation.total = deformation.increment * start;
            if (!law.evaluate(
                  deformation, history, trial, with_tangent, response))
              return false;
            if (with_tangent)
              kinematics.spatial_tangent(response, law.form(), spatial.data());
          }
        const double volume  = points.initial_volume(p);
        const auto   inverse = law.form() == Material::Form::linearized ?
                                 Tensor<2, 3>(unit_symmetric_tensor<3>()) :
                                 invert(dF);
        potential += volume * response.potential;
        if (n_stress > 0)
          {
            // that of a linearized law counts from the volume at the start
            const double growth = law.form() == Material::Form::linearized ?
                                    determinant(deformation.increment) :
                                    1.;
            points.layout.store_symmetric(growth * response.kirchhoff_stress,
                                          &end_stresses[p * n_stress]);
          }
        if (average.includes(p))
          average.take_out_pressure(p,
                                    volume,
                                    inverse,
                                    response,
                                    with_tangent ? spatial.data() : nullptr);
        kinematics.carry_back_stress(response.kirchhoff_stress,
                                     inverse,
                                     volume,
                                     &stresses[p * n_g]);
        if (with_tangent)
          kinematics.carry_back_tangent(spatial.data(),
                                        inverse,
                                        volume,
                                        &tangents[p * n_g * n_g]);
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
        for (unsigned int p = 0; p < points.size(); ++p)
          kinematics.carry_back_stress(points.layout.load_symmetric(
                                         points.fields(p) +
                                         points.offset_stress),
                                       unit,
                                       points.initial_volume(p),
                                       &stresses[p * kinematics.size]);
        return true;
      }
    double       potential = 0;
    const double length    = std::exchange(dt, 0.);
    const bool   fine      = evaluate(false, potential);
    dt                     = length;
    return fine;
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
  double
  PointResponse<dim>::square_of_stresses() const
  {
    double sum = 0;
    for (const double s : stresses)
      sum += s * s;
    return sum;
  }

  template class PointResponse<2>;
  template class PointResponse<3>;
} // namespace impm
