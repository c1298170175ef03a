#include <impm/materials/log_strain_elastic.h>
#include <impm/materials/soil/drucker_prager.h>
#include <impm/materials/soil/mohr_coulomb.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace dealii;
using namespace impm;

// The returns in principal stresses, before there are axes.
namespace
{
  using Triple = LogStrain::Triple<double>;

  const double degree = numbers::PI / 180;

  const std::vector<std::string> matches = {"outer", "inner", "plane strain"};

  HenckyElasticity
  elastic(const double poisson = 0.3)
  {
    return {ElasticConstants::from_young(1., poisson)};
  }

  SoilStrength
  strength(const double cohesion, const double friction, const double dilation)
  {
    SoilStrength result;
    result.cohesion = cohesion;
    result.friction = friction * degree;
    result.dilation = dilation * degree;
    return result;
  }

  /** All kinds of them, of cohesion 0 or 0.01. */
  std::vector<SoilStrength>
  all_strengths()
  {
    std::vector<SoilStrength> list;
    for (const double phi : {0., 1e-3, 5., 30., 60., 80.})
      for (const double part : {0., 0.5, 1.})
        for (const double c : {0., 0.01})
          if (c > 0 || phi > 0)
            {
              list.push_back(strength(c, phi, part * phi));
              for (const double cut : {0., 0.4})
                {
                  auto         with_cut_off = list.back();
                  const double apex = phi > 0 ? c / std::tan(phi * degree) : c;
                  with_cut_off.cut_off = cut * apex;
                  list.push_back(with_cut_off);
                }
            }
    return list;
  }

  template <typename Limit>
  SoilReturn
  respond(const Limit            &limit,
          const HenckyElasticity &elasticity,
          const Triple           &strain)
  {
    SoilReturn end{false, elasticity.stress(strain), strain};
    EXPECT_TRUE(limit.project(elasticity, limit.cohesion, end));
    return end;
  }

  double
  mean(const Triple &x)
  {
    return (x[0] + x[1] + x[2]) / 3;
  }

  double
  largest(const Triple &x)
  {
    return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
  }

  double
  dot(const Triple &x, const Triple &y)
  {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  }

  // How far beyond the limit, by the formulas of the books.
  double
  excess(const MohrCoulomb &soil, Triple stress)
  {
    std::sort(stress.begin(), stress.end());
    const double sine = std::sin(soil.friction);
    return std::max(stress[2] - stress[0] + (stress[2] + stress[0]) * sine -
                      2 * soil.cohesion * std::cos(soil.friction),
                    stress[2] - soil.tensile_limit(soil.cohesion));
  }

  double
  root_of_J2(const Triple &stress)
  {
    double squares = 0;
    for (const double t : stress)
      squares += (t - mean(stress)) * (t - mean(stress)) / 2;
    return std::sqrt(squares);
  }

  double
  excess(const SoilStrength &soil, const std::string &match, const Triple &t)
  {
    const double s = std::sin(soil.friction), tangent = std::tan(soil.friction);
    const double divisor =
      match == "outer" ? std::sqrt(3) * (3 - s) :
      match == "inner" ? std::sqrt(3) * (3 + s) :
                         std::sqrt(9 + 12 * tangent * tangent);
    const double eta =
      match == "plane strain" ? 3 * tangent / divisor : 6 * s / divisor;
    const double xi = match == "plane strain" ?
                        3 / divisor :
                        6 * std::cos(soil.friction) / divisor;
    return std::max(root_of_J2(t) + eta * mean(t) - xi * soil.cohesion,
                    mean(t) - soil.tensile_limit(soil.cohesion));
  }

  // Trial strains of all sizes, some of which meet.
  Triple
  random_strain(std::mt19937 &generator, const double size)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Triple                                 strain = {
                                      {uniform(generator), uniform(generator), uniform(generator)}};
    const double kind = uniform(generator);
    if (kind > 0.8)
      strain[1] = strain[0];
    else if (kind > 0.6)
      strain[2] = strain[0];
    else if (kind > 0.5)
      strain.fill(strain[0]);
    for (double &e : strain)
      e *= size;
    return strain;
  }

  /** Soils of both kinds, whose excess is compared. */
  template <typename Action>
  void
  for_each_soil(const Action &action)
  {
    for (const auto &soil : all_strengths())
      {
        SCOPED_TRACE("phi " + std::to_string(soil.friction / degree) + " psi " +
                     std::to_string(soil.dilation / degree) + " c " +
                     std::to_string(soil.cohesion) + " T " +
                     std::to_string(soil.cut_off));
        const MohrCoulomb pyramid{soil};
        action(pyramid, [&](const Triple &t) { return excess(pyramid, t); });
        for (const auto &match : matches)
          {
            SCOPED_TRACE(match);
            const DruckerPrager cone(soil, match);
            action(cone,
                   [&](const Triple &t) { return excess(soil, match, t); });
          }
      }
  }
} // namespace


