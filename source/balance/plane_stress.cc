#include <impm/balance/plane_stress.h>

#include <cmath>
#include <limits>

namespace impm
{
  bool
  evaluate_plane_stress(const Material                    &material,
                        const dealii::Tensor<2, 3, Lanes> &start,
                        const double                       dt,
                        const Places<Lanes, const double> &history,
                        const Places<Lanes, double>       &trial_history,
                        dealii::Tensor<2, 3, Lanes>       &increment,
                        Material::Responses               &response,
                        Lanes                             *matrix,
                        Lanes                             &n_evaluations)
  {
    using std::abs;
    // with the thickness as the hoop of axisymmetry
    const Kinematics<2>          thick(true);
    Kinematics<2>::Matrix<Lanes> space;
    constexpr unsigned int       n = 5, h = n - 1;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto       form     = material.form();
    const auto       exp      = [](const double x) { return std::exp(x); };

    // Newton's method for the strain across: ln dF_33, or the linear one. The
    // stress that the law knows, tau or (by volume at t_n or as tau / J) sigma,
    // grows with it, so what has been seen brackets the root, and where a
    // kink would throw the iteration out, the bracket is halved. A lane that
    // is done keeps its strain, and with it its response.
    Lanes strain = 0., last = infinity, lower = -infinity, upper = infinity;
    Lanes::mask_type is_done(false);
    for (unsigned int iteration = 0;; ++iteration)
      {
        increment[2][2] =
          form == Material::Form::linearized ? 1. + strain : each(exp, strain);
        n_evaluations += select(is_done, 0., 1.);
        if (iteration == 60 ||
            !material.evaluate(
              {increment, increment * start, dt, history, trial_history},
              true,
              response))
          return false;
        thick.spatial_tangent(response, form, space.data());
        const Lanes stress = response.kirchhoff_stress[2][2];
        const Lanes slope =
          space[h * n + h] + (form == Material::Form::spatial ? stress : 0.);
        const Lanes step = -stress / slope;
        if (!all_of(slope > 0. && is_finite(step)))
          return false;
        const Lanes size = abs(step);
        // or at round-off
        is_done =
          is_done || size <= 1e-14 || (size <= 1e-11 && size >= 0.5 * last);
        if (all_of(is_done))
          break;
        last             = size;
        lower            = select(step > 0., strain, lower);
        upper            = select(step > 0., upper, strain);
        const Lanes next = strain + step;
        strain           = select(is_done,
                        strain,
                        select(next > lower && next < upper,
                               next,
                               0.5 * (lower + upper)));
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
