#include <impm/balance/terms/point_traction.h>
#include <impm/base/exceptions.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  std::string
  traction_field(const TractionSpec<dim> &traction)
  {
    return "traction_area_" + traction.name;
  }

  template <int dim>
  double
  traction_area(const TractionSpec<dim> &traction, const Seed<dim> &seed)
  {
    return traction.where->value(seed.position) > 0 ?
             seed.volume / seed.domain[traction.normal] :
             0.;
  }

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
      }
    return counts;
  }

  template <int dim>
  void
  check_tractions(const Tractions<dim>      &tractions,
                  const MaterialPoints<dim> &points)
  {
    const auto counts = count_points_under_tractions(tractions, points);
    for (unsigned int t = 0; t < counts.size(); ++t)
      if (counts[t] == 0)
        throw InputError("Loads/" + tractions[t].name + "/Where",
                         "found no point of body '" + tractions[t].body +
                           "' where the expression is positive, allowed is "
                           "one that picks a layer of points: they lie inside "
                           "the surface, the first half their extent");
  }

  template <int dim>
  void
  add_point_tractions(const Tractions<dim>      &tractions,
                      const MaterialPoints<dim> &points,
                      const Footprints<dim>     &footprints,
                      const double               instant,
                      const double               factor,
                      Vector                    &force)
  {
    if (tractions.empty())
      return;
    std::vector<Tensor<1, dim>> forces(points.size());
    dealii::Vector<double>      value(dim);
    for (const auto &traction : tractions)
      {
        const unsigned int offset =
          points.layout.offset(traction_field(traction));
        traction.value->set_time(instant);
        unsigned int p = 0;
        for (const auto &particle : points.sorted.particles)
          {
            const unsigned int point = p++;
            const double       area  = points.fields(point)[offset];
            if (area == 0)
              continue;
            traction.value->vector_value(traction.is_initial ?
                                           points.initial_position(point) :
                                           particle.get_location(),
                                         value);
            for (unsigned int c = 0; c < dim; ++c)
              forces[point][c] += factor * area * value[c];
          }
      }
    footprints.spread(forces, force);
  }

  template std::string
  traction_field(const TractionSpec<2> &);
  template std::string
  traction_field(const TractionSpec<3> &);
  template double
  traction_area(const TractionSpec<2> &, const Seed<2> &);
  template double
  traction_area(const TractionSpec<3> &, const Seed<3> &);
  template std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<2> &, const MaterialPoints<2> &);
  template std::vector<types::particle_index>
  count_points_under_tractions(const Tractions<3> &, const MaterialPoints<3> &);
  template void
  check_tractions(const Tractions<2> &, const MaterialPoints<2> &);
  template void
  check_tractions(const Tractions<3> &, const MaterialPoints<3> &);
  template void
  add_point_tractions(const Tractions<2> &,
                      const MaterialPoints<2> &,
                      const Footprints<2> &,
                      double,
                      double,
                      Vector &);
  template void
  add_point_tractions(const Tractions<3> &,
                      const MaterialPoints<3> &,
                      const Footprints<3> &,
                      double,
                      double,
                      Vector &);
} // namespace impm
