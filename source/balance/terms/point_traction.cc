#include <impm/balance/terms/point_traction.h>
#include <impm/base/exceptions.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<dim>      &tractions,
                               const MaterialPoints<dim> &points)
  {
    std::vector<types::particle_index> counts;
    for (const auto &traction : tractions)
      {
        const unsigned int area =
          points.layout.offset(traction_field(traction));
        types::particle_index n = 0;
        for (unsigned int p = 0; p < points.size(); ++p)
          n += points.fields(p)[area] > 0;
        counts.push_back(Utilities::MPI::sum(n, points.communicator));
        if (counts.back() == 0)
          throw InputError("Loads/" + traction.name + "/Where",
                           "found no point of body '" + traction.body +
                             "' where the expression is positive, allowed is "
                             "one that picks a layer of points: they lie "
                             "inside the surface, the first half their extent");
      }
    return counts;
  }

  template std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<2> &, const MaterialPoints<2> &);
  template std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<3> &, const MaterialPoints<3> &);
} // namespace impm
