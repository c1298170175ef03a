#include <impm/output/history.h>
#include <impm/run/work_done.h>

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
    WorkDone<2>         work;
    double              energy;
  };

  Press
  run(const Overrides &overrides, const unsigned int n_steps)
  {
    Model<2> model(block_scene("plane strain"), press + overrides);
    Press    result;
    model.dt = 1. / n_steps;
    impm::Vector u;
    for (unsigned int step = 0; step < n_steps; ++step)
      {
        const auto solution = model.solve(u);
        EXPECT_TRUE(solution.converged) << solution.failure;
        const auto forces = model.problem->end_forces(u);
        result.work.add(result.work.of_step(*model.problem, u, forces));
        result.loads.push_back(
          -model.constraints().sum_over("top", forces, {0., 1.}));
        const auto end = model.problem->end_motion(u);
        model.commit(u);
        if (!model.grid.is_lagrangian) // else commit() has done it
          model.policy.advance(model.grid,
                               end,
                               model.time - model.dt,
                               model.time);
        model.points.sort();
      }
    const auto totals = total(model.points);
    result.energy     = totals.strain_energy + totals.kinetic_energy;
    return result;
  }
} // namespace


// Whatever forces an integrator weighs in a step, what it reports is the force
// at its end.
TEST(WorkDoneMpi, ForcesAreThoseAtTheEnd)
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
TEST(WorkDoneMpi, WorkBecomesEnergy)
{
  for (const std::string integrator : {"quasi-static", "Newmark"})
    {
      SCOPED_TRACE(integrator);
      std::vector<double> errors;
      for (const unsigned int n : {8, 16})
        {
          const auto result = run({"Time/Integrator=" + integrator}, n);
          EXPECT_GT(result.energy, 1e-3);
          errors.push_back(std::abs(result.work.external / result.energy - 1));
        }
      EXPECT_LT(errors[0], 1e-3);
      EXPECT_GT(errors[0] / errors[1], 3.5);
    }
}


// On a bottom that holds the block, points move through cells: what is lost of
// the external work is known, to the error of the trapezoidal rule.
TEST(WorkDoneMpi, LossIsThatOfNewGrids)
{
  for (const std::string method : {"MPM", "GIMP", "Lagrangian"})
    {
      SCOPED_TRACE(method);
      const auto   result = run({"Time/Integrator=quasi-static",
                                 "Boundary conditions/bottom/Type=fixed",
                                 "Boundary conditions/top/Value=-0.4*t",
                                 "Geometry/box/Upper corner=0.5, 1",
                                 "Grid/Method=" + method},
                              16);
      const auto  &work   = result.work;
      const double loss   = work.external - work.internal - work.stabilization;
      EXPECT_NEAR(work.internal / result.energy, 1., 2e-3);
      if (method == "Lagrangian")
        EXPECT_NEAR(loss / result.energy, 0., 1e-6);
      else
        EXPECT_GT(std::abs(loss / result.energy), 4e-3);
    }
}


// A dead load does work on what is free.
TEST(WorkDoneMpi, LoadsDoWork)
{
  Model<2>    model(block_scene("plane strain"),
                 {"Boundary conditions/bottom/Type=fixed",
                     "Loads/Body force=0; -0.05*t",
                     "Solver/Newton tolerance=1e-12"});
  WorkDone<2> work;
  model.dt = 1. / 8;
  impm::Vector u;
  for (unsigned int step = 0; step < 8; ++step)
    {
      ASSERT_TRUE(model.solve(u).converged);
      work.add(work.of_step(*model.problem, u, model.problem->end_forces(u)));
      model.commit(u);
    }
  const double energy = total(model.points).strain_energy;
  EXPECT_GT(energy, 1e-4);
  EXPECT_NEAR((work.external - work.stabilization) / energy, 1., 0.01);
}
