#include <impm/points/deformation_drift.h>

#include <map>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Sums over the points of a body in a cell, weighed by volume. */
    template <int dim>
    struct Sums
    {
      unsigned int   n      = 0;
      double         volume = 0;
      Tensor<1, dim> x, X;   ///< position now and at the start
      Tensor<2, dim> xX, XX; ///< dyads
      Tensor<2, dim> F;

      /** Whether positions tell a gradient. */
      bool
      spans_space() const
      {
        return n > dim && determinant(around_mean(XX, X)) >
                            0.01 * Utilities::fixed_power<dim>(
                                     trace(around_mean(XX, X)) / dim);
      }

      /** Dyads with initial positions, about the means (m^2). */
      Tensor<2, dim>
      around_mean(const Tensor<2, dim> &dyads,
                  const Tensor<1, dim> &first) const
      {
        return dyads / volume - outer_product(first, X) / (volume * volume);
      }
    };

    template <int dim>
    Tensor<2, dim>
    strain(const Tensor<2, dim> &F)
    {
      return 0.5 *
             (transpose(F) * F - Tensor<2, dim>(unit_symmetric_tensor<dim>()));
    }

    /** Whether F is of the whole way of the points. Where they merge it begins
     * anew if the law minds no shape, which liquids do not even have. */
    template <int dim>
    bool
    has_whole_deformation(const BodySpec<dim> &body)
    {
      return body.adaptation != PointAdaptation::split_and_merge ?
               body.material->is_solid() :
               body.material->depends_on_shape();
    }
  } // namespace

  template <int dim>
  double
  deformation_drift(const Bodies<dim>         &bodies,
                    const MaterialPoints<dim> &points)
  {
    // Volume, and what it weighs: |E - E_x| and |E_x|.
    std::vector<double>               sums(3);
    std::map<unsigned int, Sums<dim>> of_bodies;
    const auto                        finish = [&]() {
      for (const auto &[body, sum] : of_bodies)
        if (sum.spans_space())
          {
            const auto F = sum.F / sum.volume;
            const auto F_x = sum.around_mean(sum.xX, sum.x) *
                             invert(sum.around_mean(sum.XX, sum.X));
            sums[0] += sum.volume;
            sums[1] += sum.volume * (strain(F) - strain(F_x)).norm();
            sums[2] += sum.volume * strain(F_x).norm();
          }
      of_bodies.clear();
    };
    typename Triangulation<dim>::active_cell_iterator cell;
    unsigned int                                      next = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const unsigned int p    = next++;
        const auto         here = particle.get_surrounding_cell();
        if (p > 0 && here != cell)
          finish();
        cell = here;
        if (!has_whole_deformation(bodies[points.body(p)]))
          continue;
        auto          &sum = of_bodies[points.body(p)];
        const double   V   = points.initial_volume(p);
        const auto     X   = points.vector(p, points.offset_initial_position);
        Tensor<1, dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = particle.get_location()[d];
        const auto F = points.layout.load_tensor(points.fields(p) +
                                                 points.offset_deformation);
        ++sum.n;
        sum.volume += V;
        sum.x += V * x;
        sum.X += V * X;
        sum.xX += V * outer_product(x, X);
        sum.XX += V * outer_product(X, X);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            sum.F[i][j] += V * F[i][j];
      }
    finish();
    Utilities::MPI::sum(sums, points.communicator, sums);
    return sums[2] > 0.01 * sums[0] ? sums[1] / sums[2] : 0.;
  }

  template decltype(deformation_drift<2>) deformation_drift<2>;
  template decltype(deformation_drift<3>) deformation_drift<3>;
} // namespace impm