TEST(SoilReturn, EndsOnTheLimit)
{
  std::mt19937 generator(1);
  for (const double poisson : {0., 0.3, 0.4999})
    for_each_soil([&](const auto &soil, const auto &beyond) {
      for (double size = 1e-14; size < 2e4; size *= 10)
        for (unsigned int n = 0; n < 4; ++n)
          {
            const auto   elasticity = elastic(poisson);
            const auto   strain     = random_strain(generator, size);
            const auto   trial      = elasticity.stress(strain).stress;
            const auto   end        = respond(soil, elasticity, strain);
            const auto  &stress     = end.response.stress;
            const double scale      = largest(stress) + soil.cohesion;
            // what the trial stresses' round-off is, or 1e-10 of the limit
            const double round_off = 1e-15 * largest(trial);
            EXPECT_LE(beyond(stress), 1e-13 * scale + round_off);
            if (!end.flows)
              {
                EXPECT_LE(beyond(trial), 1e-15 * scale);
                for (unsigned int a = 0; a < 3; ++a)
                  EXPECT_NEAR(stress[a], trial[a], round_off);
              }
            else
              {
                EXPECT_GE(beyond(stress), -1e-13 * scale - round_off);
              }
            // order is kept, secants are those of elasticity or less
            for (unsigned int a = 0; a < 3; ++a)
              for (unsigned int b = 0; b < 3; ++b)
                if (strain[a] >= strain[b])
                  {
                    EXPECT_GE(stress[a], stress[b] - 1e-13 * scale);
                  }
            for (const double secant : end.response.secant)
              {
                EXPECT_GE(secant, 0.);
                EXPECT_LE(secant, 2 * elasticity.shear * (1 + 1e-15));
              }
          }
    });
}


// 1e-12 to 1e6 of the limit beyond it, on the way out from it.
TEST(SoilReturn, OvershootsOfAllSizes)
{
  std::mt19937 generator(2);
  for_each_soil([&](const auto &soil, const auto &beyond) {
    if (soil.cohesion == 0)
      return;
    const auto elasticity = elastic();
    for (double overshoot = 1e-12; overshoot < 2e6; overshoot *= 10)
      {
        const auto on_limit =
          respond(soil, elasticity, random_strain(generator, 1.));
        if (!on_limit.flows)
          continue;
        auto strain = on_limit.elastic_strain;
        for (double &e : strain)
          e *= 1 + overshoot;
        const auto   end   = respond(soil, elasticity, strain);
        const double scale = largest(end.response.stress) + soil.cohesion;
        EXPECT_LE(std::abs(end.flows ? beyond(end.response.stress) : 0.),
                  1e-10 * scale)
          << overshoot;
      }
  });
}


