#include <impm/output/history.h>
#include <impm/run/external_work.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // A block on rollers that its top presses by a tenth, so light that inertia
  // does not matter.
  const Overrides press = {"Boundary conditions/bottom/Type=slip",
                           "Boundary conditions/left/Type=slip",
                           "Boundary conditions/top/Type=normal displacement",
                           "Boundary conditions/top/Value=-0.1*t",
                           "Boundary conditions/top/Moves the grid=true",
                           "Materials/rubber/Density=1e-9"};

  struct Press
  {
    std::vector<double> loads; ///< of the top, by step
    double              work, energy;
  };

  Press
  run(const Overrides &overrides, const unsigned int n_steps)
  {
    Model<2>        model(block_scene("plane strain"), press + overrides);
    ExternalWork<2> work;
    Press           result;
    model.dt = 1. / n_steps;
    impm::Vector u;
    for (unsigned int step = 0; step < n_steps; ++step)
      {
        const auto solution = model.solve(u);
        EXPECT_TRUE(solution.converged) << solution.failure;
        const auto forces = model.problem->end_forces(u);
        work.add(*model.problem, u, forces);
        result.loads.push_back(
          -model.constraints().sum_over("top", forces, {0., 1.}));
        const auto end = model.problem->end_motion(u);
        model.commit(u);
        model.policy.advance(model.grid,
                             end,
                             model.time - model.dt,
                             model.time);
        model.points.sort();
      }
    const auto totals = total(model.points);
    result.work       = work.done;
    result.energy     = totals.strain_energy + totals.kinetic_energy;
    return result;
  }
} // namespace


// Whatever forces an integrator weighs in a step, what it reports is the force
// at its end.
TEST(ExternalWorkMpi, ForcesAreThoseAtTheEnd)
{
  const auto expected = run({"Time/Integrator=quasi-static"}, 4).loads;
  ASSERT_GT(expected.front(), 0.02);
  const std::vector<Overrides> integrators = {
    {"Time/Integrator=theta", "Time/Theta=1"},
    {"Time/Integrator=theta", "Time/Theta=0.5"},
    {"Time/Integrator=Newmark"},
    {"Time/Integrator=Newmark", "Grid/Method=GIMP"},
    {"Time/Integrator=Newmark", "Time/Acceleration from=points"}};
  for (const auto &integrator : integrators)
    {
      SCOPED_TRACE(integrator.back());
      const auto loads = run(integrator, 4).loads;
      for (unsigned int step = 0; step < 4; ++step)
        EXPECT_NEAR(loads[step] / expected[step], 1., 1e-5) << step;
    }
}


// The trapezoidal rule: work and energy agree to second order in the step.
TEST(ExternalWorkMpi, WorkBecomesEnergy)
{
  for (const std::string integrator : {"quasi-static", "Newmark"})
    {
      SCOPED_TRACE(integrator);
      std::vector<double> errors;
      for (const unsigned int n : {8, 16})
        {
          const auto result = run({"Time/Integrator=" + integrator}, n);
          EXPECT_GT(result.energy, 1e-3);
          errors.push_back(std::abs(result.work / result.energy - 1));
        }
      EXPECT_LT(errors[0], 1e-3);
      EXPECT_GT(errors[0] / errors[1], 3.5);
    }
}


// A dead load does work on what is free.
TEST(ExternalWorkMpi, LoadsDoWork)
{
  Model<2>        model(block_scene("plane strain"),
                 {"Boundary conditions/bottom/Type=fixed",
                         "Loads/Body force=0; -0.05*t",
                         "Solver/Newton tolerance=1e-12"});
  ExternalWork<2> work;
  model.dt = 1. / 8;
  impm::Vector u;
  for (unsigned int step = 0; step < 8; ++step)
    {
      ASSERT_TRUE(model.solve(u).converged);
      work.add(*model.problem, u, model.problem->end_forces(u));
      model.commit(u);
    }
  const double energy = total(model.points).strain_energy;
  EXPECT_GT(energy, 1e-4);
  EXPECT_NEAR((work.done - work.stabilization) / energy, 1., 0.01);
}
