#include <impm/output/history.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  TimeSpec
  newmark(const double beta, const double gamma, const bool keeps)
  {
    TimeSpec spec;
    spec.integrator         = Integrator::newmark;
    spec.beta               = beta;
    spec.gamma              = gamma;
    spec.keeps_acceleration = keeps;
    return spec;
  }

  TimeSpec
  generalised_alpha(const double radius, const bool keeps)
  {
    TimeSpec spec        = newmark(0, 0, keeps);
    spec.integrator      = Integrator::generalised_alpha;
    spec.spectral_radius = radius;
    return spec;
  }

  TimeSpec
  theta(const double value)
  {
    TimeSpec spec;
    spec.integrator = Integrator::theta;
    spec.theta      = value;
    return spec;
  }

  // Place and velocity of an oscillator of frequency 1, from place 1, after
  // each of many steps; its force is its place. Ends when it has gone too far.
  std::vector<Point<2>>
  oscillate(const TimeSpec &spec, const double dt, const unsigned int n_steps)
  {
    const auto            integrator = make_time_integrator(spec);
    impm::Vector          u(1), v(1), a(1), known(1), end_v(1), end_a(1);
    double                x = 1;
    std::vector<Point<2>> result;
    a[0]           = -x;
    const double w = integrator->force_factor();
    while (result.size() < n_steps && (result.empty() || std::abs(x) < 1e6))
      {
        integrator->known_acceleration(dt, v, a, known);
        u[0] = (known[0] - x) / (integrator->mass_factor(dt) + w);
        integrator->end_motion(dt, u, v, a, end_v, end_a);
        x += u[0];
        v = end_v;
        a = integrator->keeps_acceleration() ? end_a[0] : -x;
        result.emplace_back(x, v[0]);
      }
    return result;
  }

  // What a step of the oscillator loses by its length, and what the integrator
  // knows of it.
  std::pair<double, double>
  error_and_estimate(const TimeSpec &spec, const double dt)
  {
    const auto   integrator = make_time_integrator(spec);
    impm::Vector u(1), v(1), a(1), known(1), end_v(1), end_a(1), error(1);
    const double x = 1, w = integrator->force_factor();
    v[0] = 0.7;
    a[0] = -x;
    integrator->known_acceleration(dt, v, a, known);
    u[0] = (known[0] - x) / (integrator->mass_factor(dt) + w);
    integrator->end_motion(dt, u, v, a, end_v, end_a);
    integrator->displacement_error(dt, v, a, end_v, end_a, error);
    return {x + u[0] - (x * std::cos(dt) + v[0] * std::sin(dt)), error[0]};
  }

  double
  largest_amplitude(const TimeSpec &spec, const double dt)
  {
    double largest = 0;
    for (const auto &state : oscillate(spec, dt, 10000))
      largest = std::max(largest, std::abs(state[0]));
    return largest;
  }

  // A block high above the ground that a body force takes with it.
  double
  worst_error_of_fall(const Overrides &overrides)
  {
    std::string all;
    for (const auto &override : overrides)
      all += override + " ";
    SCOPED_TRACE(all);
    Model<2>                                model(block_scene("plane strain"),
                   Overrides{"Geometry/box/Lower corner=0.3, 0.55",
                             "Geometry/box/Upper corner=0.7, 0.95",
                             "Grid/Cells=8, 8",
                             "Loads/Body force=0; -1",
                             "Time/Integrator=Newmark",
                             "Time/Time step=0.1"} +
                     overrides);
    impm::Vector                            u;
    double                                  worst = 0;
    std::map<types::particle_index, double> height;
    for (const auto &particle : model.points.sorted.particles)
      height[particle.get_id()] = particle.get_location()[1];
    for (unsigned int step = 0; step < 5; ++step)
      {
        EXPECT_TRUE(model.solve(u).converged);
        model.commit(u);
        const double t      = model.time;
        const auto   totals = total(model.points);
        worst = std::max(worst, std::abs(totals.momentum[1] / totals.mass + t));
        for (const auto &particle : model.points.sorted.particles)
          if (height.count(particle.get_id()) > 0)
            worst = std::max(worst,
                             std::abs(particle.get_location()[1] -
                                      height[particle.get_id()] + t * t / 2));
      }
    return Utilities::MPI::max(worst, MPI_COMM_WORLD);
  }
} // namespace


