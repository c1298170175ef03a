#include <impm/run/failed_points.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  std::vector<FailedPoints<dim>>
  failed_points(const MaterialPoints<dim> &points)
  {
    const auto failed = points.history_layout.find("failed");
    if (!failed)
      return {};
    // By body: number, volume, and the sum of places.
    constexpr unsigned int n_sums = 2 + dim;
    std::vector<double>    sums(n_sums * points.n_bodies());
    unsigned int           p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        if (points.fields(p)[points.offset_history + *failed] > 0)
          {
            double *sum = &sums[n_sums * points.body(p)];
            sum[0] += 1;
            sum[1] += points.initial_volume(p);
            for (unsigned int d = 0; d < dim; ++d)
              sum[2 + d] += particle.get_location()[d];
          }
        ++p;
      }
    Utilities::MPI::sum(sums, points.communicator, sums);
    std::vector<FailedPoints<dim>> result(points.n_bodies());
    for (unsigned int b = 0; b < result.size(); ++b)
      {
        const double *sum = &sums[n_sums * b];
        result[b].n       = sum[0];
        result[b].volume  = sum[1];
        for (unsigned int d = 0; d < dim && sum[0] > 0; ++d)
          result[b].place[d] = sum[2 + d] / sum[0];
      }
    return result;
  }

  template decltype(failed_points<2>) failed_points<2>;
  template decltype(failed_points<3>) failed_points<3>;
} // namespace impm