// Planes, edges and corners: the multipliers are those of the flow rule.
TEST(SoilReturn, KuhnAndTucker)
{
  std::mt19937 generator(3);
  const auto   elasticity          = elastic();
  using Plane                      = PolyhedralReturn::Plane;
  const double                   s = 0.5, f = 0.2, k = 0.01, T = 0.004;
  const PolyhedralReturn::Planes planes = {
    Plane{{{1 + s, 0, s - 1}}, {{1 + f, 0, f - 1}}, k},
    Plane{{{1 + s, s - 1, 0}}, {{1 + f, f - 1, 0}}, k},
    Plane{{{0, 1 + s, s - 1}}, {{0, 1 + f, f - 1}}, k},
    Plane{{{1, 0, 0}}, {{1, 0, 0}}, T},
    Plane{{{0, 1, 0}}, {{0, 1, 0}}, T},
    Plane{{{0, 0, 1}}, {{0, 0, 1}}, T}};
  std::array<unsigned int, 4> found{};
  for (unsigned int n = 0; n < 3000; ++n)
    {
      auto strain = random_strain(generator, n % 2 ? 1. : 0.02);
      std::sort(strain.rbegin(), strain.rend());
      const auto trial = elasticity.stress(strain).stress;
      if (std::all_of(planes.begin(), planes.end(), [&](const Plane &plane) {
            return dot(plane.normal, trial) <= plane.limit;
          }))
        continue;
      PolyhedralReturn way(elasticity);
      ASSERT_TRUE(way.solve(planes, trial));
      const auto &set = way.result;
      ++found[set.size];
      auto rest = strain;
      for (unsigned int i = 0; i < set.size; ++i)
        {
          EXPECT_GE(set.multiplier[i], -1e-14 * largest(strain));
          const auto &plane = planes[set.planes[i]];
          EXPECT_NEAR(dot(plane.normal, set.stress), plane.limit, 1e-13);
          for (unsigned int a = 0; a < 3; ++a)
            rest[a] -= set.multiplier[i] * plane.flow[a];
        }
      const auto same = elasticity.stress(rest).stress;
      for (unsigned int a = 0; a < 3; ++a)
        EXPECT_NEAR(same[a], set.stress[a], 1e-13);
      for (const auto &plane : planes)
        EXPECT_LE(dot(plane.normal, set.stress), plane.limit + 1e-13);
    }
  for (const unsigned int size : {1, 2, 3})
    EXPECT_GT(found[size], 50u) << size;
}


// Of the principal stresses by the trial strains, and the limit of the
// secants where these meet.
TEST(SoilReturn, ModuliAreDerivatives)
{
  std::mt19937 generator(4);
  const auto   elasticity = elastic();
  unsigned int n_smooth = 0, n_all = 0;
  for_each_soil([&](const auto &soil, const auto &) {
    for (unsigned int n = 0; n < 20; ++n)
      {
        auto       strain = random_strain(generator, n % 2 ? 0.3 : 0.02);
        const auto end    = respond(soil, elasticity, strain);
        if (!end.flows)
          continue;
        ++n_all;
        const double h     = 1e-7 * largest(strain);
        double       error = 0, kink = 0;
        for (unsigned int b = 0; b < 3; ++b)
          {
            const auto at = [&](const double x) {
              auto moved = strain;
              moved[b] += x;
              return respond(soil, elasticity, moved).response;
            };
            const auto up = at(h), down = at(-h);
            for (unsigned int a = 0; a < 3; ++a)
              {
                for (const auto *side : {&up, &down})
                  kink = std::max(kink,
                                  std::abs(side->moduli[a][b] -
                                           end.response.moduli[a][b]));
                error =
                  std::max(error,
                           std::abs((up.stress[a] - down.stress[a]) / (2 * h) -
                                    end.response.moduli[a][b]));
              }
          }
        if (kink > 1e-4)
          continue; // another plane takes over within h
        ++n_smooth;
        // of an edge by which moduli divide: 4 to 2e4
        const double sharpness = 4 * std::pow(1 - std::sin(soil.friction), -2);
        EXPECT_LT(error, 1e-7 + 1e-15 * soil.cohesion / h);
        for (unsigned int a = 0; a < 2; ++a)
          for (unsigned int b = a + 1; b < 3; ++b)
            {
              const double apart  = strain[a] - strain[b];
              const double secant = end.response.secant[a + b - 1];
              const auto  &t      = end.response.stress;
              const auto  &D      = end.response.moduli;
              EXPECT_NEAR(secant * apart, t[a] - t[b], 1e-14);
              if (apart == 0)
                {
                  EXPECT_NEAR(secant, D[a][a] - D[a][b], 1e-15 * sharpness);
                }
            }
        if (soil.friction == soil.dilation)
          for (unsigned int a = 0; a < 3; ++a)
            for (unsigned int b = 0; b < 3; ++b)
              {
                EXPECT_NEAR(end.response.moduli[a][b],
                            end.response.moduli[b][a],
                            1e-15 * sharpness);
              }
      }
  });
  EXPECT_GT(n_smooth, 0.8 * n_all);
}


