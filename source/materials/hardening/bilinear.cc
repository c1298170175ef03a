#include <deal.II/base/patterns.h>

#include <impm/materials/hardening/bilinear.h>

#include <algorithm>
#include <cstdlib>

namespace impm
{
  BilinearHardening::BilinearHardening(const double yield_stress,
                                       const double modulus,
                                       const double limit_strain,
                                       const double softening)
    : steepest_fall(limit_strain > 0 ? softening : 0.)
  {
    segments[0] = {0., yield_stress, modulus, 0.};
    if (!(steepest_fall > 0))
      {
        if (limit_strain > 0)
          segments[n_segments++] = {limit_strain,
                                    yield_stress + modulus * limit_strain,
                                    0.,
                                    work(limit_strain)};
        return;
      }
    const double highest   = yield_stress + modulus * limit_strain;
    const double up        = work(limit_strain);
    segments[n_segments++] = {limit_strain, highest, -softening, up};
    const double end       = limit_strain + highest / softening;
    const double down      = work(end);
    segments[n_segments++] = {end, 0., 0., down};
  }


  void
  BilinearHardening::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Yield stress",
                      "1e6",
                      dealii::Patterns::Double(1e-300),
                      "Uniaxial stress (Pa) at which the material starts to "
                      "yield, positive.");
    prm.declare_entry("Hardening modulus",
                      "0",
                      dealii::Patterns::Double(0.),
                      "Slope (Pa) of the yield stress over the equivalent "
                      "plastic strain, not negative; 0: perfectly plastic.");
    prm.declare_entry("Limit strain",
                      "0",
                      dealii::Patterns::Double(0.),
                      "Equivalent plastic strain behind which the material "
                      "softens; 0: none.");
  }


  void
  BilinearHardening::declare_chosen(dealii::ParameterHandler    &prm,
                                    const ParameterFile::Chosen &chosen)
  {
    const std::string limit = chosen("Limit strain", "0");
    if (limit == "any" || std::atof(limit.c_str()) != 0)
      prm.declare_entry("Softening modulus",
                        "0",
                        dealii::Patterns::Double(0.),
                        "How fast the yield stress falls behind the limit "
                        "strain (Pa), less than three shear moduli; it stays "
                        "where it reaches zero.");
  }


  BilinearHardening
  BilinearHardening::from_parameters(dealii::ParameterHandler &prm)
  {
    const double limit = prm.get_double("Limit strain");
    return BilinearHardening(prm.get_double("Yield stress"),
                             prm.get_double("Hardening modulus"),
                             limit,
                             limit > 0 ? prm.get_double("Softening modulus") :
                                         0.);
  }


  const BilinearHardening::Segment &
  BilinearHardening::segment(const double plastic_strain) const
  {
    unsigned int s = n_segments - 1;
    while (s > 0 && plastic_strain < segments[s].begin)
      --s;
    return segments[s];
  }


  double
  BilinearHardening::yield_stress(const double plastic_strain) const
  {
    const Segment &s = segment(plastic_strain);
    return s.yield_stress + s.slope * (plastic_strain - s.begin);
  }


  double
  BilinearHardening::work(const double plastic_strain) const
  {
    const Segment &s      = segment(plastic_strain);
    const double   strain = plastic_strain - s.begin;
    return s.work + (s.yield_stress + 0.5 * s.slope * strain) * strain;
  }


  BilinearHardening::Flow
  BilinearHardening::flow(const double trial,
                          const double plastic_strain,
                          const double resistance) const
  {
    Flow result = {plastic_strain, 0.};
    for (unsigned int s = &segment(plastic_strain) - segments.data();
         s < n_segments;
         ++s)
      {
        const Segment &line = segments[s];
        const double   from = std::max(plastic_strain, line.begin);
        // trial - resistance (x - plastic_strain) = limit + slope (x - from)
        const double excess = trial - resistance * (from - plastic_strain) -
                              line.yield_stress -
                              line.slope * (from - line.begin);
        result = {from + excess / (resistance + line.slope), line.slope};
        if (s + 1 < n_segments && result.plastic_strain > segments[s + 1].begin)
          continue;
        break;
      }
    return result;
  }
} // namespace impm
