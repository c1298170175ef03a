#include <impm/run/plastic_flow.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Norm of the change of shape in a step, as an equivalent strain. */
    double
    equivalent_strain(const Tensor<2, 3> &increment)
    {
      const auto strain = symmetrize(increment) - unit_symmetric_tensor<3>();
      return std::sqrt(2. / 3) * deviator(strain).norm();
    }
  } // namespace

  template <int dim>
  std::vector<PlasticFlow<dim>>
  plastic_flow(const MaterialPoints<dim> &points,
               const PointResponse<dim>  &response)
  {
    std::vector<PlasticFlow<dim>> result(points.n_bodies());
    const auto                    hardens =
      points.history_layout.find("equivalent_plastic_strain");
    if (!hardens)
      return result;
    // By body, of a volume: itself, r, r^2, all change of shape, and r^2 x.
    constexpr unsigned int n_sums = 4 + dim;
    std::vector<double>    sums(n_sums * result.size());
    unsigned int           p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const double V = points.initial_volume(p);
        const double r = response.trial_history(p)[*hardens] -
                         points.fields(p)[points.offset_history + *hardens];
        double *sum = &sums[n_sums * points.body(p)];
        sum[0] += V;
        sum[1] += V * r;
        sum[2] += V * r * r;
        sum[3] += V * equivalent_strain(response.increment(p));
        for (unsigned int d = 0; d < dim; ++d)
          sum[4 + d] += V * r * r * particle.get_location()[d];
        ++p;
      }
    Utilities::MPI::sum(sums, points.communicator, sums);
    for (unsigned int b = 0; b < result.size(); ++b)
      {
        const double *sum  = &sums[n_sums * b];
        auto         &flow = result[b];
        flow.flows         = sum[1] > 0.5 * sum[3];
        if (!flow.flows)
          continue;
        flow.share = sum[1] * sum[1] / (sum[0] * sum[2]);
        for (unsigned int d = 0; d < dim; ++d)
          flow.place[d] = sum[4 + d] / sum[2];
      }
    return result;
  }

  template <int dim>
  std::vector<double>
  softening_shares(const MaterialPoints<dim> &points,
                   const PointResponse<dim>  &response)
  {
    const unsigned int  n = points.n_bodies();
    std::vector<double> volumes(2 * n); // of what softens, of all
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double V = points.initial_volume(p);
        if (points.material(p).softens(points.fields(p) + points.offset_history,
                                       response.trial_history(p)))
          volumes[points.body(p)] += V;
        volumes[n + points.body(p)] += V;
      }
    Utilities::MPI::sum(volumes, points.communicator, volumes);
    for (unsigned int b = 0; b < n; ++b)
      volumes[b] /= std::max(volumes[n + b], 1e-300);
    volumes.resize(n);
    return volumes;
  }

  template decltype(plastic_flow<2>)     plastic_flow<2>;
  template decltype(plastic_flow<3>)     plastic_flow<3>;
  template decltype(softening_shares<2>) softening_shares<2>;
  template decltype(softening_shares<3>) softening_shares<3>;
} // namespace impm