TEST(TimeIntegrator, KnowsWhatAStepLoses)
{
  for (const auto &spec :
       {theta(1), newmark(0.25, 0.5, false), newmark(0.25, 0.5, true)})
    for (const double dt : {0.02, 0.01})
      {
        const auto [error, estimate] = error_and_estimate(spec, dt);
        EXPECT_NEAR(estimate / error, 1, 2 * dt);
        const auto half = error_and_estimate(spec, dt / 2).first;
        EXPECT_NEAR(error / half,
                    std::pow(2, make_time_integrator(spec)->order() + 1),
                    10 * dt);
      }
}


TEST(TimeIntegrator, OscillationsGrowBeyondTheLimitOnly)
{
  std::vector<TimeSpec> all = {theta(0), theta(0.2), theta(0.45)};
  for (const bool keeps : {false, true})
    for (const auto &[beta, gamma] : {std::make_pair(0.01, 0.5),
                                      std::make_pair(1. / 12, 0.5),
                                      std::make_pair(0.2, 0.5),
                                      std::make_pair(0.25, 0.6),
                                      std::make_pair(0.3, 1.)})
      all.push_back(newmark(beta, gamma, keeps));
  for (const auto &spec : all)
    {
      SCOPED_TRACE(std::to_string(spec.theta) + " " +
                   std::to_string(spec.beta) + " " +
                   std::to_string(spec.gamma));
      const double limit = make_time_integrator(spec)->stable_step(1.);
      EXPECT_NEAR(make_time_integrator(spec)->stable_step(4.),
                  limit / 4,
                  1e-14);
      EXPECT_LT(largest_amplitude(spec, 0.99 * limit), 100.);
      EXPECT_GT(largest_amplitude(spec, 1.01 * limit), 1e6);
    }
  for (const auto &spec : {theta(0.5),
                           theta(1),
                           newmark(0.25, 0.5, false),
                           newmark(0.25, 0.5, true),
                           newmark(0.3, 0.6, true),
                           newmark(0.5, 1, false),
                           newmark(0.5, 0.5, false),
                           generalised_alpha(0, false),
                           generalised_alpha(0.5, false),
                           generalised_alpha(1, false),
                           generalised_alpha(0, true),
                           generalised_alpha(0.5, true),
                           generalised_alpha(1, true)})
    {
      EXPECT_TRUE(std::isinf(make_time_integrator(spec)->stable_step(1.)));
      for (const double dt : {0.1, 1., 10., 1000.})
        EXPECT_LT(largest_amplitude(spec, dt), 100.) << dt;
    }
}


// What a spectral radius is, in steps far too long; a short step keeps what the
// trapezoidal rule keeps, to second order.
TEST(TimeIntegrator, GeneralisedAlphaDampsWhatStepsDoNotResolve)
{
  for (const double radius : {0., 0.5, 0.8, 1.})
    {
      SCOPED_TRACE(radius);
      const auto spec = generalised_alpha(radius, true);
      const auto far  = oscillate(spec, 1e6, 60);
      if (radius > 0)
        EXPECT_NEAR(std::pow(far[59].norm() / far[39].norm(), 0.05),
                    radius,
                    0.05);
      else
        EXPECT_LT(far[59].norm(), 1e-3);
      EXPECT_NEAR(oscillate(spec, 0.02, 500).back().norm(), 1., 2e-3);
    }
}


TEST(TimeIntegratorMpi, FreeFallIsExact)
{
  const std::vector<Overrides> parameters = {
    {"Time/Beta=0.5", "Time/Gamma=0.5"},
    {"Time/Beta=0.5", "Time/Gamma=1"},
    {"Time/Beta=0.25", "Time/Gamma=0.5"},
    {"Time/Beta=0.3025", "Time/Gamma=0.6"},
    {"Time/Beta=0.01", "Time/Gamma=0.5"},
    {"Time/Beta=0.1", "Time/Gamma=0.75"},
    {"Time/Integrator=generalised alpha", "Time/Spectral radius=0.5"},
    {"Time/Integrator=generalised alpha", "Time/Spectral radius=1"},
    {"Time/Integrator=energy-momentum"}};
  for (const std::string method : {"MPM", "GIMP", "Lagrangian"})
    for (const std::string from : {"grid", "points"})
      for (const auto &entry : parameters)
        {
          Overrides overrides = entry + Overrides{"Grid/Method=" + method};
          if (entry.size() > 1)
            overrides = overrides + Overrides{"Time/Acceleration from=" + from};
          // A Lagrangian grid is the body.
          if (method == "Lagrangian")
            overrides = overrides + Overrides{"Geometry/box/Lower corner=0, 0",
                                              "Geometry/box/Upper corner=1, 1"};
          EXPECT_LT(worst_error_of_fall(overrides), 1e-12)
            << method << ", " << from << ": " << entry.front() << ", "
            << entry.back();
        }
}
