#ifndef impm_materials_soil_mohr_coulomb_h
#define impm_materials_soil_mohr_coulomb_h

#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/soil/polyhedral_return.h>
#include <impm/materials/soil/strength.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace impm
{
  /**
   * C.-A. de Coulomb's and O. Mohr's limit of principal stresses,
   *
   *   tau_1 - tau_3 + (tau_1 + tau_3) sin phi <= 2 c cos phi,
   *
   * where tau_1 >= tau_2 >= tau_3, tension positive, with the flow along
   * tau_1 - tau_3 + (tau_1 + tau_3) sin psi, and W. J. M. Rankine's of
   * tension, tau_a <= T, whose flow is associated. Without a cut-off T is the
   * stress at the apex, c / tan phi: there the planes of tension add nothing
   * but the way back to the apex of a flow without dilation.
   *
   * E. A. de Souza Neto, D. Peric & D. R. J. Owen, Computational Methods for
   * Plasticity (2008), section 8.2; J. Clausen, L. Damkilde & L. Andersen,
   * Comput. Struct. 85 (2007) 1795.
   */
  struct MohrCoulomb : public SoilStrength
  {
    using Triple = LogStrain::Triple<double>;

    static MohrCoulomb
    from_parameters(dealii::ParameterHandler &prm)
    {
      return {SoilStrength::from_parameters(prm)};
    }

    /**
     * Brings what is that of elasticity to the limit, if it is beyond. With a
     * cohesion (Pa). Returns whether it could.
     */
    bool
    project(const HenckyElasticity &elasticity,
            const double            cohesion,
            SoilReturn             &end) const
    {
      const Triple strain = end.elastic_strain;
      // in the order of the stresses
      std::array<unsigned int, 3> order = {{0, 1, 2}};
      std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
        return strain[a] > strain[b];
      });
      const auto sorted = [&](const Triple &x) {
        return Triple{{x[order[0]], x[order[1]], x[order[2]]}};
      };
      const auto limits = planes(cohesion);
      const auto stress = sorted(end.response.stress);
      if (std::all_of(limits.begin(), limits.end(), [&](const auto &plane) {
            return plane.normal[0] * stress[0] + plane.normal[1] * stress[1] +
                     plane.normal[2] * stress[2] <=
                   plane.limit;
          }))
        return true;

      PolyhedralReturn way(elasticity);
      if (!way.solve(limits, stress))
        return false;
      const auto moduli  = way.moduli(limits);
      const auto secants = quotients(elasticity, limits, way, sorted(strain));
      end.flows          = true;
      for (unsigned int a = 0; a < 3; ++a)
        {
          end.response.stress[order[a]] = way.result.stress[a];
          for (unsigned int b = 0; b < 3; ++b)
            {
              end.response.moduli[order[a]][order[b]] = moduli[a][b];
              if (a < b)
                end.response.secant[order[a] + order[b] - 1] =
                  secants[a + b - 1];
            }
        }
      end.elastic_strain = elasticity.strain(end.response.stress);
      return true;
    }

  private:
    /** Those that a trial stress in order can return to, by pairs 13, 12, 23
     * and in tension 1, 2, 3. */
    PolyhedralReturn::Planes
    planes(const double cohesion) const
    {
      const auto along =
        [](const unsigned int a, const unsigned int b, const double sine) {
          Triple result{};
          result[a] = 1. + sine;
          result[b] = -(1. - sine);
          return result;
        };
      PolyhedralReturn::Planes result;
      const double sine = std::sin(friction), flow = std::sin(dilation);
      for (const auto &[a, b] :
           {std::pair(0, 2), std::pair(0, 1), std::pair(1, 2)})
        result.push_back({along(a, b, sine),
                          along(a, b, flow),
                          2. * cohesion * std::cos(friction)});
      if (const double tension = tensile_limit(cohesion);
          std::isfinite(tension))
        for (unsigned int a = 0; a < 3; ++a)
          {
            Triple axis{};
            axis[a] = 1.;
            result.push_back({axis, axis, tension});
          }
      return result;
    }

    /**
     * (tau_a - tau_b) / (eps_a - eps_b). On one plane two strains cannot meet
     * unless the flow does not tell them apart; on an edge between the planes
     * of two stresses these are equal.
     */
    static Triple
    quotients(const HenckyElasticity         &elasticity,
              const PolyhedralReturn::Planes &planes,
              const PolyhedralReturn         &way,
              const Triple                   &strain)
    {
      const auto  &found     = way.result;
      const double rigid     = 2. * elasticity.shear;
      double       round_off = 0; // of the stresses in a corner
      for (unsigned int i = 0; i < found.size; ++i)
        round_off = std::max({round_off,
                              1e-13 * std::abs(planes[found.planes[i]].limit),
                              1e-13 * std::abs(found.stress[i])});
      Triple result;
      for (unsigned int a = 0; a < 2; ++a)
        for (unsigned int b = a + 1; b < 3; ++b)
          {
            const double apart = strain[a] - strain[b];
            double       loss  = 0; // of what the strains are apart
            for (unsigned int i = 0; i < found.size; ++i)
              {
                const auto &flow = planes[found.planes[i]].flow;
                loss += found.multiplier[i] * (flow[a] - flow[b]);
              }
            double &secant = result[a + b - 1];
            if (found.size == 2 && mirrors(planes, found.planes, a, b))
              secant = 0;
            else if (found.size == 3)
              {
                const double difference = found.stress[a] - found.stress[b];
                secant                  = difference > round_off && apart > 0 ?
                                            std::min(rigid, difference / apart) :
                                            0.;
              }
            else if (loss == 0)
              secant = rigid;
            else
              secant =
                apart > 0 ? rigid * std::clamp(1. - loss / apart, 0., 1.) : 0.;
          }
      return result;
    }

    /** Whether one of two planes is the other with a and b exchanged. */
    static bool
    mirrors(const PolyhedralReturn::Planes    &planes,
            const std::array<unsigned int, 3> &pair,
            const unsigned int                 a,
            const unsigned int                 b)
    {
      auto mirrored = planes[pair[0]].normal;
      std::swap(mirrored[a], mirrored[b]);
      return mirrored == planes[pair[1]].normal;
    }
  };
} // namespace impm

#endif
