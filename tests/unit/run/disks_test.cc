#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "run_scene.h"

using namespace impm;

// Two disks that collide on the grid (Sulsky & Kaul 2004, section 3.1.1).
namespace
{
  Columns
  fly(const std::vector<std::string> &overrides)
  {
    return run_file("disks", overrides);
  }

  constexpr double speed = 1e-3, energy = 260 * speed * speed;
} // namespace

// They fly without error, though points cross into other cells; the impact
// turns them round, and backward Euler never adds to the energy.
TEST(DisksMpi, FlyCollideAndNeverGainEnergy)
{
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      const auto  columns = fly({"Time/Time step=1", "Grid/Method=" + method});
      const auto &time    = columns.at("time");
      const auto &total   = columns.at("total_energy");
      double      before  = energy;
      for (unsigned int i = 0; i < time.size(); ++i)
        {
          EXPECT_LE(total[i], before + 1e-9 * energy) << time[i];
          before = total[i];
          EXPECT_NEAR(columns.at("momentum_x")[i], 0, 1e-12 * 130 * speed);
          if (time[i] > 50)
            continue;
          EXPECT_EQ(columns.at("pieces")[i], 2);
          EXPECT_NEAR(columns.at("lower_velocity")[i], speed, 1e-12 * speed);
          EXPECT_NEAR(columns.at("lower_displacement")[i],
                      speed * time[i],
                      1e-12);
          EXPECT_LT(columns.at("strain_energy")[i], 1e-20 * energy);
          EXPECT_LT(columns.at("largest_stress")[i], 1e-10);
        }
      EXPECT_LT(columns.at("lower_velocity").back(), -0.5 * speed);
      // Stress without forces on the grid is left, which nothing damps.
      EXPECT_LT(columns.at("strain_energy").back(), 0.05 * energy);
    }
}


// Steps as long as their error allows: longer in flight, short in the impact,
// and none that carries the disks into each other.
TEST(DisksMpi, StepsByTheirError)
{
  for (const auto &[integrator, loss] :
       {std::pair("theta", 0.1), std::pair("Newmark", 0.03)})
    {
      SCOPED_TRACE(integrator);
      const auto  columns = fly({std::string("Time/Integrator=") + integrator,
                                 "Time/Step control=error",
                                 "Time/Error tolerance=0.003"});
      const auto &time    = columns.at("time");
      const auto &dt      = columns.at("dt");
      EXPECT_LT(time.size(), 320);
      EXPECT_NEAR(columns.at("kinetic_energy").back() / energy, 1, loss);
      double in_flight = 0, shortest = 1;
      for (unsigned int i = 0; i < time.size(); ++i)
        {
          if (time[i] < 60)
            in_flight = std::max(in_flight, dt[i]);
          else if (time[i] < 80)
            shortest = std::min(shortest, dt[i]);
          EXPECT_LE(columns.at("step_error")[i], 1.5);
        }
      EXPECT_GT(in_flight, 4 * shortest);
    }
}


// A node with a sliver of mass at a crossing (t = 12.5) is beyond the stable
// step of the velocity formulation, whose energy grows until the run ends, not
// of that of momentum, nor where boxes enter.
TEST(Disks, ExplicitCrossings)
{
  const auto end_energy = [](const std::string &formulation,
                             const std::string &method) {
    return fly({"Time/Integrator=explicit",
                "Time/Time step=0.02438",
                "Time/End time=12",
                "Reference/flight/Time=10",
                "Reference/velocity/Time=10",
                "Reference/unstrained/Time=10",
                "Time/Formulation=" + formulation,
                "Grid/Method=" + method})
      .at("total_energy")
      .back();
  };
  EXPECT_THROW(end_energy("velocity", "MPM"), ComputationError);
  EXPECT_NEAR(end_energy("momentum", "MPM"), energy, 1e-9 * energy);
  EXPECT_NEAR(end_energy("velocity", "GIMP"), energy, 1e-9 * energy);
}
