#include <impm/balance/plane_stress.h>

#include <cmath>
#include <limits>

namespace impm
{
  bool
  evaluate_plane_stress(const Material             &material,
                        const dealii::Tensor<2, 3> &start,
                        const double                dt,
                        const double               *history,
                        double                     *trial_history,
                        dealii::Tensor<2, 3>       &increment,
                        Material::Response         &response,
                        double                     *matrix,
                        unsigned long              &n_evaluations)
  {
    // with the thickness as the hoop of axisymmetry
    const Kinematics<2>     thick(true);
    Kinematics<2>::Matrix<> space;
    constexpr unsigned int  n = 5, h = n - 1;
    constexpr double        infinity = std::numeric_limits<double>::infinity();
    const auto              form     = material.form();

    // Newton's method for the strain across: ln dF_33, or the linear one. The
    // stress that the law knows, tau or (by volume at t_n or as tau / J) sigma,
    // grows with it, so what has been seen brackets the root, and where a
    // kink would throw the iteration out, the bracket is halved.
    double strain = 0, last = infinity, lower = -infinity, upper = infinity;
    for (unsigned int iteration = 0;; ++iteration)
      {
        increment[2][2] =
          form == Material::Form::linearized ? 1 + strain : std::exp(strain);
        ++n_evaluations;
        if (iteration == 60 ||
            !material.evaluate_one(
              {increment, increment * start, dt, history, trial_history},
              true,
              response))
          return false;
        thick.spatial_tangent(response, form, space.data());
        const double stress = response.kirchhoff_stress[2][2];
        const double slope =
          space[h * n + h] + (form == Material::Form::spatial ? stress : 0.);
        const double step = -stress / slope;
        if (!(slope > 0) || !std::isfinite(step))
          return false;
        const double size = std::abs(step);
        if (size <= 1e-14 || (size <= 1e-11 && size >= 0.5 * last))
          break; // done, or at round-off
        last                       = size;
        (step > 0 ? lower : upper) = strain;
        strain += step;
        if (!(strain > lower && strain < upper))
          strain = 0.5 * (lower + upper);
      }
    if (matrix == nullptr)
      return true;
    for (unsigned int a = 0; a < h; ++a)
      for (unsigned int b = 0; b < h; ++b)
        matrix[a * h + b] = space[a * n + b] - space[a * n + h] /
                                                 space[h * n + h] *
                                                 space[h * n + b];
    return true;
  }
} // namespace impm