// The work of flow is never negative, and least among admissible stresses
// where it is associated.
TEST(SoilReturn, FlowDissipates)
{
  std::mt19937 generator(5);
  const auto   elasticity = elastic();
  for_each_soil([&](const auto &soil, const auto &) {
    const auto other =
      respond(soil, elasticity, random_strain(generator, 1.)).response.stress;
    for (unsigned int n = 0; n < 10; ++n)
      {
        const auto strain = random_strain(generator, 0.5);
        const auto end    = respond(soil, elasticity, strain);
        double     work = 0, work_of_other = 0;
        for (unsigned int a = 0; a < 3; ++a)
          {
            const double flow = strain[a] - end.elastic_strain[a];
            work += end.response.stress[a] * flow;
            work_of_other += other[a] * flow;
          }
        EXPECT_GE(work, -1e-15);
        if (soil.friction == soil.dilation)
          {
            EXPECT_GE(work, work_of_other - 1e-13);
          }
      }
  });
}


// Without friction the cone is von Mises's cylinder; the pyramid is H. Tresca's
// prism.
TEST(SoilReturn, WithoutFriction)
{
  std::mt19937        generator(6);
  const auto          elasticity = elastic();
  const auto          clay       = strength(0.01, 0., 0.);
  const DruckerPrager cone(clay, "outer");
  const MohrCoulomb   prism{clay};
  for (unsigned int n = 0; n < 100; ++n)
    {
      const auto   strain = random_strain(generator, 0.5);
      const auto   trial  = elasticity.stress(strain).stress;
      const auto   round  = respond(cone, elasticity, strain).response.stress;
      const double scale =
        std::min(1., 2 * clay.cohesion / (std::sqrt(3) * root_of_J2(trial)));
      const auto edged = respond(prism, elasticity, strain).response.stress;
      const auto range = std::minmax_element(edged.begin(), edged.end());
      EXPECT_NEAR(mean(edged), mean(trial), 1e-15);
      EXPECT_LE(*range.second - *range.first, 2 * clay.cohesion + 1e-15);
      for (unsigned int a = 0; a < 3; ++a)
        EXPECT_NEAR(round[a],
                    mean(trial) + scale * (trial[a] - mean(trial)),
                    1e-15);
    }
}


// Both at the meridian where they touch: one stress is apart, the others
// are equal.
TEST(SoilReturn, MeridiansThatMatch)
{
  const auto elasticity = elastic();
  for (const double phi : {1., 20., 45., 80.})
    for (const double c : {0., 0.01})
      for (const double sign : {-1., 1.})
        {
          // what is pressed along one axis, or from the two sides
          const auto          soil = strength(c, phi, 0.);
          const DruckerPrager cone(soil, sign < 0 ? "outer" : "inner");
          const MohrCoulomb   pyramid{soil};
          const Triple        strain = {
                   {-0.05 + sign * 0.6, -0.05 - sign * 0.3, -0.05 - sign * 0.3}};
          const auto one = respond(cone, elasticity, strain).response.stress;
          const auto two = respond(pyramid, elasticity, strain).response.stress;
          for (unsigned int a = 0; a < 3; ++a)
            EXPECT_NEAR(one[a], two[a], 1e-14) << phi;
          const double least = std::min(two[0], two[1]),
                       most  = std::max(two[0], two[1]);
          const double N =
            (1 + std::sin(soil.friction)) / (1 - std::sin(soil.friction));
          EXPECT_NEAR(-least, -most * N + 2 * c * std::sqrt(N), 2e-14 * N);
        }
}


// Where the flow of the cone has nothing across the plane, it is as strong as
// the pyramid.
TEST(SoilReturn, PlaneStrainThatMatches)
{
  for (const double phi : {1., 20., 45., 80.})
    for (const double pressure : {0.01, 1.})
      {
        const auto          soil = strength(0.01, phi, phi);
        const DruckerPrager cone(soil, "plane strain");
        const double        t   = std::tan(soil.friction);
        const double        eta = 3 * t / std::sqrt(9 + 12 * t * t);
        // dev tau over s: across, and what is left for the squares to be 2
        const double across = -2. / 3. * eta;
        const double half   = std::sqrt(1 - 0.75 * across * across);
        const double s      = eta * (soil.cohesion / t + pressure);
        const Triple stress = {{-pressure + s * (-across / 2 + half),
                                -pressure + s * (-across / 2 - half),
                                -pressure + s * across}};
        EXPECT_NEAR(excess(soil, "plane strain", stress), 0., 1e-15);
        EXPECT_NEAR(excess(MohrCoulomb{soil}, stress), 0., 1e-13);
      }
}
