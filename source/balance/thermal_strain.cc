#include <deal.II/base/function_parser.h>
#include <deal.II/base/mpi.h>

#include <impm/balance/thermal_strain.h>
#include <impm/base/exceptions.h>
#include <impm/points/point_fields.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Point<3>
    in_space(const Point<dim> &place)
    {
      Point<3> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = place[d];
      return result;
    }

    Lanes
    exponential(const Lanes &x)
    {
      return each([](const double y) { return std::exp(y); }, x);
    }
  } // namespace

  template <int dim>
  ThermalStrain<dim>::ThermalStrain(const MaterialPoints<dim> &points,
                                    const double               end_time,
                                    std::vector<double>       &trial_histories)
  {
    const bool none_expands = points.all_materials(
      [](const Material &material) { return !material.expands(); });
    const bool none_is_kept =
      points.all_materials([](const Material &material) {
        return !material.prescribed_temperature && !material.conducts();
      });
    if (none_expands && none_is_kept)
      return;
    if (!none_expands)
      {
        start.resize(points.size());
        end.resize(points.size());
      }
    bool         is_finite = true;
    unsigned int p         = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto   &material = points.material(p);
        const double *history  = points.fields(p) + points.offset_history;
        double *trial = trial_histories.data() + p * points.history_size();
        double  temperature = 0;
        if (const auto &prescribed = material.prescribed_temperature)
          {
            prescribed->set_time(end_time);
            temperature = prescribed->value(
              in_space(material.temperature_is_initial ?
                         points.initial_position(p) :
                         Point<dim>(particle.get_location())));
            trial[material.temperature_offset] = temperature;
            is_finite =
              is_finite && std::isfinite(temperature) && temperature >= 0;
          }
        else if (material.expands())
          temperature = material.temperature(
            material.energy_of_point(deformation_gradient(points, p), history)
              .dissipated,
            history);
        if (material.conducts())
          trial[material.temperature_offset] =
            history[material.temperature_offset];
        if (material.expands())
          {
            start[p] = history[material.expansion_offset];
            end[p]   = material.expansion *
                     (temperature - material.stress_free_temperature);
            trial[material.expansion_offset] = end[p];
          }
        ++p;
      }
    if (Utilities::MPI::min(is_finite ? 1 : 0, points.communicator) == 0)
      throw ComputationError("at t = " + Utilities::to_string(end_time) +
                             ": a 'Prescribed temperature' is no finite "
                             "number from 0 K on");
  }

  template <int dim>
  void
  ThermalStrain<dim>::take_out(const PointBatch    &batch,
                               const Material::Form form,
                               Tensor<2, 3, Lanes> &increment,
                               Tensor<2, 3, Lanes> &F) const
  {
    const Lanes strain = change(batch);
    if (form == Material::Form::linearized)
      {
        for (unsigned int d = 0; d < 3; ++d)
          increment[d][d] -= strain;
        return;
      }
    increment *= exponential(-strain);
    F *= exponential(
      batch.gather([&](const unsigned int p) { return -start[p]; }));
  }

  template <int dim>
  Lanes
  ThermalStrain<dim>::put_back(const PointBatch    &batch,
                               const Material::Form form,
                               const Lanes         &stretch) const
  {
    const Lanes strain = change(batch);
    return form == Material::Form::linearized ?
             Lanes(stretch + strain) :
             Lanes(stretch * exponential(strain));
  }

  template class ThermalStrain<2>;
  template class ThermalStrain<3>;
} // namespace impm
